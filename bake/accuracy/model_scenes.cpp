#include "bake/accuracy/model_scenes.h"

#include <utility>

#include "bake/scene/orient_bodies.h"
#include "bake/volumes/scale_medium.h"
#include "bake/volumes/scaled_phase.h"

namespace opaline::bake {
namespace {

void absorb_all(formats::Volume& volume) {
    const ScaledMedium scaled = scale_medium(volume, scale_phase(volume.phase).peak);
    if (scaled.grids != nullptr) volume.density.value = scaled.grids->density.value;
    volume.sigma_t = {scaled.sigma_t[0], scaled.sigma_t[1], scaled.sigma_t[2]};
    volume.albedo = {0, 0, 0};
    volume.scattering = {};
}

}  // namespace

formats::Result<ModelScenes> make_model_scenes(const formats::Scene& scene, unsigned threads) {
    const OrientedBodies bodies = orient_bodies(scene);
    auto facing = std::make_unique<formats::Scene>(bodies.scene ? *bodies.scene : scene);
    auto whole = make_reference_scene(*facing, threads);
    if (!whole) {
        return std::move(whole).error();
    }
    if (scene.volumes.empty()) {
        return ModelScenes{std::move(facing), nullptr, std::move(*whole), std::nullopt};
    }
    auto absorbing = std::make_unique<formats::Scene>(*facing);
    for (formats::Volume& volume : absorbing->volumes) {
        absorb_all(volume);
    }
    auto held = make_reference_scene(*absorbing, threads);
    if (!held) {
        return std::move(held).error();
    }
    return ModelScenes{std::move(facing), std::move(absorbing), std::move(*whole),
                       std::move(*held)};
}

}  // namespace opaline::bake
