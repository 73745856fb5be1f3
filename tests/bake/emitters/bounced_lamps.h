#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "bake/effects/emitters/lamp_rows.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/plan/knobs.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/support/effects.h"

namespace opaline::tests {

/// What surfaces of a scene send to each other, with rays and scatterers as for `bounce_rays`.
/// Media answer nothing.
inline std::shared_ptr<const bake::BounceLight> solve_surfaces(
    const Scene& scene, const bake::RayScene& rays, const std::vector<bake::ReceiverSet>& receivers,
    std::uint32_t bounce_rays = 64, const bake::ScenePyramids* textures = nullptr) {
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    const bake::RayScene sky = bake::RayScene::build({}, 1).value();
    const bake::BakeInputs known{bake::all_effects(), scene,   facts,   rays, sky,
                                 receivers,           nullptr, textures};
    std::vector<bake::RowLayout> layouts(scene.materials.size());
    for (std::size_t m = 0; m < layouts.size(); ++m) {
        layouts[m].translucent = scene.materials[m].medium.has_value();
        layouts[m].constant = true;
    }
    const bake::Knobs knobs;
    std::uint64_t traced = 0;
    const bake::LightInputs asked{known, knobs, {}, layouts, {}, bounce_rays};
    return bake::solve_exchange(asked, bake::place_exchange(asked, traced), {}, traced,
                                bake::Bounces::of_lamps);
}

/// By way of metals and media.
inline std::vector<bake::ArrivedParticles> arrived_at(const LampWorld& world,
                                                      const bake::BounceLight* surfaces) {
    if (surfaces == nullptr) return {};
    const bake::CellsOfElements cells(world.scene, surfaces->tree,
                                      surfaces->transfer.scatterers.size(), world.layout);
    std::vector<bake::ArrivedParticles> arrived(world.particles.size());
    for (std::size_t e = 0; e < arrived.size(); ++e) {
        arrived[e].caustic = cells.sum(world.particles[e].caustic);
    }
    return arrived;
}

/// A LampWorld, and the light that its surfaces send to each other.
struct BouncedLamps {
    BouncedLamps(Scene scene, double finest, const bake::ParticleRun& run,
                 std::uint32_t samples = 256)
        : world(std::move(scene), finest, run),
          lamps(world.light(samples)),
          surfaces(solve_surfaces(world.scene, world.rays, world.receivers, 64, run.textures)),
          arrived(arrived_at(world, surfaces.get())),
          light(bake::find_lamp_bounces(lamps, surfaces.get(), arrived, {}, traced)) {}

    std::vector<std::vector<formats::Rgb>> rows(std::uint32_t primitive, std::uint32_t terms = 1,
                                                unsigned threads = 1) const {
        bake::Context context;
        context.threads = threads;
        std::uint64_t rays = 0;
        return bake::make_lamp_rows(light, world.receivers[primitive], terms, context, rays);
    }

    std::uint64_t traced = 0;
    LampWorld world;
    bake::LampLight lamps;
    std::shared_ptr<const bake::BounceLight> surfaces;
    std::vector<bake::ArrivedParticles> arrived;
    bake::LampBounces light;
};

}  // namespace opaline::tests
