#include "bake/pipeline/emitter_stages.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/accuracy/error_warnings.h"
#include "bake/emitters/bake_emitters.h"
#include "bake/emitters/emitter_knobs.h"

namespace opaline::bake {
namespace {

// Flights of a particle, mostly: surfaces in a room take it after three or four.
constexpr double kFlights = 4;
// Rays that meet surfaces everywhere, over rays beside each other.
constexpr double kIncoherent = 4;

void warn_of_unlit(const formats::Scene& scene, std::vector<formats::Diagnostic>& warnings) {
    const bool has_media = std::ranges::any_of(scene.primitives, [&](const auto& primitive) {
        return scene.materials[primitive.material].medium.has_value();
    });
    std::string unlit = has_media ? "translucent media" : "";
    if (!scene.volumes.empty()) unlit += unlit.empty() ? "volumes" : ", volumes";
    if (!scene.layers.empty()) unlit += unlit.empty() ? "cloud layers" : ", cloud layers";
    if (unlit.empty()) return;
    warnings.push_back(formats::make_warning(
        "", "emitters", "their light does not reach " + unlit + ", which stay dark under it",
        has_media ? "media that should be lit by lamps may be made thin-walled or opaque"
                  : "nothing needs to be done where that is not seen"));
}

}  // namespace

formats::Status add_lamp_rows(const BakeInputs& bake, std::span<const Lamp> lamps,
                              const Context& context, BakeResult& result) {
    auto baked = bake_emitters(
        {bake.scene, bake.rays, bake.receivers, result.asset.primitives, lamps, result.knobs},
        context, result.stages);
    if (!baked) {
        return std::move(baked).error();
    }
    result.asset.emitters = std::move(baked->emitters);
    if (baked->error.receivers_checked > 0) {
        result.error.by_effect.push_back({"emitters", baked->error.rms_relative});
    } else {
        result.error.not_measured.emplace_back("emitters");
    }
    const double limit = result.knobs.error_target > 0 ? result.knobs.error_target
                                                       : acceptable_error(result.knobs.quality);
    if (baked->error.rms_relative > limit) {
        result.warnings.push_back(formats::make_warning(
            "", "emitters",
            "their light errs by " + error_percent(baked->error.rms_relative) + ", more than " +
                error_percent(limit),
            "give more --emitter-rays and --emitter-particles"));
    }
    warn_of_unlit(bake.scene, result.warnings);
    return formats::ok_status();
}

void bill_lamps(const CostRequest& request, std::span<PlanEntry> plan, Bill& bill) {
    const double ray = kIncoherent * request.rates.coherent_ray.at(request.facts.triangles);
    const double rays = request.knobs[kEmitterRays] * request.facts.receivers;
    const auto for_each = [&](const char* stage, double seconds) {
        bool is_open = false;
        for (PlanEntry& entry : plan) {
            if (!entry.on || entry.subject.kind != Subject::Kind::emitter) continue;
            if (!is_open) bill.open(stage);
            is_open = true;
            bill.add({0, seconds}, &entry);
        }
        return is_open;
    };
    if (!for_each("particles of emitters", kFlights * request.knobs[kEmitterParticles] * ray)) {
        return;
    }
    for_each("light of emitters", rays * ray);
    bill.add({0, rays * ray});  // to surfaces that reflect, for all
    bill.open("self-check of emitters");
    for (PlanEntry& entry : plan) {
        if (entry.on && entry.subject.kind == Subject::Kind::emitter) {
            bill.add_bytes(6 * request.facts.receivers, &entry);
        }
    }
}

}  // namespace opaline::bake
