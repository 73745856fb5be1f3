#include "bake/calibration/bench/calibration_bench.h"

#include <utility>

#include "bake/calibration/bench/dented_ball.h"
#include "bake/calibration/bench/stopwatch.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/spatial_order.h"
#include "bake/transport/hidden_receivers.h"
#include "bake/transport/touching_triangles.h"

namespace opaline::bake {
namespace {

// Cells along a side of the dented ball, of few triangles and of many.
constexpr std::uint32_t kFewSide = 16, kManySide = 64;
static_assert(12 * kFewSide * kFewSide == CostBySize::kFew);
static_assert(12 * kManySide * kManySide == CostBySize::kMany);

}  // namespace

CalibrationBench::CalibrationBench(bool has_many, std::span<const TestLight> test_lights)
    : is_many(has_many),
      lights(test_lights),
      scene(make_dented_ball(has_many ? kManySide : kFewSide)),
      triangles(static_cast<double>(scene.primitives[0].index.size()) / 3),
      build(0),
      rays(make_rays()) {
    const Stopwatch watch;
    std::vector<Receiver> all = leave_touching_triangles(
        rays.hierarchy(), scene, make_vertex_receivers(scene), one_thread());
    points = make_body_points(scene, all);
    receivers = replace_hidden_receivers(rays, scene, std::move(all), one_thread());
    place_receivers = watch.seconds();
}

RayScene CalibrationBench::make_rays() {
    const Stopwatch watch;
    auto built = RayScene::build(scene, 1);
    build = watch.seconds();
    return std::move(built).value();
}

std::vector<BodyPoint> CalibrationBench::neighbours_together() const {
    std::vector<glm::vec3> positions;
    for (const BodyPoint& point : points) {
        positions.push_back(point.position);
    }
    std::vector<BodyPoint> ordered;
    for (const std::uint32_t index : spatial_order(positions)) {
        ordered.push_back(points[index]);
    }
    return ordered;
}

}  // namespace opaline::bake
