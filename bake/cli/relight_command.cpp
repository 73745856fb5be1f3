#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/picture_options.h"
#include "bake/lab/compare/relight_table.h"
#include "formats/opal/terms.h"
#include "runtime/shade.h"
#include "runtime/volumes/node_radiance.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::cli {
namespace {

struct RelightCommand {
    std::string path, light, output, eye, terms;
    std::vector<std::string> emitters;
    double rotate_light = 0;
    double time = 0;  ///< [s]
    unsigned threads = 0;
    bool json = false;
};

// What a script wants to know without reading the table.
void print_json(const RelightCommand& options, const formats::AssetView& view,
                std::span<const formats::Rgb> radiance) {
    double mean[3] = {}, most = 0;
    for (const formats::Rgb& value : radiance) {
        mean[0] += static_cast<double>(value.r) / static_cast<double>(radiance.size());
        mean[1] += static_cast<double>(value.g) / static_cast<double>(radiance.size());
        mean[2] += static_cast<double>(value.b) / static_cast<double>(radiance.size());
        most = std::max({most, static_cast<double>(value.r), static_cast<double>(value.g),
                         static_cast<double>(value.b)});
    }
    fmt::print("{}", json_text({{"output", options.output},
                                {"primitives", view.primitives.size()},
                                {"receivers", radiance.size()},
                                {"volume_nodes", view.volumes.node.size()},
                                {"mean", {mean[0], mean[1], mean[2]}},
                                {"maximum", most}}));
}

// One row per receiver, in file order.
std::vector<bake::RelightRow> make_rows(const formats::AssetView& view,
                                        std::span<const formats::Rgb> radiance) {
    std::vector<bake::RelightRow> rows;
    rows.reserve(radiance.size());
    for (std::uint32_t p = 0; p < view.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = view.primitives[p];
        for (std::uint32_t v = 0; v < primitive.vertex_count; ++v) {
            rows.push_back({p, v, radiance[primitive.first_vertex + v]});
        }
    }
    return rows;
}

std::vector<formats::Vec3> row_positions(const formats::AssetView& view) {
    std::vector<formats::Vec3> positions;
    for (const formats::PrimitiveRecord& p : view.primitives) {
        const auto own = view.position.subspan(p.first_vertex, p.vertex_count);
        positions.insert(positions.end(), own.begin(), own.end());
    }
    return positions;
}

// Of OUT.csv: OUT-volumes.csv.
std::filesystem::path volumes_path(const std::filesystem::path& output) {
    return output.parent_path() /
           (output.stem().string() + "-volumes" + output.extension().string());
}

// Every output, whether the file has volumes or not.
std::vector<OutputFile> list_outputs(const RelightCommand& options) {
    std::vector<OutputFile> outputs{{"--output", options.output, {".csv", ".ply", ".exr"}}};
    if (ending_of(options.output) == ".csv") {
        outputs.push_back({"the table of volumes", volumes_path(options.output), {}});
    }
    return outputs;
}

// One row per node, in file order.
std::vector<bake::VolumeRow> make_volume_rows(const formats::VolumesView& volumes,
                                              const runtime::VolumeLight& light,
                                              const std::optional<formats::Vec3>& eye) {
    std::vector<bake::VolumeRow> rows;
    rows.reserve(volumes.node.size());
    for (std::uint32_t v = 0; v < volumes.records.size(); ++v) {
        const std::vector<formats::Rgb> radiance = runtime::node_radiance(volumes, light, v, eye);
        for (std::uint32_t i = 0; i < radiance.size(); ++i) {
            rows.push_back({v, volumes.node[volumes.records[v].first_node + i], radiance[i]});
        }
    }
    return rows;
}

void write_volumes(const RelightCommand& options, const formats::VolumesView& volumes,
                   const runtime::LightVector& light, const runtime::ShadeOptions& shading,
                   bool is_alone) {
    if (volumes.empty()) return;
    if (ending_of(options.output) != ".csv") {
        print_note("opaline: the file has volumes, which only .csv outputs show");
        return;
    }
    const runtime::VolumeLight lit = runtime::relight_volumes(
        volumes, light,
        {.terms = shading.terms, .emitters = shading.emitters, .threads = shading.threads});
    const std::filesystem::path path = volumes_path(options.output);
    require(bake::write_volume_csv(path, make_volume_rows(volumes, lit, shading.eye)));
    if (is_alone) {
        print_note("opaline: " + printable(options.output) + ": the file has no receivers; " +
                   printable(path.string()) + " has the nodes of its volumes");
    }
}

int run(const RelightCommand& options) {
    const std::filesystem::path inputs[] = {options.path, options.light};
    require(check_outputs(list_outputs(options), inputs));
    runtime::ShadeOptions shading;
    shading.threads = options.threads;
    if (!options.eye.empty()) {
        shading.eye = parse_vec3("--eye", options.eye);
    }
    const auto terms =
        require(formats::parse_terms(options.terms, formats::TermSet::baked, "--terms"));
    check_light(options.light);
    const auto asset = require(open_asset(options.path));
    require(runtime::check_terms(asset.loaded.view, terms, options.path));
    const auto emitters = require(parse_emitters(asset.loaded.view.emitters, options.emitters));
    const auto light = open_light(options.light, options.rotate_light);
    const formats::AssetView& view = asset.loaded.view;
    const LightWithLayers layers = light_layers_of(view, light, options.time, options.threads);
    const OpenedLight mirrored = layers.mirrored(light);
    const runtime::SpecularNeeds needs = runtime::specular_needs(view);
    const runtime::SpecularLight specular = runtime::make_specular_light(
        mirrored.environment, needs, mirrored.rotation, options.threads);
    shading.terms = terms;
    shading.emitters = {emitters, has_all(terms, formats::TermSet::baked)};
    shading.specular = needs.any() ? &specular : nullptr;
    if (!view.clouds.empty() && view.receivers() == 0 && view.volumes.empty()) {
        print_note("opaline: the file has a cloud layer alone, which opaline render shows");
    }
    std::vector<formats::Rgb> radiance(view.receivers());
    const PartVectors parts = project_parts(view, layers, light, options.threads);
    const runtime::PartLights lights = parts.lights();
    runtime::shade(view, lights, radiance, shading);
    write_volumes(options, view.volumes, lights.light[lights.of_volumes], shading,
                  view.receivers() == 0);
    const std::vector<bake::RelightRow> rows = make_rows(view, radiance);
    const std::string ending = ending_of(options.output);
    require(ending == ".csv"   ? bake::write_relight_csv(options.output, rows)
            : ending == ".ply" ? bake::write_relight_ply(options.output, row_positions(view), rows)
                               : bake::write_relight_exr(options.output, rows));
    if (options.json) {
        print_json(options, view, radiance);
    }
    return kExitSuccess;
}

}  // namespace

