#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "bake/cli/command.h"
#include "bake/cli/file_facts.h"
#include "bake/cli/inputs.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "formats/opal/receiver_errors.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoCommand {
    std::string path;
    bool json = false;
};

const char* shading_name(formats::Shading shading) {
    return shading == formats::Shading::translucent ? "translucent"
           : shading == formats::Shading::sheet     ? "thin-walled"
                                                    : "diffuse";
}

bool is_glossy(const formats::AssetView& view, std::size_t primitive) {
    return !view.roughness.empty() && view.roughness[primitive] >= 0;
}

// glTF's alphaMode.
const char* alpha_mode_of(const formats::AssetView& view, std::size_t primitive) {
    const formats::HoleRecord* hole = view.holes.of(static_cast<std::uint32_t>(primitive));
    return hole == nullptr ? "OPAQUE" : hole->mode == formats::HoleMode::mask ? "MASK" : "BLEND";
}

// What each adds to rows, and how many primitives glow.
Json emitters_json(const formats::AssetView& view) {
    const formats::EmittersView& emitters = view.emitters;
    const std::vector<double> times = compare_with_sky(view);
    Json list = Json::array();
    for (std::uint32_t e = 0; e < emitters.size(); ++e) {
        const auto lit = std::ranges::count(emitters.block, e, &formats::EmitterBlock::emitter);
        const auto glowing = std::ranges::count(emitters.own, e, &formats::OwnLight::emitter);
        list.push_back(
            {{"name", std::string(emitters.name(e))},
             {"lit_primitives", lit},
             {"glowing_primitives", glowing},
             {"times_white_sky", std::isfinite(times[e]) ? Json(times[e]) : Json(nullptr)}});
    }
    return list;
}

void print_emitters(const Json& emitters) {
    if (!emitters.empty()) {
        fmt::print("emitters\n");
    }
    for (const Json& emitter : emitters) {
        const Json& times = emitter["times_white_sky"];
        fmt::print("  '{}'{}\n", printable(emitter["name"].get<std::string>()),
                   times.is_number()
                       ? fmt::format(": {:.3g} times the light of a sky of radiance 1",
                                     times.get<double>())
                       : "");
    }
}

// A share in percent; NaN where it is none.
double percent_of(const Json& json, const char* key) {
    return json.is_object() && json.contains(key) && json[key].is_number()
               ? 100 * json[key].get<double>()
               : std::nan("");
}

// Of encoding the rows, by receiver; null where the file does not say.
Json receiver_errors_json(std::span<const float> errors) {
    if (errors.empty()) return nullptr;
    const formats::ErrorSummary summary = formats::summarize_errors(errors);
    return {{"mean", summary.mean}, {"p95", summary.p95}, {"max", summary.largest}};
}

void print_receiver_errors(const Json& errors) {
    if (!errors.is_null()) {
        fmt::print(
            "row errors    {:.2f} % in the mean of receivers, {:.2f} % at most at 95 % of them, "
            "{:.2f} % at the worst: coefficients dropped and rounded, white light\n",
            percent_of(errors, "mean"), percent_of(errors, "p95"), percent_of(errors, "max"));
    }
}

// Vertices that interpolate the rows of others.
std::size_t count_mixed(const formats::SlotsView& slots) {
    return static_cast<std::size_t>(
        std::ranges::count_if(slots.mix, [](const auto& mix) { return !mix.is_one(); }));
}

