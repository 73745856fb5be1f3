#include "bake/measure/test_lights.h"

#include <array>
#include <utility>

#include "bake/environment/builtin_environment.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"
#include "runtime/reduce_map.h"

namespace opaline::bake {
namespace {

constexpr std::array<const char*, 6> kPublishedLights{"white",      "sun:30,60", "sun:150,35",
                                                      "sun:270,15", "studio",    "sky:3,35"};

std::vector<float> luminances(const runtime::LightVector& light) {
    std::vector<float> values(light.rgba.size() / 4);
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] =
            formats::luminance({light.rgba[4 * k], light.rgba[4 * k + 1], light.rgba[4 * k + 2]});
    }
    return values;
}

// The same light on n x n texels from its 2n x 2n coefficients: a coarse texel's integral is the
// sum of four, which is twice the low-pass of one Haar level, so the coarse coefficients are twice
// the top-left quarter.
std::vector<float> coarsen(const std::vector<float>& fine, std::uint32_t n) {
    std::vector<float> coarse;
    coarse.reserve(fine.size() / 4);
    for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::size_t row = 0; row < n; ++row) {
            for (std::size_t column = 0; column < n; ++column) {
                coarse.push_back(2.0f * fine[(face * 2 * n + row) * 2 * n + column]);
            }
        }
    }
    return coarse;
}

}  // namespace

std::span<const char* const> published_lights() {
    return kPublishedLights;
}

double relit(std::span<const float> row, std::span<const float> light) {
    double sum = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
        sum += static_cast<double>(row[k]) * static_cast<double>(light[k]);
    }
    return sum;
}

formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads) {
    std::vector<TestLight> lights;
    for (const char* name : kPublishedLights) {
        formats::Result<formats::Environment> environment = make_environment(name);
        if (!environment) {
            return std::move(environment).error();
        }
        // Two to three pixels a texel are plenty for these smooth maps, and quick to project.
        const std::uint32_t fine_size = 2 * cubemap_size;
        if (!environment->pixel.empty()) {
            std::vector<formats::DistantDisc> discs = std::move(environment->discs);
            environment =
                runtime::reduce_lat_long(*environment, 8 * fine_size, 4 * fine_size, threads);
            environment->discs = std::move(discs);
        }
        std::vector<float> fine =
            luminances(runtime::project_environment(*environment, fine_size, {}, threads));
        lights.push_back({name, coarsen(fine, cubemap_size), std::move(fine)});
    }
    return lights;
}

}  // namespace opaline::bake
