#include "bake/encode/provenance.h"

#include <nlohmann/json.hpp>

namespace opaline::bake {

std::string make_provenance(const formats::Scene& scene, Quality quality, const Knobs& knobs,
                            const std::vector<PlanEntry>& plan, const ErrorReport& error,
                            std::string_view ray_tracer) {
    using Json = nlohmann::ordered_json;
    Json root;
    root["generator"] = std::string("Opaline ") + OPALINE_VERSION;
    root["ray_tracer"] = ray_tracer;
    root["scene"]["sha256"] = scene.sha256;
    for (const formats::Primitive& p : scene.primitives) {
        root["scene"]["primitives"].push_back(
            {{"name", p.name}, {"material", scene.materials[p.material].name}});
    }
    root["seed"] = knobs.seed;
    root["knobs"] = {{"quality", quality_name(quality)},
                     {"cubemap", knobs.cubemap_size},
                     {"code_bits", knobs.code_bits},
                     {"samples", knobs.samples},
                     {"epsilon", knobs.tolerance}};
    if (knobs.coefficients == kAllCoefficients) {
        root["knobs"]["coefficients"] = "all";
    } else {
        root["knobs"]["coefficients"] = knobs.coefficients;
    }
    root["plan"] = Json::array();
    for (const PlanEntry& entry : plan) {
        root["plan"].push_back({{"effect", entry.effect},
                                {"subject", entry.subject},
                                {"decision", entry.on ? "on" : "off"},
                                {"reason", entry.reason},
                                {"bound", entry.bound}});
    }
    root["error"] = {{"rms_relative", error.rms_relative},
                     {"ci95", {error.ci95[0], error.ci95[1]}},
                     {"p95_relative", error.p95_relative},
                     {"max_relative", error.max_relative},
                     {"receivers_checked", error.receivers_checked},
                     {"reference", error.reference},
                     {"by_effect", Json::object()}};
    for (const ErrorReport::ByEffect& effect : error.by_effect) {
        root["error"]["by_effect"][effect.effect] = effect.rms_relative;
    }
    // Names come from the user's file: bytes that are not UTF-8 must not stop the bake.
    return root.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace opaline::bake
