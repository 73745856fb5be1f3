#include "runtime/picture/samples.h"

#include <algorithm>

namespace opaline::runtime {

std::uint32_t rows_of_band(const SampleGrid& grid, std::uint32_t supersampling) {
    constexpr std::uint32_t kMostPixels = 16, kMostSamples = 1u << 20;
    return std::clamp(kMostSamples / (grid.columns * supersampling), 1u, kMostPixels) *
           supersampling;
}

void resolve_samples(const Samples& samples, std::uint32_t supersampling, Picture& picture) {
    const std::uint32_t s = supersampling;
    const Band& band = samples.band;
    const float share = 1.0f / static_cast<float>(s * s);
    for (std::uint32_t y = 0; y < band.rows / s; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            formats::Rgb sum;
            for (std::uint32_t j = 0; j < s; ++j) {
                for (std::uint32_t i = 0; i < s; ++i) {
                    const std::size_t row = std::size_t{y} * s + j;
                    sum = sum + samples.color[row * band.columns + x * s + i];
                }
            }
            picture.pixel[(std::size_t{band.first_row / s} + y) * picture.width + x] = share * sum;
        }
    }
}

}  // namespace opaline::runtime
