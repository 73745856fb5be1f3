#include "bake/effects/interreflection/interreflection.h"

#include <array>
#include <utility>

#include "bake/effects/interreflection/add_bounced.h"
#include "bake/effects/interreflection/bounce_costs.h"
#include "bake/effects/interreflection/bounce_light.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/effects/interreflection/rule_interreflection.h"
#include "bake/effects/interreflection/rule_textures.h"
#include "bake/effects/interreflection/seen_light.h"
#include "bake/effects/interreflection/true_bounces.h"

namespace opaline::bake {
namespace {

constexpr std::array<DecisionRule, 2> kRules{
    {{"interreflection", is_any_material, decide_interreflection,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.coloured = entry.on && entry.has_bands;
      }},
     {"interreflection.textures", has_textures, decide_textures,
      [](const PlanEntry& entry, RowLayout& layout) { layout.filtered = entry.on; }}}};
constexpr std::array<const KnobSpec*, 1> kKnobs{&kBounceRays};

std::unique_ptr<OtherLight> make_light(const LightInputs& inputs, std::uint64_t& rays) {
    const std::shared_ptr<const BounceLight> bounced = find_bounce_light(inputs, rays);
    if (!bounced) {
        return nullptr;
    }
    auto light = std::make_unique<OtherLight>();
    light->bands = bounced->bands;
    light->name = "interreflection";
    light->make_truth = [bounced](std::span<const TestLight> lights) {
        const auto truth = std::make_shared<const BounceTruth>(make_bounce_truth(bounced, lights));
        return [truth](const Receiver& at, std::uint64_t key, std::uint32_t count,
                       std::span<double> irradiance) {
            return add_true_bounces(*truth, at, key, count, irradiance);
        };
    };
    light->add_seen = [bounced](std::span<const SurfaceView> views, double solid_angle,
                                std::uint32_t cubemap_size, std::uint32_t bands,
                                std::span<float> rows) {
        return add_seen_light(*bounced, views, solid_angle, cubemap_size, bands, rows);
    };
    light->make_seen_truth = [bounced](std::span<const TestLight> lights) {
        const auto truth = std::make_shared<const BounceTruth>(make_bounce_truth(bounced, lights));
        return [truth](const Receiver& along, formats::Rgb weight, std::uint64_t key,
                       std::uint32_t number, std::span<double> luminance) {
            return add_true_view(*truth, along, weight, key, number, luminance);
        };
    };
    for (const std::uint8_t acts : inputs.acts) {
        light->unreached.push_back(acts == 0 ? 1 : 0);
    }
    light->add = [bounced](const LitPoint& point, std::uint32_t cubemap_size,
                           std::span<float> rows) {
        return add_bounced(*bounced, point, cubemap_size, rows);
    };
    return light;
}

}  // namespace

EffectDescriptor describe_interreflection(Effect id) {
    return {.id = id,
            .name = "interreflection",
            .help = "light that one surface sends to another",
            .rules = kRules,
            .knobs = kKnobs,
            .gather = {.work = bounce_rows_work},
            .make_light = make_light,
            .light_work = bounce_light_work,
            .held_light = formats::TermSet::interreflection};
}

}  // namespace opaline::bake