Json describe(const OpenedAsset& asset, std::span<const float> receiver_errors) {
    const formats::AssetView& view = asset.loaded.view;
    Json info;
    info["format_version"] = formats::kOpalVersion;
    info["bytes"] = asset.file.bytes().size();
    info["cubemap"] = view.cubemap_size;
    info["receivers"] = view.receivers();
    info["slots"] = view.slots.empty() ? view.receivers() : view.slots.vertex.size();
    info["mixed"] = count_mixed(view.slots);
    info["copies"] = view.copies.size();
    info["rows"] = view.transport.rows();
    info["coefficients"] = view.transport.row_offset.back();
    info["code_bits"] = view.transport.code_bits;
    info["receiver_errors"] = receiver_errors_json(receiver_errors);
    info["images"] = view.images.size();
    info["primitives"] = Json::array();
    for (const formats::PrimitiveRecord& p : view.primitives) {
        info["primitives"].push_back({{"node", p.node},
                                      {"mesh", p.mesh},
                                      {"primitive", p.primitive},
                                      {"vertices", p.vertex_count},
                                      {"vertices_added", view.added.of(info["primitives"].size())},
                                      {"triangles", p.index_count / 3},
                                      {"shading", shading_name(p.shading)},
                                      {"terms", p.terms},
                                      {"bands", p.bands}});
        Json& entry = info["primitives"].back();
        entry["alpha_mode"] = alpha_mode_of(view, info["primitives"].size() - 1);
        if (p.shading == formats::Shading::translucent) {
            const std::size_t i = info["primitives"].size() - 1;
            entry["eta"] = p.eta;
            entry["separate"] = p.is_separate();
            entry["roughness"] = is_glossy(view, i) ? Json(view.roughness[i]) : Json(nullptr);
        }
    }
    info["volumes"] = Json::array();
    for (const formats::VolumeRecord& record : view.volumes.records) {
        const VolumeFacts facts = volume_facts(view.volumes, record);
        info["volumes"].push_back({{"bricks", record.brick_count},
                                   {"active_voxels", facts.active_voxels},
                                   {"nodes", record.node_count},
                                   {"spacing", record.spacing},
                                   {"single_terms", record.single_terms},
                                   {"multiple_terms", record.multiple_terms},
                                   {"bands", record.bands},
                                   {"bytes", facts.bytes},
                                   {"bytes_per_active_voxel", facts.bytes_per_active_voxel()}});
    }
    info["layers"] = layers_json(view.clouds);
    info["emitters"] = emitters_json(view);
    info["sections"] = Json::array();
    for (const formats::SectionEntry& section : asset.loaded.sections) {
        info["sections"].push_back({{"id", formats::section_name(section.id)},
                                    {"size", section.size},
                                    {"stored_size", section.stored_size},
                                    {"codec", section.codec == 0 ? "none" : "zstd"}});
    }
    // A damaged provenance must not hide the rest.
    info["provenance"] = Json::parse(view.provenance, nullptr, false);
    if (info["provenance"].is_discarded()) {
        info["provenance"] = nullptr;
    }
    return info;
}

std::string text_of(const Json& json, const char* key) {
    if (!json.is_object() || !json.contains(key)) return "unknown";
    return printable(json[key].is_string()
                         ? json[key].get<std::string>()
                         : json[key].dump(-1, ' ', true, Json::error_handler_t::replace));
}

void print_volume_error(const Json& error) {
    fmt::print("volumes err   {:.1f} % RMS", percent_of(error, "rms_relative"));
    if (error.contains("by_light") && error["by_light"].is_object()) {
        for (const auto& [name, part] : error["by_light"].items()) {
            fmt::print(", {} {:.1f} %", printable(name), percent_of(part, "rms_relative"));
        }
    }
    fmt::print(" ({} rays checked)\n", text_of(error, "rays_checked"));
}

void print_layer_error(const Json& error) {
    fmt::print("layer errs    {:.2f} % RMS: tables {:.2f} %, droplets {:.2f} %\n",
               percent_of(error, "rms_relative"), percent_of(error, "tables"),
               percent_of(error, "droplets"));
}

bool has_object(const Json& json, const char* key) {
    return json.contains(key) && json[key].is_object();
}

// Of noise that is subtracted little or nothing may be left: the interval says how much could be.
void print_interval(const Json& error) {
    const Json ends = error.value("ci95", Json());
    if (ends.is_array() && ends.size() == 2 && ends[0].is_number() && ends[1].is_number()) {
        fmt::print(" (95 %: {:.2f} to {:.2f})", 100 * ends[0].get<double>(),
                   100 * ends[1].get<double>());
    }
}

