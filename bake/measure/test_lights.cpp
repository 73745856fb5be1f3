#include "bake/measure/test_lights.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bake/environment/builtin_environment.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"
#include "runtime/integrate_map.h"
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

std::vector<float> integrate_smooth(const formats::Environment& environment, unsigned threads) {
    const std::size_t texels = formats::cubemap_texels(kTruthCubemap);
    std::vector<double> integral(3 * texels);
    runtime::integrate_map(environment, kTruthCubemap, {}, threads, integral);
    std::vector<float> smooth(texels);
    for (std::size_t j = 0; j < texels; ++j) {
        smooth[j] = formats::luminance({static_cast<float>(integral[3 * j]),
                                        static_cast<float>(integral[3 * j + 1]),
                                        static_cast<float>(integral[3 * j + 2])});
    }
    return smooth;
}

std::vector<TestDisc> exact_discs(const formats::Environment& environment) {
    std::vector<TestDisc> discs;
    for (const formats::DistantDisc& d : environment.discs) {
        discs.push_back({{d.direction.x, d.direction.y, d.direction.z},
                         d.angular_radius,
                         static_cast<double>(formats::luminance(d.radiance)) *
                             formats::disc_solid_angle(d.angular_radius)});
    }
    return discs;
}

}  // namespace

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
        const std::uint32_t finest = std::max(cubemap_size, kTruthCubemap);
        if (!environment->pixel.empty()) {
            std::vector<formats::DistantDisc> discs = std::move(environment->discs);
            environment = runtime::reduce_lat_long(*environment, 8 * finest, 4 * finest, threads);
            environment->discs = std::move(discs);
        }
        lights.push_back(
            {name,
             luminances(runtime::project_environment(*environment, cubemap_size, {}, threads)),
             exact_discs(*environment), integrate_smooth(*environment, threads)});
    }
    return lights;
}

}  // namespace opaline::bake
