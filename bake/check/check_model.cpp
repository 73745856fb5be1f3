#include "bake/check/check_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "bake/check/check_suns.h"
#include "bake/check/model_pairs.h"
#include "bake/scene/orient_bodies.h"
#include "bake/trace/density/scaled_phase.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"

namespace opaline::bake {
namespace {

// Those of opaque surfaces that mirror. A medium's boundary is perfectly smooth in the reference.
std::vector<ReferenceReceiver> find_mirrors(const formats::AssetView& asset,
                                            std::span<const ReferenceReceiver> receivers) {
    std::vector<ReferenceReceiver> mirrors;
    for (const ReferenceReceiver& r : receivers) {
        if (!asset.gloss.empty() && asset.gloss[r.primitive].is_glossy()) {
            mirrors.push_back(r);
        }
    }
    return mirrors;
}

formats::Result<ModelErrorReport::Mirrored> check_mirrors(
    const ReferenceScene& scene, const formats::AssetView& asset,
    std::span<const ReferenceReceiver> mirrors, std::span<const ModelLight> lights,
    const ModelCheckOptions& options, const Context& context) {
    PathOptions paths;
    paths.terms = TermSet::specular;
    std::vector<ModelPair> pairs;  // light by light
    for (const ModelLight& light : lights) {
        const LightSampler sampler = make_light_sampler(light.environment, glm::mat3(1.0f));
        const runtime::LightVector vector = runtime::project_environment(
            light.environment, asset.cubemap_size, {}, context.threads);
        const runtime::SpecularLight lobes = runtime::make_specular_light(
            light.environment, runtime::specular_needs(asset), {}, context.threads);
        const auto check =
            check_light(std::array{PathSpace{scene, sampler, paths}}, mirrors,
                        relight_receivers(asset, mirrors, {vector, &lobes}), options, context);
        if (!check) return check.error();
        pairs.insert(pairs.end(), check->pairs.begin(), check->pairs.end());
    }
    ModelErrorReport::Mirrored report;
    const MeanSquares all = sum_up(pairs);
    report.rms_relative = all.rms_relative();
    report.bias = all.bias();
    report.receivers_checked = static_cast<std::uint32_t>(mirrors.size());
    std::ranges::copy(model_interval(pairs, mirrors.size(), options.seed), report.ci95);
    return report;
}

void absorb_all(formats::Volume& volume) {
    const ScaledMedium scaled = scale_medium(volume, scale_phase(volume.phase).peak);
    if (scaled.grids != nullptr) volume.density.value = scaled.grids->density.value;
    volume.sigma_t = {scaled.sigma_t[0], scaled.sigma_t[1], scaled.sigma_t[2]};
    volume.albedo = {0, 0, 0};
    volume.scattering = {};
}

// Inside another body or behind all surfaces: invisible, and the bake uses the light of its
// neighbours (visibility/hidden_receivers).
bool is_buried(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (!receiver.around.empty()) return true;
    for (std::uint32_t i = 0; i < 16; ++i) {
        RandomStream random(0, i, 0);
        glm::vec3 d{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
        d *= glm::dot(d, receiver.normal) < 0 ? -1.0f : 1.0f;
        const auto hit = scene.surfaces.closest_hit({receiver.outside}, glm::normalize(d),
                                                    std::numeric_limits<float>::infinity());
        if (!hit || glm::dot(hit->flat, d) < 0) return false;
        const formats::Scene& input = scene.surfaces.scene();
        if (input.materials[input.primitives[hit->primitive].material].double_sided) return false;
    }
    return true;
}

// An opaque surface lies close behind it in its own body, such as a floor that the body has sunk
// into. There the bake's empty body differs from the reference's.
bool is_pierced(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (receiver.medium == formats::kNone) return false;
    constexpr float kClose = 3;  // mean free paths, in the clearest channel
    const glm::vec3 sigma_t = scene.media[receiver.medium].sigma_t;
    const auto hit = scene.surfaces.closest_hit(
        {receiver.inside}, -receiver.normal,
        kClose / std::max(std::min({sigma_t.x, sigma_t.y, sigma_t.z}), 1e-30f));
    const formats::Scene& input = scene.surfaces.scene();
    return hit && scene.medium_of[input.primitives[hit->primitive].material] == formats::kNone;
}

// Its body ends just behind it and begins again: a fold of the mesh that lies on itself. Hardly any
// light scatters between. Light from below the gap has met a second surface, which bakes ignore
// (README.md).
bool is_folded(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (receiver.medium == formats::kNone) return false;
    constexpr float kThin = 1;  // mean free paths, in the clearest channel
    const glm::vec3 sigma_t = scene.media[receiver.medium].sigma_t;
    float reach = kThin / std::max(std::min({sigma_t.x, sigma_t.y, sigma_t.z}), 1e-30f);
    const glm::vec3 down = -receiver.normal;
    const formats::Scene& input = scene.surfaces.scene();
    RayOrigin from{receiver.inside};
    for (int i = 0; i < 2; ++i) {  // where it ends, and where it begins again
        const auto hit = scene.surfaces.closest_hit(from, down, reach);
        if (!hit || scene.medium_of[input.primitives[hit->primitive].material] != receiver.medium) {
            return false;
        }
        if (glm::dot(hit->flat, down) < 0) return true;
        reach -= hit->distance;
        from = go_straight_on(from, leave_surface(*hit, down));
    }
    return false;
}

// At a sharp edge of its body radiance is discontinuous, because the path along one face's normal
// lies in the other face.
bool is_on_edge(const ReferenceReceiver& receiver) {
    constexpr float kSharp = 0.9f;
    return receiver.medium != formats::kNone &&
           glm::dot(glm::normalize(receiver.outside - receiver.inside), receiver.normal) < kSharp;
}

// Marks vertices with triangles on both sides of 60 degrees from their normal: ends and folds of
// the mesh, at which no normal is right.
std::vector<std::vector<bool>> find_creases(const formats::Scene& scene) {
    constexpr float kSharp = 0.5f;
    std::vector<std::vector<bool>> creased;
    for (const formats::Primitive& p : scene.primitives) {
        std::vector<bool> facing(p.position.size()), turned(p.position.size());
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const std::uint32_t* const corner = &p.index[i];
            const glm::vec3 a = p.position[corner[0]];
            const glm::vec3 flat = glm::cross(p.position[corner[1]] - a, p.position[corner[2]] - a);
            for (int c = 0; c < 3; ++c) {
                const float cosine = glm::dot(flat, p.normal[corner[c]]);
                const float sharp = kSharp * glm::length(flat);
                facing[corner[c]] = facing[corner[c]] || cosine > sharp;
                turned[corner[c]] = turned[corner[c]] || cosine < sharp;
            }
        }
        for (std::size_t v = 0; v < facing.size(); ++v) {
            facing[v] = facing[v] && turned[v];
        }
        creased.push_back(std::move(facing));
    }
    return creased;
}

}  // namespace

TermSet held_light(const EffectTable& effects, std::span<const PlanEntry> plan) {
    TermSet held = ModelCheckOptions().simulated;
    for (const PlanEntry& entry : entries_of(plan, Subject::Kind::material)) {
        held |= entry.on ? rule_of(effects, entry).held : TermSet::none;
    }
    return held;
}

formats::Result<ModelErrorReport> check_model(const formats::Scene& given,
                                              const formats::AssetView& asset,
                                              const ModelCheckOptions& options,
                                              const Context& context) {
    const auto start = std::chrono::steady_clock::now();
    const auto scenes = make_model_scenes(given, context.threads);
    if (!scenes) return scenes.error();
    std::vector<std::string> left_out;
    const auto lights = make_model_lights(given, left_out);
    if (!lights) return lights.error();
    const std::vector<ReferenceReceiver> receivers =
        choose_model_receivers(scenes->whole, options.receivers, options.seed);
    std::vector<LightCheck> checks;
    for (const ModelLight& light : *lights) {
        const runtime::LightVector vector = runtime::project_environment(
            light.environment, asset.cubemap_size, {}, context.threads);
        auto check = check_unmirrored(*scenes, light, receivers,
                                      relight_receivers(asset, receivers, {.vector = vector}),
                                      options, context);
        if (!check) return std::move(check).error();
        checks.push_back(std::move(*check));
    }
    ModelErrorReport report = make_model_report(checks, receivers.size(), options.seed);
    report.left_out = std::move(left_out);
    if (const auto mirrors = find_mirrors(asset, receivers); !mirrors.empty()) {
        auto mirrored = check_mirrors(scenes->whole, asset, mirrors, *lights, options, context);
        if (!mirrored) return std::move(mirrored).error();
        report.mirrored = *mirrored;
    }
    auto suns = check_suns(*scenes, asset, receivers, options, context);
    if (!suns) return std::move(suns).error();
    report.suns = *suns;
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

formats::Result<ModelScenes> make_model_scenes(const formats::Scene& scene, unsigned threads) {
    const OrientedBodies bodies = orient_bodies(scene);
    auto facing = std::make_unique<formats::Scene>(bodies.scene ? *bodies.scene : scene);
    auto whole = make_reference_scene(*facing, threads);
    if (!whole) return std::move(whole).error();
    if (scene.volumes.empty()) {
        return ModelScenes{std::move(facing), nullptr, std::move(*whole), std::nullopt};
    }
    auto absorbing = std::make_unique<formats::Scene>(*facing);
    for (formats::Volume& volume : absorbing->volumes) {
        absorb_all(volume);
    }
    auto held = make_reference_scene(*absorbing, threads);
    if (!held) return std::move(held).error();
    return ModelScenes{std::move(facing), std::move(absorbing), std::move(*whole),
                       std::move(*held)};
}

std::vector<ReferenceReceiver> choose_model_receivers(const ReferenceScene& scene,
                                                      std::uint32_t wanted, std::uint64_t seed) {
    std::vector<ReferenceReceiver> receivers = choose_receivers(scene, wanted, seed, std::nullopt);
    const formats::Scene& input = scene.surfaces.scene();
    const std::vector<std::vector<bool>> creased = find_creases(input);
    std::erase_if(receivers, [&](const ReferenceReceiver& r) {
        return r.normal == glm::vec3(0) || is_buried(scene, r) || is_pierced(scene, r) ||
               is_folded(scene, r) || is_on_edge(r) ||
               (r.medium != formats::kNone && creased[r.primitive][r.vertex]);
    });
    bool turn = false;
    for (ReferenceReceiver& r : receivers) {
        if (input.materials[input.primitives[r.primitive].material].sheet) {
            r.to_eye = turn ? -r.normal : r.normal;
            turn = !turn;
        }
    }
    return receivers;
}

}  // namespace opaline::bake
