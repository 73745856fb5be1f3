#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/scene/copies.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Which copies may share the rows of others.
struct ShareLimits {
    /// Relative RMS that they may err by, of the light that RefineLimits::error is of.
    double error = 0;
    std::uint64_t seed = 0;
};

/// What copies became.
struct ShareReport {
    std::uint64_t given = 0, shared = 0;  ///< repeated meshes; those that share rows
    double error = 0;  ///< RMS over those, as of ShareLimits: measured, from 256 to 2048 rays each
    std::vector<CopiedMesh> apart;  ///< those that need rows of their own: to be expanded
};

/// Finds the copies (formats::CopyOf) whose surroundings hardly differ from their original's, or
/// from those of another copy, which then becomes their original; all others are `apart`, and are
/// to be expanded. Surroundings are compared by the same rays from the same points of each: what
/// they leave of the sky, and the base colours that they meet. Copies of what sends out light, or
/// is translucent, thin-walled or veined, are apart; and so are all where there are lamps or
/// volumes, whose light is another one at every place; one that shares a vertex with another mesh,
/// whose edges refinement halves on both sides; and what would take a reader of the file more than
/// kMostBytesOfCopies. `rays`: of the scene as given. The same for any number of threads.
ShareReport share_copies(const RayScene& rays, const ShareLimits& limits, const Context& context,
                         formats::Scene& scene);

}  // namespace opaline::bake
