#include "bake/pipeline/provenance.h"

#include <nlohmann/json.hpp>

#include "bake/pipeline/pipeline.h"
#include "bake/trace/embree_scene.h"

namespace opaline::bake {

using Json = nlohmann::ordered_json;

Json knobs_json(const Knobs& knobs) {
    Json json = {{"cubemap", knobs.cubemap_size},
                 {"coefficients",
                  knobs.coefficients == kAllCoefficients ? Json("all") : Json(knobs.coefficients)},
                 {"code_bits", knobs.code_bits}};
    for (const auto& [knob, value] : knobs.values.values) {
        Json& own = json[std::string(knob->name)];
        if (!knob->words.empty()) {
            own = std::string(knob->words[static_cast<std::size_t>(value)]);
        } else if (knob->zero_is_auto && value == 0) {
            own = "auto";
        } else if (knob->whole) {
            own = static_cast<std::uint64_t>(value);
        } else {
            own = value;
        }
    }
    json["separate_terms"] = knobs.separate_terms;
    return json;
}

namespace {

template <class Measured>
Json bounds_json(const Measured& error) {
    return {{"rms_relative", error.rms_relative}, {"ci95", {error.ci95[0], error.ci95[1]}}};
}

}  // namespace

Json error_json(const ErrorReport& error) {
    Json json = bounds_json(error);
    json.update({{"p95_relative", error.p95_relative},
                 {"max_relative", error.max_relative},
                 {"receivers_checked", error.receivers_checked},
                 {"points_between_checked", error.points_between_checked},
                 {"reference", error.reference},
                 {"at_receivers", bounds_json(error.at_receivers)},
                 {"between", bounds_json(error.between)},
                 {"not_measured", error.not_measured},
                 {"by_effect", Json::object()},
                 {"by_light", Json::object()}});
    for (const ErrorReport::Part& effect : error.by_effect) {
        json["by_effect"][effect.name] = effect.rms_relative;
    }
    for (const ErrorReport::Part& light : error.by_light) {
        json["by_light"][light.name] = light.rms_relative;
    }
    return json;
}

Json model_error_json(const ModelErrorReport& error) {
    Json json = bounds_json(error);
    json.update({{"bias", error.bias},
                 {"missing", error.missing},
                 {"receivers_checked", error.receivers_checked},
                 {"samples", error.samples},
                 {"reference", error.reference},
                 {"by_light", Json::object()},
                 {"left_out", error.left_out}});
    if (const auto& mirrored = error.mirrored) {
        json["mirrored"] = bounds_json(*mirrored);
        json["mirrored"].update(
            {{"bias", mirrored->bias}, {"receivers_checked", mirrored->receivers_checked}});
    }
    if (const auto& suns = error.suns) {
        json["suns"] = bounds_json(*suns);
        json["suns"].update({{"bias", suns->bias},
                             {"noise", suns->noise},
                             {"degrees", ModelErrorReport::Suns::degrees},
                             {"suns", suns->suns},
                             {"receivers_checked", suns->receivers_checked},
                             {"samples", suns->samples}});
    }
    for (const ModelErrorReport::Part& light : error.by_light) {
        json["by_light"][light.name] = {{"rms_relative", light.rms_relative},
                                        {"bias", light.bias},
                                        {"missing", light.missing},
                                        {"noise", light.noise},
                                        {"samples", light.samples}};
    }
    return json;
}

Json volume_error_json(const VolumeErrorReport& error) {
    Json json = {{"rms_relative", error.rms_relative}, {"ci95", {error.ci95[0], error.ci95[1]}},
                 {"rays_checked", error.rays_checked}, {"samples", error.samples},
                 {"reference", error.reference},       {"by_light", Json::object()}};
    for (const VolumeErrorReport::Part& part : error.by_light) {
        json["by_light"][part.name] = {{"rms_relative", part.rms_relative},
                                       {"ci95", {part.ci95[0], part.ci95[1]}},
                                       {"bias", part.bias},
                                       {"noise", part.noise},
                                       {"scattered_alone", part.scattered_alone}};
    }
    return json;
}

Json layer_error_json(const LayerErrorReport& error) {
    return {{"rms_relative", error.rms_relative},
            {"ci95", {error.ci95[0], error.ci95[1]}},
            {"tables", error.tables},
            {"worst", error.worst},
            {"droplets", error.droplets},
            {"phase_rms", error.phase_rms},
            {"flux", error.flux},
            {"radiances_checked", error.radiances_checked},
            {"reference", error.reference}};
}

namespace {

// What droplets do to red, green and blue light.
Json layer_json(const formats::LayerRecord& record) {
    Json json{{"fidelity", record.is_paper() ? "paper" : "physical"},
              {"peak_angle", record.peak_angle},
              {"bands", Json::array()}};
    for (const formats::LayerBand& band : record.band) {
        json["bands"].push_back(
            {{"kappa", band.kappa}, {"peak_weight", band.peak_weight}, {"g", band.g}});
    }
    return json;
}

}  // namespace

void add_other_errors(const BakeResult& result, Json& json) {
    if (result.model_error) json["model_error"] = model_error_json(*result.model_error);
    if (result.volume_error) json["volume_error"] = volume_error_json(*result.volume_error);
    if (result.layer_error) json["layer_error"] = layer_error_json(*result.layer_error);
}

std::string ray_tracer_name() {
    return EmbreeScene::description();
}

std::string make_provenance(const formats::Scene& scene, const BakeResult& result) {
    const Knobs& knobs = result.knobs;
    Json root;
    root["generator"] = std::string("Opaline ") + OPALINE_VERSION;
    root["ray_tracer"] = ray_tracer_name();
    root["scene"]["sha256"] = scene.sha256;
    for (const formats::Primitive& p : scene.primitives) {
        root["scene"]["primitives"].push_back(
            {{"name", p.name}, {"material", scene.materials[p.material].name}});
    }
    root["seed"] = knobs.seed;
    root["quality"] = knobs.error_target > 0 ? "as --error asked" : quality_name(knobs.quality);
    if (knobs.error_target > 0) {
        root["error_requested"] = knobs.error_target;
    }
    root["knobs"] = knobs_json(knobs);
    if (result.refinement.added > 0) {
        root["refinement"] = {{"receivers_added", result.refinement.added},
                              {"error_before", result.refinement.error_before},
                              {"error_after", result.refinement.error_after}};
    }
    root["plan"] = Json::array();
    for (const PlanEntry& entry : result.plan) {
        root["plan"].push_back({{"effect", entry.name},
                                {"subject", entry.subject.name},
                                {"decision", entry.on ? "on" : "off"},
                                {"reason", entry.reason},
                                {"bound", entry.bound}});
    }
    root["error"] = error_json(result.error);
    root["error"]["model_estimate"] = knobs.model_error;
    add_other_errors(result, root);
    for (const formats::LayerRecord& layer : result.asset.clouds.records) {
        root["layers"].push_back(layer_json(layer));
    }
    // Names come from the user's file: bytes that are not UTF-8 must not stop the bake.
    return root.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace opaline::bake
