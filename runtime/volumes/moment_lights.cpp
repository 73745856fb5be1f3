#include "runtime/volumes/moment_lights.h"

#include <cstddef>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

// harmonic[count j + k] = Y_k of texel j's centre.
std::vector<float> texel_harmonics(std::uint32_t n, std::uint32_t count) {
    const std::uint32_t texels = formats::cubemap_texels(n);
    std::vector<float> harmonic(std::size_t{texels} * count);
    for (std::uint32_t j = 0; j < texels; ++j) {
        const formats::Vec3 w = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        formats::eval_spherical_harmonics(
            w, std::span<float>(harmonic).subspan(std::size_t{j} * count, count));
    }
    return harmonic;
}

}  // namespace

std::vector<LightVector> make_moment_lights(std::span<const double> integral, std::uint32_t n,
                                            std::uint32_t count, unsigned threads) {
    std::vector<LightVector> moments(count);
    if (count == 0) return moments;
    const std::vector<float> harmonic = texel_harmonics(n, count);
    for_ranges(count, 1, threads, [&](std::uint32_t first, std::uint32_t end) {
        std::vector<double> product(integral.size());
        for (std::uint32_t k = first; k < end; ++k) {
            for (std::size_t i = 0; i < product.size(); ++i) {
                product[i] = integral[i] * static_cast<double>(harmonic[i / 3 * count + k]);
            }
            moments[k] = make_light_vector(product, n);
        }
    });
    return moments;
}

}  // namespace opaline::runtime
