#include "bake/check/check_lit_media.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/model_pairs.h"
#include "bake/reference/light_sampler.h"
#include "bake/reference/reference_scene.h"
#include "formats/opal/environment.h"
#include "runtime/light_vector.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCheckedReceivers = 24, kMostDrawn = 1024;

// Translucent receivers, as check_model chooses them: drawn from all, so that many are left.
std::vector<ReferenceReceiver> choose_translucent(const ReferenceScene& scene,
                                                  const formats::AssetView& asset,
                                                  std::uint64_t seed) {
    double all = 0, translucent = 0;
    for (const formats::PrimitiveRecord& record : asset.primitives) {
        all += record.vertex_count;
        translucent += record.shading == formats::Shading::translucent ? record.vertex_count : 0;
    }
    if (translucent == 0) return {};
    const double wanted = 1.5 * kCheckedReceivers * all / translucent;
    std::vector<ReferenceReceiver> receivers = choose_model_receivers(
        scene, static_cast<std::uint32_t>(std::min<double>(wanted, kMostDrawn)), seed);
    std::erase_if(receivers, [&](const ReferenceReceiver& receiver) {
        return asset.primitives[receiver.primitive].shading != formats::Shading::translucent;
    });
    if (receivers.size() > kCheckedReceivers) {
        // Evenly spaced in the order of the scene.
        std::vector<ReferenceReceiver> kept;
        kept.reserve(kCheckedReceivers);
        for (std::size_t i = 0; i < kCheckedReceivers; ++i) {
            kept.push_back(receivers[i * receivers.size() / kCheckedReceivers]);
        }
        receivers = std::move(kept);
    }
    return receivers;
}

}  // namespace

formats::Result<LitMediaError> check_lit_media(const formats::Scene& given,
                                               const formats::AssetView& asset,
                                               std::span<const Lamp> lamps, std::uint64_t seed,
                                               const Context& context) {
    const bool leaves_lights = has_refraction(given) && !given.lights.empty();
    std::optional<formats::Scene> without_lights;
    if (leaves_lights) {
        without_lights = given;
        without_lights->lights.clear();
    }
    std::vector<formats::Rgb> colors;
    colors.reserve(lamps.size());
    for (const Lamp& lamp : lamps) {
        const bool is_left = leaves_lights && !lamp.lights.empty();
        colors.push_back(is_left ? formats::Rgb{0, 0, 0} : formats::Rgb{1, 1, 1});
    }
    LitMediaError error;
    if (std::ranges::all_of(colors, [](formats::Rgb c) { return c == formats::Rgb{0, 0, 0}; })) {
        return error;
    }
    const auto scene =
        make_reference_scene(without_lights ? *without_lights : given, context.threads);
    if (!scene) return scene.error();
    const std::vector<ReferenceReceiver> receivers = choose_translucent(*scene, asset, seed);
    if (receivers.empty()) return error;
    const formats::Environment black;
    const LightSampler sky = make_light_sampler(black, glm::mat3(1.0f));
    const runtime::LightVector vector =
        runtime::project_environment(black, asset.cubemap_size, {}, context.threads);
    const std::vector<double> baked =
        relight_receivers(asset, receivers, {.vector = vector, .emitters = {.color = colors}});
    const PathSpace space{*scene, sky, {.terms = TermSet::emitters, .own_mirror = false}};
    ModelCheckOptions options;
    options.seed = seed;
    options.max_events = static_cast<std::uint64_t>(kLitMediaEvents);
    const auto check = check_light({&space, 1}, receivers, baked, options, context);
    if (!check) return check.error();
    const MeanSquares sum = sum_up(check->pairs);
    error.noise = sum.noise();
    error.rms_relative = std::max(sum.rms_relative(), error.noise);
    error.bias = sum.bias();
    error.receivers_checked = static_cast<std::uint32_t>(receivers.size());
    error.samples = check->samples;
    return error;
}

}  // namespace opaline::bake
