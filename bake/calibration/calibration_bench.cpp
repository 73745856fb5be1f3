#include "bake/calibration/calibration_bench.h"

#include <utility>

#include "bake/calibration/dented_ball.h"
#include "bake/calibration/stopwatch.h"
#include "bake/receivers/body_points.h"
#include "bake/transport/hidden_receivers.h"

namespace opaline::bake {

CalibrationBench::CalibrationBench(std::uint32_t side)
    : scene(make_dented_ball(side)),
      triangles(static_cast<double>(scene.primitives[0].index.size() / 3)),
      build(0),
      rays(make_rays()) {
    const Stopwatch watch;
    std::vector<Receiver> all = make_vertex_receivers(scene);
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

}  // namespace opaline::bake
