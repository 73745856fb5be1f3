#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formats/opal/volumes.h"
#include "runtime/light_vector.h"

namespace opaline::test {

/// How a volume is made for a test.
struct TestVolume {
    std::array<std::int32_t, 3> first_brick{};
    std::array<std::uint32_t, 3> extent{1, 1, 1};
    std::array<float, 12> to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    formats::Rgb sigma_t{1, 1, 1}, albedo{1, 1, 1};
    std::uint32_t spacing = 8;
    std::uint32_t single_terms = 0, multiple_terms = 0, bands = 1;
    std::array<float, formats::kMaxVolumeMoments> moment{1, 0, 0, 0, 0};
    /// p' [1/sr] of the cosine, scaled to an integral of 1; without it the sum of the moments that
    /// `single_terms` has, not below 0.
    std::function<double(double)> phase;
    /// Density at index coordinates; bricks where it is 0 at every voxel are left out.
    std::function<float(float, float, float)> density = [](float, float, float) { return 1.0f; };
    /// Rows of the node in a voxel, terms() of them; without it V = 1 and T_k = 0.
    std::function<std::vector<formats::SparseRow>(formats::NodeVoxel)> rows;
};

inline constexpr std::uint32_t kSize = 8;  ///< texels along an edge of a face in these tests

/// What a bake makes of Henyey-Greenstein's phase function.
void scatter_forward(TestVolume& volume, double g);

/// Denser toward the middle of 4 x 4 x 4 bricks, which scatter alike in all directions, once.
TestVolume smoke_ball();

/// No volumes yet, light on a cube map of n x n texels, 16-bit codes.
formats::Volumes make_volumes(std::uint32_t n);

void add_volume(formats::Volumes& volumes, const TestVolume& volume);

/// A row that is the same value in each direction and band.
formats::SparseRow constant_row(std::uint32_t n, float value, std::uint32_t bands = 1);

/// Radiance 1 from everywhere.
runtime::LightVector white_light(std::uint32_t n);

/// One texel of radiance `radiance`, black elsewhere.
runtime::LightVector texel_light(std::uint32_t n, std::uint32_t texel, formats::Rgb radiance);

}  // namespace opaline::test
