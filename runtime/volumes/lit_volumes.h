#pragma once

#include <cstddef>
#include <vector>

#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_glow.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// All volumes under one light, ready for rays; refers to the asset and to the light.
struct LitVolumes {
    struct Entry {
        VolumeLattice lattice;
        std::size_t volume = 0;  ///< its number in the asset
        VolumeGlow glow;         ///< its own light
    };
    std::vector<Entry> entry;
    const VolumeLight* light = nullptr;
};

/// Preconditions: `light` is of these volumes and outlives the result, as their arrays do.
LitVolumes light_volumes(const formats::VolumesView& volumes, const VolumeLight& light);

}  // namespace opaline::runtime
