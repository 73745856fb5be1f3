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

void add_estimate_options(CLI::App& command, ReferenceOptions& options) {
    command
        .add_option("--receivers", options.receivers,
                    "a table instead of a picture: radiance and its standard error at N vertices, "
                    "seen as `opaline relight` sees them")
        ->transform(whole_number(1, 100000000))
        ->option_text("N");
    command
        .add_option("--spp", options.samples,
                    "paths for each pixel or receiver; default 64 for pictures, 1024 for tables, "
                    "no limit with --seconds; view rays with path-integration, default 4")
        ->transform(whole_number(1, 2000000000))
        ->option_text("N");
    command
        .add_option("--seconds", options.seconds,
                    "stop after about that time; how many samples fit differs from run to run")
        ->check(real_number(1e-3, 1e9))
        ->option_text("S");
    command
        .add_option("--max-depth", options.max_depth,
                    "at most D scattering events along a path, refraction included; default: no "
                    "limit, Russian roulette ends paths that carry little")
        ->transform(whole_number(1, 1000000000))
        ->option_text("D");
    command
        .add_option(
            "--terms", options.terms,
            "count only some of the light: " + formats::term_names(formats::TermSet::baked, ", ") +
                " (scattered once or more often in volumes) as in `opaline relight`, unscattered "
                "(straight through a body), interreflection (paths that meet a second surface or "
                "body, or a volume and a surface), emitters (light of the scene's own glowing "
                "surfaces and lights)")
        ->check(term_list())
        ->option_text("all|LIST [all]");
    command
        .add_option("--texture-filter", options.texture_filter,
                    "what textures are looked up over in pictures: none (a point: no bias), "
                    "footprint (what a path stands for among --spp: less noise), limited (less of "
                    "it where the density of directions varies, from the second scattering on)")
        ->check(CLI::IsMember({"none", "footprint", "limited"}))
        ->option_text("none|footprint|limited [none]");
    add_seed_option(command, options.seed, "another one gives other noise");
    add_threads_option(command, options.threads);
}

// Paths do not know cloud layers.
void check_layers(const formats::Scene& scene) {
    if (scene.layers.empty()) return;
    if (scene.primitives.empty() && scene.volumes.empty()) {
        refuse(make_error(ErrorKind::bad_input, scene.source, "clouds",
                          "the scene is a cloud layer alone, which no paths are traced through",
                          "a bake measures a layer's error itself; opaline slab computes layers by "
                          "photons"));
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
    require(report_warnings(
        {formats::make_warning(scene.source, "KHR_lights_punctual",
                               "light of points, spots and directional lights does not pass smooth "
                               "boundaries that refract: "
                               "bodies are lit by it as far as other surfaces reflect it",
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
    if (!table && !options.paths.is_chosen()) {
        outputs.push_back({"the variance beside it", variance_path(options.output), {}});
    }
    inputs.insert(inputs.end(), {options.scene, options.media, options.light});
    require(check_outputs(outputs, inputs));
    if (options.texture_filter != "none" && (table || options.seconds > 0)) {
        refuse_usage("--texture-filter",
                     table ? "only the paths of a picture have footprints"
                           : "footprints depend on the number of paths, which --seconds "
                             "leaves open",
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
    for (const CLI::Option* option : options.picture_options) {
        if (table && option->count() > 0) {
            refuse_usage(option->get_name(), "a table of receivers is no picture",
                         "leave it out; --eye says where receivers are seen from");
        }
    }
}

void add_reference_options(CLI::App& command, ReferenceOptions& options) {
    command
        .add_option(
            "scene", options.scene,
            "the scene: .gltf or .glb; .vdb for a volume alone; .json for the volumes of a media "
            "file alone")
        ->required()
        ->option_text("SCENE");
    command.add_option("--light", options.light, light_help())->required()->option_text("ENV");
    command
        .add_option(
            "-o,--output", options.output,
            ".exr: linear radiance; .png: tone-mapped as by `render`; beside both .var.exr, "
            "the variance of each pixel's mean; .csv: primitive,vertex,r,g,b,se_r,se_g,se_b")
        ->required()
        ->check(file_name())
        ->option_text("OUT.exr|.png|.csv");
    command
        .add_option("--media", options.media,
                    "what translucent materials are made of; volumes of smoke or cloud")
        ->check(file_name())
        ->option_text("FILE.json");
    add_allow_path_option(command, options.allowed_folders);
    command
        .add_option("--metres-per-unit", options.metres_per_unit,
                    "length of one unit of the scene file")
        ->check(real_number(kLeastUnit, kMostUnit))
        ->option_text("X [1]");
    add_smooth_normals_option(command, options.smooth_normals);
    add_path_integration_options(command, options.paths);
    add_estimate_options(command, options);
    add_camera_options(command, options.camera);
    for (const char* name :
         {"--size", "--azimuth", "--elevation", "--distance", "--target", "--up", "--fov"}) {
        options.picture_options.push_back(command.get_option(name));
    }
    add_exposure_option(command, options.exposure, "0");
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
