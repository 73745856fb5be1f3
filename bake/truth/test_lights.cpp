#include "bake/truth/test_lights.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bake/environment/builtin_environment.h"
#include "bake/truth/test_light_cache.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_vector.h"
#include "runtime/reduce_map.h"

namespace opaline::bake {
namespace {

constexpr std::array<const char*, 6> kPublishedLights{"white",      "sun:30,60", "sun:150,35",
                                                      "sun:270,15", "studio",    "sky:3,35"};

// The same integrals over the texels of n x n, by sums, or shared out by solid angle.
std::vector<double> change_size(std::span<const float> smooth, std::uint32_t n) {
    const std::vector<double> from = formats::texel_solid_angles(kTruthCubemap);
    const std::vector<double> to = formats::texel_solid_angles(n);
    const std::uint32_t size = std::max(n, kTruthCubemap);
    const std::uint32_t down = size / kTruthCubemap, up = size / n;
    std::vector<double> integral(formats::cubemap_texels(n));
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < size; ++row) {
            for (std::uint32_t column = 0; column < size; ++column) {
                const std::size_t source = row / down * kTruthCubemap + column / down;
                const std::size_t target = row / up * n + column / up;
                const double share = down > 1 ? to[target] / from[source] : 1.0;
                integral[face * to.size() + target] +=
                    share * static_cast<double>(smooth[face * from.size() + source]);
            }
        }
    }
    return integral;
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

std::vector<TestDisc> exact_discs(std::span<const formats::DistantDisc> given) {
    std::vector<TestDisc> discs;
    for (const formats::DistantDisc& d : given) {
        discs.push_back({{d.direction.x, d.direction.y, d.direction.z},
                         d.angular_radius,
                         static_cast<double>(formats::luminance(d.radiance)) *
                             formats::disc_solid_angle(d.angular_radius)});
    }
    return discs;
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

namespace {

formats::Result<std::vector<TestLight>> integrate_test_lights(unsigned threads) {
    std::vector<TestLight> lights;
    for (const char* name : kPublishedLights) {
        formats::Result<formats::Environment> environment = make_environment(name);
        if (!environment) {
            return std::move(environment).error();
        }
        // Two to three pixels per texel suffice for these smooth maps.
        std::vector<formats::DistantDisc> discs = std::move(environment->discs);
        if (!environment->pixel.empty()) {
            environment = runtime::reduce_lat_long(*environment, 4 * kTruthCubemap,
                                                   2 * kTruthCubemap, threads);
        }
        lights.push_back({name, {}, exact_discs(discs), integrate_smooth(*environment, threads)});
    }
    return lights;
}

}  // namespace

formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads,
                                                         const std::filesystem::path& cache) {
    std::vector<TestLight> lights;
    if (!cache.empty()) {
        lights = read_test_lights(cache);
    }
    if (lights.empty()) {
        auto integrated = integrate_test_lights(threads);
        if (!integrated) {
            return integrated;
        }
        lights = std::move(*integrated);
        if (!cache.empty()) {
            write_test_lights(cache, lights);
        }
    }
    project_test_lights(lights, cubemap_size);
    return lights;
}

void project_test_lights(std::span<TestLight> lights, std::uint32_t cubemap_size) {
    for (TestLight& light : lights) {
        const std::vector<double> smooth = change_size(light.smooth, cubemap_size);
        std::vector<double> integral(3 * smooth.size());
        for (std::size_t j = 0; j < smooth.size(); ++j) {
            integral[3 * j] = smooth[j];
        }
        std::vector<formats::DistantDisc> discs;
        for (const TestDisc& d : light.discs) {
            const auto radiance =
                static_cast<float>(d.flux / formats::disc_solid_angle(d.angular_radius));
            discs.push_back({{d.direction.x, d.direction.y, d.direction.z},
                             d.angular_radius,
                             {radiance, radiance, radiance}});
        }
        runtime::integrate_discs(discs, cubemap_size, {}, integral);
        const runtime::LightVector projected = runtime::make_light_vector(integral, cubemap_size);
        light.coarse.resize(smooth.size());
        for (std::size_t k = 0; k < smooth.size(); ++k) {
            light.coarse[k] = projected.rgba[4 * k];
        }
    }
}

}  // namespace opaline::bake