// The self-check's error at vertices.
void print_error(const Json& error) {
    const bool is_checked = text_of(error, "receivers_checked") != "0";
    fmt::print("measured error ");
    if (is_checked) {
        fmt::print("{:.2f} % RMS", percent_of(error, "rms_relative"));
        print_interval(error);
    } else {
        fmt::print("none");
    }
    for (const auto& [key, place] :
         {std::pair{"at_receivers", "at receivers"}, {"between", "between them"}}) {
        const double own = percent_of(error.value(key, Json()), "rms_relative");
        if (is_checked && !std::isnan(own)) fmt::print(", {:.2f} % {}", own, place);
    }
    fmt::print(" ({} receivers checked)", text_of(error, "receivers_checked"));
    for (const Json& name : error.value("not_measured", Json::array())) {
        fmt::print(", without {}", name.is_string() ? printable(name.get<std::string>()) : "?");
    }
    if (const double model = percent_of(error, "model_estimate"); model > 0.05) {
        fmt::print("; the model, some {:.1f} %", model);
    }
    fmt::print("\n");
}

void print_provenance(const Json& provenance) {
    if (!provenance.is_object()) return;
    fmt::print("generator     {}, {}\n", text_of(provenance, "generator"),
               text_of(provenance, "ray_tracer"));
    if (provenance.contains("scene")) {
        fmt::print("scene sha256  {}\n", text_of(provenance["scene"], "sha256"));
    }
    if (has_object(provenance, "knobs")) {
        const Json& knobs = provenance["knobs"];
        fmt::print("knobs         quality {}, cube map {}, coefficients {}, {} bits, seed {}\n",
                   text_of(provenance, "quality"), text_of(knobs, "cubemap"),
                   text_of(knobs, "coefficients"), text_of(knobs, "code_bits"),
                   text_of(provenance, "seed"));
    }
    // A file of volumes or a layer alone has no receivers to check.
    const bool has_volume_error = has_object(provenance, "volume_error");
    const bool has_layer_error = has_object(provenance, "layer_error");
    const Json error = provenance.value("error", Json());
    if (!std::isnan(percent_of(error, "rms_relative")) &&
        !((has_volume_error || has_layer_error) && text_of(error, "receivers_checked") == "0")) {
        print_error(error);
    }
    if (has_object(provenance, "model_error")) {
        const Json& model = provenance["model_error"];
        fmt::print("model error   {:.1f} % RMS, {:+.1f} % in the mean, at {} receivers\n",
                   percent_of(model, "rms_relative"), percent_of(model, "bias"),
                   text_of(model, "receivers_checked"));
        if (has_object(model, "suns")) {
            const Json& suns = model["suns"];
            fmt::print("  of suns     {:.1f} % RMS, {:+.1f} % in the mean, {} degrees across\n",
                       percent_of(suns, "rms_relative"), percent_of(suns, "bias"),
                       text_of(suns, "degrees"));
        }
    }
    if (has_volume_error) {
        print_volume_error(provenance["volume_error"]);
    }
    if (has_layer_error) {
        print_layer_error(provenance["layer_error"]);
    }
    if (provenance.contains("plan") && provenance["plan"].is_array()) {
        fmt::print("plan\n");
        for (const Json& entry : provenance["plan"]) {
            fmt::print("  {} {} for {}: {}\n", text_of(entry, "effect"), text_of(entry, "decision"),
                       text_of(entry, "subject"), text_of(entry, "reason"));
        }
    }
}

void print_volumes(const formats::VolumesView& volumes) {
    if (!volumes.empty()) {
        fmt::print("volumes\n");
    }
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const formats::VolumeRecord& record = volumes.records[v];
        const VolumeFacts facts = volume_facts(volumes, record);
        fmt::print(
            "  {:>3}  {:>8} bricks, {} active voxels, {} nodes every {} voxel(s)\n"
            "       terms: {} single, {} multiple, {}; {:.1f} bytes per active voxel\n",
            v, record.brick_count, facts.active_voxels, record.node_count, record.spacing,
            record.single_terms, record.multiple_terms, record.bands == 1 ? "grey" : "RGB",
            facts.bytes_per_active_voxel());
    }
}

