#include "bake/calibration/traced_collision.h"

#include <algorithm>

#include "bake/accuracy/volumes/volume_truth.h"
#include "bake/calibration/bench/stopwatch.h"
#include "bake/volumes/calibrate_volumes.h"

namespace opaline::bake {

double measure_traced_collision() {
    constexpr std::uint32_t kProbes = 8;
    constexpr std::uint64_t kEvents = 40000;
    const formats::Scene scene = make_calibration_volume();
    const auto reference = make_reference_scene(scene, 1);
    if (!reference) {
        return 0;
    }
    const std::vector<VolumeProbe> probes = choose_volume_probes(*reference, kProbes, 0);
    const Stopwatch watch;
    const auto truth = trace_volume_truth(
        *reference, probes, 0, kEvents, [](const VolumeTruth&) { return false; }, one_thread());
    return truth ? watch.seconds() / static_cast<double>(std::max<std::uint64_t>(truth->events, 1))
                 : 0;
}

}  // namespace opaline::bake
