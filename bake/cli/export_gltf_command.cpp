#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/draw_frames.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/picture_options.h"
#include "formats/gltf/unlit_glb.h"
#include "runtime/shade.h"

namespace opaline::cli {
namespace {

struct ExportGltfCommand {
    std::string path, output, eye, light = "studio";
    std::vector<std::string> emitters;
    double rotate_light = 0;
    double time = 0;                ///< [s]
    std::optional<float> exposure;  ///< [EV]
    unsigned threads = 0;
};

// The radiance of every vertex; where a primitive has a base colour's image, without it.
std::vector<formats::Rgb> shade_without_images(const formats::AssetView& view,
                                               const PictureLight& light,
                                               const runtime::EmitterLight& emitters,
                                               std::optional<formats::Vec3> eye, unsigned threads) {
    std::vector<formats::PrimitiveRecord> primitives(view.primitives.begin(),
                                                     view.primitives.end());
    for (formats::PrimitiveRecord& primitive : primitives) {
        primitive.base_color_image = formats::kNoImage;
    }
    formats::AssetView plain = view;
    plain.primitives = primitives;
    const OpenedLight mirrored = light.layers.mirrored(light.sky);
    const runtime::SpecularNeeds needs = runtime::specular_needs(plain);
    const runtime::SpecularLight specular =
        runtime::make_specular_light(mirrored.environment, needs, mirrored.rotation, threads);
    runtime::ShadeOptions options;
    options.threads = threads;
    options.eye = eye;
    options.emitters = emitters;
    options.specular = needs.any() ? &specular : nullptr;
    std::vector<formats::Rgb> radiance(plain.receivers());
    runtime::shade(plain, light.parts.lights(), radiance, options);
    return radiance;
}

bool mirrors_over_an_image(const formats::AssetView& view) {
    for (std::size_t p = 0; p < view.primitives.size(); ++p) {
        const bool mirrors = (p < view.gloss.size() && view.gloss[p].is_glossy()) ||
                             (p < view.roughness.size() && view.roughness[p] >= 0);
        if (mirrors && view.primitives[p].base_color_image != formats::kNoImage) return true;
    }
    return false;
}

// What the file shows and a glTF file of this kind cannot.
void note_what_is_left_out(const formats::AssetView& view) {
    const std::pair<bool, const char*> facts[] = {
        {!view.volumes.empty(), "volumes are left out"},
        {!view.clouds.empty(), "the cloud layer is left out; it lights the meshes"},
        {!view.normal_maps.empty(), "normal maps are left out"},
        {mirrors_over_an_image(view), "gloss of surfaces with an image is tinted by it"}};
    std::string list;
    for (const auto& [applies, text] : facts) {
        if (applies) list += (list.empty() ? "" : "; ") + std::string(text);
    }
    if (!list.empty()) print_note("opaline: glTF cannot hold everything: " + list);
}

// Which exposure would keep all colours, rounded down to a hundredth.
void note_clipping(const formats::UnlitGlb& glb, float exposure) {
    if (glb.clipped == 0) return;
    const double keeps = std::floor(100 * (static_cast<double>(exposure) -
                                           std::log2(static_cast<double>(glb.largest)))) /
                         100;
    print_note(
        fmt::format("{:.3g} % of the vertices are brighter than 1 and clipped there; "
                    "--exposure {:.2f} keeps all",
                    100.0 * glb.clipped / glb.vertices, keeps));
}

int run(const ExportGltfCommand& options) {
    const OutputFile outputs[] = {{"--output", options.output, {".glb"}}};
    const std::filesystem::path inputs[] = {options.path, options.light};
    require(check_outputs(outputs, inputs));
    std::optional<formats::Vec3> eye;
    if (!options.eye.empty()) eye = parse_vec3("--eye", options.eye);
    check_light(options.light);
    const auto asset = require(open_asset(options.path, formats::Checks::full));
    const formats::AssetView& view = asset.loaded.view;
    require(formats::check_has_mesh(view, options.path));
    const auto emitters = require(parse_emitters(view.emitters, options.emitters));
    CameraOptions camera_options;
    camera_options.eye = options.eye;
    const auto camera = make_camera(camera_options, view);
    const auto sky = open_light(options.light, options.rotate_light);
    const LightWithLayers layers = light_layers_of(view, sky, options.time, options.threads);
    const PictureLight light{sky, layers, project_parts(view, layers, sky, options.threads)};
    const Shown shown = show_terms(formats::TermSet::baked, view, emitters);
    std::vector<formats::Rgb> color =
        shade_without_images(view, light, shown.emitters, eye, options.threads);
    const float exposure = options.exposure
                               ? *options.exposure
                               : meter_exposure(view, light, camera, shown, options.threads);
    for (formats::Rgb& c : color) {
        const formats::Rgb exposed = std::exp2(exposure) * c;
        constexpr float kMost = std::numeric_limits<float>::max();
        c = {std::min(exposed.r, kMost), std::min(exposed.g, kMost), std::min(exposed.b, kMost)};
    }
    const formats::UnlitGlb glb = require(formats::make_unlit_glb(view, color, options.path));
    require(formats::write_file_atomically(options.output, glb.bytes));
    print_note(fmt::format("{}: {} vertices, {}", printable(options.output), glb.vertices,
                           format_bytes(static_cast<double>(glb.bytes.size()))));
    note_what_is_left_out(view);
    note_clipping(glb, exposure);
    return kExitSuccess;
}

}  // namespace

void add_export_gltf_command(Program& program) {
    auto [command, options] = add_command<ExportGltfCommand>(
        program, "export-gltf", "Write the meshes of an .opal file as glTF, lit by one light", run);
    add_asset_argument(command, options.path);
    command.add("--light", "ENV [studio]", text(options.light), light_help());
    command
        .add("-o,--output", "OUT.glb", file_name(options.output),
             "the file: light in COLOR_0, images, materials of KHR_materials_unlit")
        .required();
    command.add("--eye", "X,Y,Z", text(options.eye),
                "the point everything is seen from [m]; default: each vertex along its own normal. "
                "Only translucent, thin-walled and glossy surfaces depend on it");
    add_emitter_option(command, options.emitters);
    add_rotate_light_option(command, options.rotate_light);
    add_time_option(command, options.time);
    add_exposure_option(command, options.exposure,
                        "as `opaline render` chooses it: 0, but lower where what is shown is too "
                        "bright for a screen, and higher where it is nearly black");
    add_threads_option(command, options.threads, "0: one per core");
    command.footer(
        "COLOR_0 is what `opaline relight` states, times 2^EV and without the base colour's image, "
        "as\n"
        "linear floats clipped at 1, which glTF asks for. Viewers show it without a tone map: it "
        "looks as\n"
        "`opaline render --tone-map none` does. Vertices, their order and names are those of the "
        "scene.\n"
        "Limits: thin-walled surfaces show the light of one side from both; light does not change "
        "as the\n"
        "eye moves; volumes, cloud layers and normal maps are left out; the image of a surface "
        "also\n"
        "multiplies what it mirrors; thin glass is seen through as along its normal.\n\n"
        "Example:\n  opaline export-gltf statue.opal --light sky:3,35 -o statue.glb");
}

}  // namespace opaline::cli
