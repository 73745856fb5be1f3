#include "bake/volumes/node_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/volumes/light_cells.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// The smallest coefficient to keep, so that the squares of all smaller ones add up to `lost` at
// most; infinite if none need be kept.
float find_threshold(std::span<const float> coefficients, double lost) {
    std::vector<float> size;
    for (const float c : coefficients) {
        if (c != 0) {
            size.push_back(std::abs(c));
        }
    }
    std::ranges::sort(size);
    double sum = 0;
    for (const float s : size) {
        sum += static_cast<double>(s) * static_cast<double>(s);
        if (!(sum <= lost)) {
            return s;
        }
    }
    return std::numeric_limits<float>::infinity();
}

}  // namespace

double row_energy(std::span<const float> values, std::uint32_t m, std::uint32_t n) {
    double sum = 0;
    for (const float v : values) {
        sum += static_cast<double>(v) * static_cast<double>(v);
    }
    const double block = static_cast<double>(n) / m;
    return sum * block * block;
}

formats::SparseRow encode_node_row(const NodeEncoder& encoder, std::span<const float> values,
                                   std::uint32_t m, std::uint32_t bands, double energy) {
    const std::uint32_t n = encoder.selector.cubemap_size;
    const std::size_t cells = formats::cubemap_texels(m), size = formats::cubemap_texels(n);
    std::vector<float> coefficients;
    coefficients.reserve(bands * size);
    for (std::uint32_t band = 0; band < bands; ++band) {
        const auto own = values.subspan(band * cells, cells);
        const std::vector<float> plane =
            transform_cells(std::vector<float>(own.begin(), own.end()), m, n);
        coefficients.insert(coefficients.end(), plane.begin(), plane.end());
    }
    // Bands share their indices: a coefficient goes if it is small in all of them.
    std::vector<float> largest(size, 0.0f);
    for (std::size_t k = 0; k < size; ++k) {
        for (std::uint32_t band = 0; band < bands; ++band) {
            largest[k] = std::max(largest[k], std::abs(coefficients[band * size + k]));
        }
    }
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        largest[std::size_t{face} * n * n] = 0;  // averages stay, whatever they are
    }
    const float least = find_threshold(largest, encoder.tolerance * encoder.tolerance * energy);
    for (std::size_t k = 0; k < size; ++k) {
        const bool is_average = k % (std::size_t{n} * n) == 0;
        for (std::uint32_t band = 0; !is_average && largest[k] < least && band < bands; ++band) {
            coefficients[band * size + k] = 0;
        }
    }
    return select_coefficients(encoder.selector, coefficients, bands);
}

}  // namespace opaline::bake
