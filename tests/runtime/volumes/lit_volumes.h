#pragma once

#include <vector>

#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::test {

/// Volumes under a light, by default an even one, ready for rays.
struct LitTestVolumes {
    formats::Volumes volumes = make_volumes(kSize);
    formats::VolumesView view;
    runtime::VolumeLight light;
    runtime::LitVolumes lit;

    explicit LitTestVolumes(const std::vector<TestVolume>& parts,
                            const runtime::LightVector& vector = white_light(kSize),
                            const runtime::RelightVolumesOptions& options = {}) {
        for (const TestVolume& part : parts) {
            add_volume(volumes, part);
        }
        view = volumes.view();
        light = relight_volumes(view, vector, options);
        lit = light_volumes(view, light);
    }
    LitTestVolumes(const LitTestVolumes&) = delete;  // members refer to each other
    LitTestVolumes& operator=(const LitTestVolumes&) = delete;
};

}  // namespace opaline::test
