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
#include "formats/scene.h"

namespace opaline::bake {

/// Parameters that all measurements of a calibration share.
inline constexpr std::uint32_t kCalibrationCubemap = 32, kCalibrationKept = 128;
/// Cells along a side of the dented ball, of few triangles and of many.
inline constexpr std::uint32_t kFewSide = 16, kManySide = 64;
static_assert(12 * kFewSide * kFewSide == CostBySize::kFew);
static_assert(12 * kManySide * kManySide == CostBySize::kMany);

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

/// The ball at one size, with the time to build it.
struct CalibrationBench {
    formats::Scene scene;
    double triangles;
    double build;  ///< [s]
    RayScene rays;
    std::vector<Receiver> receivers;
    std::vector<BodyPoint> points;
    double place_receivers;  ///< [s]

    explicit CalibrationBench(std::uint32_t side);

  private:
    RayScene make_rays();
};

}  // namespace opaline::bake
