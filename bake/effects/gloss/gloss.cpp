#include "bake/effects/gloss/gloss.h"

#include <algorithm>
#include <array>

#include "bake/scene/lobe_record.h"
#include "formats/opal/gloss_model.h"

namespace opaline::bake {
namespace {

bool is_glossy(const PlanInput& input) {
    return !input.material.medium && !input.material.gloss.is_diffuse();
}

// Under `white` the lobe returns its directional albedo, which is largest where the surface is
// smoothest and at grazing views; an image scales roughness down to 0 at most.
double largest_albedo(const formats::Material& material) {
    constexpr float kGrazing = 1e-3f;
    const formats::GlossRecord record = make_lobe_record(material.gloss);
    const float roughness =
        material.gloss.image == formats::kNone ? material.gloss.roughness : 0.0f;
    const formats::Rgb white{1, 1, 1};
    double largest = 0;
    for (const float cosine : {kGrazing, 0.1f, 0.5f, 1.0f}) {
        const formats::Rgb e =
            formats::eval_gloss_albedo(
                formats::make_gloss_surface(record, white, material.gloss.metallic, roughness),
                cosine)
                .specular;
        largest = std::max(largest, static_cast<double>(std::max({e.r, e.g, e.b})));
    }
    return std::min(1.0, largest);
}

PlanEntry decide(const PlanInput& input) {
    PlanEntry entry;
    entry.bound = largest_albedo(input.material);
    if (!is_wanted(input.knobs, "gloss")) {
        entry.reason = "left out by --effects";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the surface hardly mirrors anything";
    } else {
        entry.reason = input.material.gloss.metallic == 1 ? "the metal mirrors its surroundings"
                                                          : "the surface mirrors its surroundings";
    }
    return entry;
}

constexpr std::array<DecisionRule, 1> kRules{
    {{"gloss", is_glossy, decide,
      [](const PlanEntry& entry, RowLayout& layout) { layout.mirrors = entry.on; }}}};

}  // namespace

EffectDescriptor describe_gloss(Effect id) {
    return {.id = id,
            .name = "gloss",
            .help = "light mirrored by opaque surfaces",
            .rules = kRules,
            .reads_openness = true};
}

}  // namespace opaline::bake