void add_relight_command(Program& program) {
    auto [command, options] = add_command<RelightCommand>(
        program, "relight", "Evaluate the outgoing radiance of every receiver under a light", run);
    add_asset_argument(command, options.path);
    command.add("--light", "ENV", text(options.light), light_help()).required();
    command
        .add("-o,--output", "OUT.csv|.ply|.exr", file_name(options.output),
             ".csv: primitive,vertex,r,g,b, and where the file has volumes OUT-volumes.csv: "
             "volume,i,j,k,r,g,b of every node, volumes numbered as `opaline info` does; .ply: "
             "points with colours; .exr: one pixel per receiver, 1024 a row")
        .required();
    command.add("--eye", "X,Y,Z", text(options.eye),
                "the point everything is seen from [m]; default: each receiver along its own "
                "normal, and nodes of volumes in the mean of all directions. Only translucent, "
                "thin-walled and glossy surfaces and volumes depend on it");
    add_emitter_option(command, options.emitters);
    command.add("--terms", "all|LIST [all]", term_list(options.terms),
                "components to add up: all, or some of " +
                    formats::term_names(formats::TermSet::baked) + ". " +
                    formats::term_names(formats::TermSet::separable, " and ") +
                    " apart need a bake with --separate-terms");
    add_rotate_light_option(command, options.rotate_light);
    add_time_option(command, options.time);
    add_threads_option(command, options.threads, "0: one per core");
    command.add_flag("--json", options.json,
                     "print JSON: receivers, mean and maximum of their radiance");
    command.footer(
        "A cloud layer lights receivers and nodes as it is seen from the centre of their bounds, "
        "those\n"
        "that stand far apart from several points.\n\n"
        "Example:\n  opaline relight scene.opal --light studio -o radiance.csv");
}

}  // namespace opaline::cli
