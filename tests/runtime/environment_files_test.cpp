#include <gmock/gmock.h>

#include <filesystem>

#include "formats/image/load_environment.h"
#include "runtime/integrate_map.h"
#include "runtime/light_vector.h"
#include "tests/runtime/light_test_support.h"
#include "tests/support/assets.h"

namespace opaline::runtime {
namespace {

namespace fs = std::filesystem;

/// The mean radiance of each texel of an m x m cube map.
formats::Environment as_cube(const formats::Environment& map, std::uint32_t m) {
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(m));
    integrate_map(map, m, {}, 0, integral);
    const std::vector<double> solid_angle = formats::texel_solid_angles(m);
    formats::Environment cube;
    cube.layout = formats::Environment::Layout::cube;
    cube.width = m;
    cube.height = 6 * m;
    for (std::size_t j = 0; j < integral.size() / 3; ++j) {
        const double w = solid_angle[j % (m * m)];
        cube.pixel.push_back({static_cast<float>(integral[3 * j] / w),
                              static_cast<float>(integral[3 * j + 1] / w),
                              static_cast<float>(integral[3 * j + 2] / w)});
    }
    return cube;
}

// Photographs with lamps and suns in them: the map as it is, and the same map as a finer cube, must
// light alike.
TEST(EnvironmentFiles, LatLongMapAndTheSameMapAsACubeAgree) {
    OPALINE_ASSET(folder, "env");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const auto loaded = formats::load_environment(entry.path());
        ASSERT_TRUE(loaded) << entry.path();
        const formats::Environment& map = loaded->environment;
        const LightVector direct = project_environment(map, 32);
        const LightVector by_cube = project_environment(as_cube(map, 64), 32);
        EXPECT_LT(tests::relative_difference(direct, by_cube), 1e-3) << entry.path();
        // Flux against the sum over pixels with exact band areas.
        if (map.layout == formats::Environment::Layout::lat_long && !map.rows_include_poles) {
            double expected = 0;
            for (std::uint32_t row = 0; row < map.height; ++row) {
                const double step = std::numbers::pi / map.height;
                const double band = std::cos(step * row) - std::cos(step * (row + 1));
                for (std::uint32_t column = 0; column < map.width; ++column) {
                    expected += band * map.pixel[std::size_t{row} * map.width + column].g;
                }
            }
            expected *= 2 * std::numbers::pi / map.width;
            EXPECT_NEAR(tests::flux(direct, 1) / expected, 1.0, 5e-4) << entry.path();
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
