#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "bake/reference/events.h"
#include "bake/reference/glossy_brdf.h"
#include "bake/reference/lamp_sampler.h"
#include "bake/reference/light_line.h"

namespace opaline::bake {

/// Light that is sampled at events of a path; private to the walk.

/// A side of an event, from which straight lines to light start.
struct LightSide {
    RayOrigin from;
    SurroundingMedia stack;  ///< bodies there
    PathState state;         ///< of a path that goes on there
};

/// An event's response toward a direction, and the side that the direction is on; without a side
/// the density is 0.
struct SidedLobe {
    LobeValue lobe;
    const LightSide* side = nullptr;
};

/// Light that arrives straight from the sky at an event, sampled from the light. `eval(d)`: the
/// event's response for unit throughput, and the density of its own sampling over solid angle.
template <class Eval>
void gather_sky(const PathSpace& space, Path& path, RandomStream& random, Eval&& eval) {
    const glm::vec3 d = sample_light(space.light, random);
    if (d == glm::vec3(0)) return;
    const SidedLobe sided = eval(d);
    if (!(sided.lobe.pdf > 0)) return;
    const LightSide& side = *sided.side;
    const glm::vec3 passing =
        see_sky(space, side.from, d, side.stack, side.state, path.key, random);
    if (passing != glm::vec3(0)) {
        path.radiance += path.beta * passing * eval_light(space.light, d) *
                         (sided.lobe.response / (pdf_light(space.light, d) + sided.lobe.pdf));
    }
}

/// The same of a glowing surface and of a light without a surface, seen from `at`.
template <class Eval>
void gather_lamps(const PathSpace& space, Path& path, glm::vec3 at, RandomStream& random,
                  Eval&& eval) {
    constexpr float kNoLimit = std::numeric_limits<float>::infinity();
    const LampSampler& lamps = space.scene.lamps;
    const auto pass = [&](const LightSide& side, LightLine line) {
        line.from = side.from;
        SurroundingMedia stack = side.stack;
        const glm::vec3 passing = pass_line(space, line, stack, side.state, random);
        return path.beta * passing * per_squared_index(space.scene, stack);
    };
    if (!lamps.triangles.empty()) {
        const auto seen = sample_triangle(lamps, space.scene.surfaces.scene(), at, random);
        const SidedLobe sided = seen ? eval(seen->direction) : SidedLobe{};
        if (sided.lobe.pdf > 0) {
            path.radiance +=
                pass(*sided.side,
                     {{}, seen->direction, kNoLimit, seen->primitive, seen->triangle, path.key}) *
                seen->radiance * (sided.lobe.response / (seen->pdf + sided.lobe.pdf));
        }
    }
    if (!lamps.lights.empty()) {
        const auto arriving = sample_punctual(lamps, at, random);
        const SidedLobe sided = arriving ? eval(arriving->to_light) : SidedLobe{};
        if (sided.lobe.pdf > 0) {
            const formats::Rgb e = arriving->irradiance;
            path.radiance += pass(*sided.side, {{},
                                                arriving->to_light,
                                                arriving->distance,
                                                formats::kNone,
                                                formats::kNone,
                                                path.key}) *
                             glm::vec3(e.r, e.g, e.b) * sided.lobe.response;
        }
    }
}

/// All light that arrives straight at an event at `at`.
template <class Eval>
void gather_from_sides(const PathSpace& space, Path& path, glm::vec3 at, bool sees_sky,
                       RandomStream& random, Eval&& eval) {
    path.vertex = at;
    if (sees_sky) {
        gather_sky(space, path, random, eval);
    }
    if (counts_lamps(space, path.state)) {
        gather_lamps(space, path, at, random, eval);
    }
}

/// The same where only one side is lit. `eval(d)`: a LobeValue.
template <class Eval>
void gather_light(const PathSpace& space, Path& path, const RayOrigin& from, bool sees_sky,
                  RandomStream& random, Eval&& eval) {
    const LightSide side{from, path.stack, path.state};
    gather_from_sides(space, path, from.position, sees_sky, random, [&](glm::vec3 d) {
        return SidedLobe{eval(d), &side};
    });
}

}  // namespace opaline::bake
