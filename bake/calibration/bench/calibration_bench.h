#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/plan/rates.h"
#include "bake/receivers/receiver.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/transport/body.h"
#include "bake/transport/ray_scene.h"
#include "bake/truth/test_lights.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Parameters that all measurements of a calibration share.
inline constexpr std::uint32_t kCalibrationCubemap = 32, kCalibrationKept = 128;

/// One thread, so that its CPU time is the time of the work.
inline Context one_thread() {
    Context context;
    context.threads = 1;
    return context;
}

/// Up to `wanted` of a list, evenly spaced.
template <class T>
std::vector<T> thinned(std::span<const T> all, std::size_t wanted) {
    std::vector<T> some;
    const std::size_t step = std::max<std::size_t>(1, all.size() / wanted);
    for (std::size_t i = 0; i < all.size() && some.size() < wanted; i += step) {
        some.push_back(all[i]);
    }
    return some;
}

/// The ball at one of two sizes, with the time to build it. What does not depend on the size is
/// measured on the large one.
struct CalibrationBench {
    bool is_many;                       ///< CostBySize::kMany triangles, else kFew
    std::span<const TestLight> lights;  ///< on a cube map of size kCalibrationCubemap
    formats::Scene scene;
    double triangles;
    double build;  ///< [s]
    RayScene rays;
    std::vector<Receiver> receivers;
    std::vector<BodyPoint> points;
    double place_receivers;  ///< [s]

    /// `test_lights` must outlive it.
    CalibrationBench(bool has_many, std::span<const TestLight> test_lights);

    /// The side of `cost` that is measured on this ball.
    double& side_of(CostBySize& cost) const { return is_many ? cost.many : cost.few; }
    /// The points in the order of the stages, where neighbours read the same cache lines.
    std::vector<BodyPoint> neighbours_together() const;

  private:
    RayScene make_rays();
};

}  // namespace opaline::bake
