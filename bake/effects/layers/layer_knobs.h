#pragma once

#include <algorithm>
#include <span>

#include "bake/physics/slab/radiance_table.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"
#include "bake/plan/knobs.h"

namespace opaline::bake {

namespace layer_knobs {
inline bool is_cloudy(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, Subject::Kind::layer);
}
// What the presets err by: tests/bench/RESULTS.md, "Cloud layers".
inline double step_for(double error) {
    return error >= 0.06 ? 0.3 : error >= 0.02 ? 0.1 : error >= 0.008 ? 0.03 : 0.02;
}
inline double nodes_for(double error) {
    return error >= 0.06 ? 12 : error >= 0.02 ? 18 : error >= 0.008 ? 24 : 32;
}
}  // namespace layer_knobs

/// How finely the radii of droplets are sampled.
inline constexpr KnobSpec kCloudStep{
    .name = "cloud_step",
    .option = "--cloud-step",
    .placeholder = "X",
    .help =
        "step of the size parameter, 2 pi radius / wavelength, between the droplets of a cloud "
        "layer of which phase functions are means; default as the quality says",
    .lowest = 0.01,
    .highest = 2,
    .whole = false,
    .preset = {0.3, 0.1, 0.03, 0.02},
    .for_target = layer_knobs::step_for,
    .label = "droplet step %g",
    .ladder = {1.0, 0.3, 0.1, 0.05, 0.03, 0.02},
    .diagonal = {0.3, 0.2, 0.1, 0.05, 0.03},
    .truths = {0.01, 0.02},
    .theory = {.label = "step between droplets",
               .words = "resonances of spheres, narrower than the step, are met by chance",
               .rate = 0.5,
               .fine_is_small = true},
    .matters = layer_knobs::is_cloudy};

/// Size of the tables of a layer.
inline constexpr KnobSpec kCloudNodes{
    .name = "cloud_nodes",
    .option = "--cloud-nodes",
    .placeholder = "N",
    .help =
        "cosines of light and of view that a cloud layer's table of radiance has; numbers of "
        "its depths and azimuth modes, and of streams, follow; default as the quality says",
    .lowest = 8,
    .highest = 48,
    .preset = {12, 18, 24, 32},
    .for_target = layer_knobs::nodes_for,
    .label = "table of %g cosines",
    .ladder = {8.0, 12.0, 15.0, 18.0, 24.0, 32.0},
    .diagonal = {12.0, 15.0, 18.0, 24.0, 32.0},
    .truths = {40.0, 32.0},
    .theory = {.label = "cosines of a cloud layer's table",
               .words = "square of the distance between nodes, where radiance is smooth",
               .rate = -2},
    .matters = layer_knobs::is_cloudy};

/// Sizes of the tables of one band, and of the solver that fills them.
struct LayerTableSizes {
    unsigned phase_angles = 512;
    /// An even number of angles: the edge of the peak, a jump of the light scattered once, then
    /// lies in the middle between two of them.
    unsigned glow_angles = 96, glow_events = 48;
    SlabTableSize flux;
    RadianceTableSize radiance;
    int flux_streams = 16, radiance_streams = 24;
};

/// kCloudNodes = 24 are the sizes that the tables were measured with (tests/bench/RESULTS.md).
inline LayerTableSizes layer_table_sizes(const Knobs& knobs) {
    const auto nodes = whole(knobs, kCloudNodes);
    LayerTableSizes sizes;
    sizes.flux = {nodes * 8 / 3, nodes * 4 / 3, false};
    sizes.radiance = {nodes * 4 / 3, nodes, std::max(4u, nodes / 3)};
    sizes.flux_streams = static_cast<int>(std::max(12u, nodes * 2 / 3));
    sizes.radiance_streams = static_cast<int>(std::max(16u, nodes));
    return sizes;
}

}  // namespace opaline::bake
