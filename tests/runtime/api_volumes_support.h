#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/runtime/api_test_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"

// Volumes behind the C interface.
namespace opaline::test {

inline constexpr std::uint32_t kSmokySize = 8;

// A ball of smoke about (x + 0.8, 0.8, 0.8).
inline TestVolume make_smoke(float x) {
    TestVolume volume;
    volume.extent = {2, 2, 2};
    volume.to_world = {0.1f, 0, 0, x, 0, 0.1f, 0, 0, 0, 0, 0.1f, 0};
    volume.spacing = 4;
    volume.single_terms = 4;
    volume.multiple_terms = 1;
    volume.moment = {1, 0.4f, 0, 0, 0};
    volume.sigma_t = {1, 2, 4};
    volume.albedo = {0.9f, 0.8f, 0.7f};
    volume.density = [](float i, float j, float k) {
        const float r2 = (i - 8) * (i - 8) + (j - 8) * (j - 8) + (k - 8) * (k - 8);
        return std::max(0.0f, 1 - r2 / 40);
    };
    volume.rows = [](formats::NodeVoxel node) {
        return std::vector<formats::SparseRow>{
            constant_row(kSmokySize, 0.05f * static_cast<float>(node[1])),
            constant_row(kSmokySize, 0.01f * static_cast<float>(node[0]))};
    };
    return volume;
}

// Volumes and no receivers; none of other cube maps than kSmokySize.
inline formats::Asset make_smoky_asset(std::uint32_t n) {
    formats::Asset asset;
    asset.provenance = "{}";
    asset.transport = formats::make_sparse_rows(n, 8);
    if (n == kSmokySize) {
        asset.volumes = make_volumes(n);
        add_volume(asset.volumes, make_smoke(0));
        add_volume(asset.volumes, make_smoke(0.7f));
    }
    return asset;
}

// An asset that the library has loaded, a light and the volumes in it.
struct VolumeHandles : tests::LoadedAsset {
    explicit VolumeHandles(const formats::Asset& source)
        : LoadedAsset(source), volume_light(create_volume_light(asset).handle) {
        EXPECT_TRUE(volume_light) << opaline_last_error();
    }
    VolumeLightHandle volume_light;
};

}  // namespace opaline::test
