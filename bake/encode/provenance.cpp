#include "bake/encode/provenance.h"

#include <nlohmann/json.hpp>

namespace opaline::bake {

using Json = nlohmann::ordered_json;

Json knobs_json(const Knobs& knobs) {
    return {{"cubemap", knobs.cubemap_size},
            {"coefficients",
             knobs.coefficients == kAllCoefficients ? Json("all") : Json(knobs.coefficients)},
            {"code_bits", knobs.code_bits},
            {"samples", knobs.samples},
            {"samples_per_path", knobs.samples_per_path},
            {"epsilon", knobs.tolerance},
            {"depth_samples", knobs.depth_samples},
            {"single_cubemap", knobs.single_cubemap},
            {"phase_terms", knobs.phase_terms == 0 ? Json("auto") : Json(knobs.phase_terms)},
            {"separate_terms", knobs.separate_terms}};
}

namespace {

Json bounds_json(const MeasuredError& error) {
    return {{"rms_relative", error.rms_relative}, {"ci95", {error.ci95[0], error.ci95[1]}}};
}

}  // namespace

Json error_json(const ErrorReport& error) {
    Json json = {{"rms_relative", error.rms_relative},
                 {"ci95", {error.ci95[0], error.ci95[1]}},
                 {"p95_relative", error.p95_relative},
                 {"max_relative", error.max_relative},
                 {"receivers_checked", error.receivers_checked},
                 {"points_between_checked", error.points_between_checked},
                 {"reference", error.reference},
                 {"at_receivers", bounds_json(error.at_receivers)},
                 {"between", bounds_json(error.between)},
                 {"by_effect", Json::object()},
                 {"by_light", Json::object()}};
    for (const ErrorReport::Part& effect : error.by_effect) {
        json["by_effect"][effect.name] = effect.rms_relative;
    }
    for (const ErrorReport::Part& light : error.by_light) {
        json["by_light"][light.name] = light.rms_relative;
    }
    return json;
}

Json model_error_json(const ModelErrorReport& error) {
    Json json = {{"rms_relative", error.rms_relative},
                 {"ci95", {error.ci95[0], error.ci95[1]}},
                 {"bias", error.bias},
                 {"missing", error.missing},
                 {"receivers_checked", error.receivers_checked},
                 {"samples", error.samples},
                 {"reference", error.reference},
                 {"by_light", Json::object()},
                 {"left_out", error.left_out}};
    for (const ModelErrorReport::Part& light : error.by_light) {
        json["by_light"][light.name] = {{"rms_relative", light.rms_relative},
                                        {"bias", light.bias},
                                        {"missing", light.missing},
                                        {"noise", light.noise},
                                        {"samples", light.samples}};
    }
    return json;
}

std::string make_provenance(const formats::Scene& scene, const Knobs& knobs,
                            const std::vector<PlanEntry>& plan, const ErrorReport& error,
                            const std::optional<ModelErrorReport>& model_error,
                            std::string_view ray_tracer) {
    Json root;
    root["generator"] = std::string("Opaline ") + OPALINE_VERSION;
    root["ray_tracer"] = ray_tracer;
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
    root["plan"] = Json::array();
    for (const PlanEntry& entry : plan) {
        root["plan"].push_back({{"effect", entry.effect},
                                {"subject", entry.subject},
                                {"decision", entry.on ? "on" : "off"},
                                {"reason", entry.reason},
                                {"bound", entry.bound}});
    }
    root["error"] = error_json(error);
    if (model_error) {
        root["model_error"] = model_error_json(*model_error);
    }
    // Names come from the user's file: bytes that are not UTF-8 must not stop the bake.
    return root.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace opaline::bake