int run(const InfoCommand& options) {
    const auto asset = require(open_asset(options.path));
    const auto receiver_errors =
        require(formats::read_receiver_errors(asset.file.bytes(), asset.loaded, options.path));
    const Json info = describe(asset, receiver_errors);
    if (options.json) {
        fmt::print("{}", json_text(info));
        return kExitSuccess;
    }
    const formats::AssetView& view = asset.loaded.view;
    fmt::print("{}: {}, .opal version {}\n", printable(options.path),
               format_bytes(static_cast<double>(asset.file.bytes().size())), formats::kOpalVersion);
    fmt::print("basis         Haar, cube map 6 x {0} x {0}\n", view.cubemap_size);
    fmt::print("transport     {} rows, {:.1f} details a row, {} bits\n", view.transport.rows(),
               view.transport.rows() == 0
                   ? 0.0
                   : static_cast<double>(view.transport.row_offset.back()) / view.transport.rows(),
               view.transport.code_bits);
    if (!view.slots.empty()) {
        const std::size_t mixed = count_mixed(view.slots);
        fmt::print("              {} vertices share the rows of {}{}\n", view.receivers(),
                   view.slots.vertex.size(),
                   mixed > 0 ? fmt::format(", {} of them interpolated", mixed) : "");
    }
    if (!view.copies.empty()) {
        fmt::print("              {} primitives are copies: they have the rows of others\n",
                   view.copies.size());
    }
    print_receiver_errors(info["receiver_errors"]);
    print_provenance(info["provenance"]);
    print_volumes(view.volumes);
    print_layers(view.clouds);
    print_emitters(info["emitters"]);
    if (!view.primitives.empty()) {
        fmt::print("primitives\n");
    }
    for (std::size_t i = 0; i < view.primitives.size(); ++i) {
        const formats::PrimitiveRecord& p = view.primitives[i];
        fmt::print(
            "  {:>3}  {:>8} vertices{} {:>8} triangles  {} term(s), {}{}{}{}{}{}{}\n", i,
            p.vertex_count,
            view.added.of(i) == 0 ? "" : fmt::format(" ({} added)", view.added.of(i)),
            p.index_count / 3, p.terms, p.bands == 1 ? "grey" : "RGB",
            p.shading == formats::Shading::sheet ? ", thin-walled" : "",
            p.is_separate()
                ? ", " + formats::term_names(formats::TermSet::separable, " and ") + " separate"
                : "",
            is_glossy(view, i) ? fmt::format(", roughness {:.2g}", view.roughness[i]) : "",
            p.base_color_image == formats::kNoImage ? "" : ", textured",
            view.normal_maps.of(static_cast<std::uint32_t>(i)) == nullptr ? "" : ", normal map",
            view.holes.of(static_cast<std::uint32_t>(i)) == nullptr
                ? ""
                : std::string(", alpha ") + alpha_mode_of(view, i));
    }
    fmt::print("sections\n");
    for (const formats::SectionEntry& section : asset.loaded.sections) {
        fmt::print("  {}  {:>10}{}\n", formats::section_name(section.id),
                   format_bytes(static_cast<double>(section.stored_size)),
                   section.codec == 0
                       ? ""
                       : fmt::format("  (zstd, {} decoded)",
                                     format_bytes(static_cast<double>(section.size))));
    }
    return kExitSuccess;
}

}  // namespace

void add_info_command(Program& program) {
    auto [command, options] =
        add_command<InfoCommand>(program, "info", "Say what is inside an .opal file", run);
    add_asset_argument(command, options.path);
    command.add_flag("--json", options.json, "print JSON");
    command.footer("Example:\n  opaline info scene.opal");
}

}  // namespace opaline::cli
