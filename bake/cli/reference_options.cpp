#include "bake/cli/reference_options.h"

#include <algorithm>
#include <limits>

#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/picture_options.h"
#include "bake/cli/scene_options.h"
#include "bake/reference/reference_scene.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

void add_estimate_options(const Command& command, ReferenceOptions& options) {
    command.add("--receivers", "N", whole_number(options.receivers, 1, 100000000),
                "a table instead of a picture: radiance and its standard error at N vertices, seen "
                "as `opaline relight` sees them");
    command.add("--spp", "N", whole_number(options.samples, 1, 2000000000),
                "paths for each pixel or receiver; default 64 for pictures, 1024 for tables, no "
                "limit with --seconds; view rays with path-integration, default 4");
    command.add("--seconds", "S", real_number(options.seconds, 1e-3, 1e9),
                "stop after about that time; how many samples fit differs from run to run");
    command.add("--max-depth", "D", whole_number(options.max_depth, 1, 1000000000),
                "at most D scattering events along a path, refraction included; default: no limit, "
                "Russian roulette ends paths that carry little");
    command.add(
        "--terms", "all|LIST [all]", term_list(options.terms),
        "count only some of the light: " + formats::term_names(formats::TermSet::baked, ", ") +
            " (scattered once or more often in volumes) as in `opaline relight`, unscattered "
            "(straight through a body), interreflection (paths that meet a second surface or body, "
            "or a volume and a surface), emitters (light of the scene's own glowing surfaces and "
            "lights)");
    command.add("--texture-filter",
                one_of(options.texture_filter, {{"none", TextureFilter::none},
                                                {"footprint", TextureFilter::footprint},
                                                {"limited", TextureFilter::limited}}),
                "what textures are looked up over in pictures: none (a point: no bias), footprint "
                "(what a path stands for among --spp: less noise), limited (less of it where the "
                "density of directions varies, from the second scattering on)");
    add_seed_option(command, options.seed, "another one gives other noise");
    add_threads_option(command, options.threads);
}

// Paths do not know cloud layers.
void check_layers(const formats::Scene& scene) {
    if (scene.layers.empty()) return;
    if (scene.primitives.empty() && scene.volumes.empty()) {
        refuse(make_error(
            ErrorKind::bad_input, scene.source, "clouds",
            "the scene is a cloud layer alone, which no paths are traced through",
            "a bake measures a layer's error itself; opaline slab computes layers by photons"));
    }
    require(report_warnings({formats::make_warning(
        scene.source, "clouds", "the cloud layer is left out: no paths are traced through it",
        "compare with a bake without it")}));
}

// A line to a light without an extent is not bent by a smooth boundary, and no path meets such a
// light.
void check_lights(const formats::Scene& scene) {
    const auto bends = [](const formats::Material& m) {
        return m.medium && !bake::is_matched(m.medium->eta) && !bake::has_rough_boundary(*m.medium);
    };
    if (scene.lights.empty() ||
        std::none_of(scene.materials.begin(), scene.materials.end(), bends)) {
        return;
    }
    require(report_warnings({formats::make_warning(
        scene.source, "KHR_lights_punctual",
        "light of points, spots and directional lights does not pass smooth boundaries that "
        "refract: bodies are lit by it as far as other surfaces reflect it",
        "give the light a surface: a small mesh with emissiveFactor")}));
}

}  // namespace

std::string variance_path(const std::string& output) {
    return std::filesystem::path(output).replace_extension(".var.exr").string();
}

void check_reference_paths(const ReferenceOptions& options,
                           std::vector<std::filesystem::path> inputs) {
    const bool table = ending_of(options.output) == ".csv";
    std::vector<OutputFile> outputs{{"--output", options.output, {".exr", ".png", ".csv"}}};
    if (!table && !options.by_integration()) {
        outputs.push_back({"the variance beside it", variance_path(options.output), {}});
    }
    inputs.insert(inputs.end(), {options.scene, options.media, options.light});
    require(check_outputs(outputs, inputs));
    if (options.texture_filter != TextureFilter::none && (table || options.seconds > 0)) {
        refuse_usage("--texture-filter",
                     table
                         ? "only the paths of a picture have footprints"
                         : "footprints depend on the number of paths, which --seconds leaves open",
                     table ? "leave it out, or end the output's name in .exr or .png"
                           : "give --spp instead of --seconds");
    }
    if (table != (options.receivers > 0)) {
        refuse(make_error(ErrorKind::usage, options.output, "",
                          table ? "a table needs receivers" : "receivers go into a table",
                          table
                              ? "give --receivers N, or end the name in .exr or .png for a picture"
                              : "end the name in .csv, or leave out --receivers"));
    }
    for (const Option& option : options.picture_options) {
        if (table && option.is_given()) {
            refuse_usage(option.name(), "a table of receivers is no picture",
                         "leave it out; --eye says where receivers are seen from");
        }
    }
}

void add_reference_options(const Command& command, ReferenceOptions& options) {
    add_scene_argument(command, options);
    command.add("--light", "ENV", text(options.light), light_help()).required();
    command
        .add("-o,--output", "OUT.exr|.png|.csv", file_name(options.output),
             ".exr: linear radiance; .png: tone-mapped as by `render`; beside both .var.exr, the "
             "variance of each pixel's mean; .csv: primitive,vertex,r,g,b,se_r,se_g,se_b")
        .required();
    command.add("--media", "FILE.json", file_name(options.media),
                "what translucent materials are made of; volumes of smoke or cloud");
    add_allow_path_option(command, options);
    add_unit_options(command, options);
    add_path_integration_options(command, options);
    add_estimate_options(command, options);
    add_camera_options(command, options.camera);
    for (const char* name :
         {"--size", "--azimuth", "--elevation", "--distance", "--target", "--up", "--fov"}) {
        options.picture_options.push_back(command.find(name));
    }
    add_exposure_option(command, options.exposure, "as `render` chooses it; 0 of .exr");
    add_rotate_light_option(command, options.rotate_light);
    add_progress_option(command, options.progress);
}

void check_traceable(const formats::Scene& scene) {
    check_layers(scene);
    check_lights(scene);
}

bake::OrientedBodies close_bodies(const formats::Scene& scene) {
    bake::OrientedBodies bodies = bake::orient_bodies(scene);
    for (bake::BodySurface& surface : bodies.surfaces) {
        surface.open_edges = 0;  // paths are counted that are lost there
    }
    require(report_warnings(bake::describe_faults(scene, bodies.surfaces)));
    return bodies;
}

}  // namespace opaline::cli
