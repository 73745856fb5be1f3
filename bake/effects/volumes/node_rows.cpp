#include "bake/effects/volumes/node_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bake/base/largest.h"
#include "bake/trace/density/attenuation.h"
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
        if (!(sum <= lost)) return s;
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

std::vector<formats::SparseRow> encode_node_rows(const NodeEncoder& encoder,
                                                 std::span<const float> values, std::uint32_t count,
                                                 std::uint32_t m, std::uint32_t bands) {
    Selector selector = encoder.selector;
    const std::uint32_t n = selector.cubemap_size;
    const std::size_t cells = formats::cubemap_texels(m), size = formats::cubemap_texels(n);
    const auto is_average = [&](std::size_t k) { return k % (std::size_t{n} * n) == 0; };
    std::vector<float> coefficients;
    coefficients.reserve(count * bands * size);
    for (std::size_t plane = 0; plane < std::size_t{count} * bands; ++plane) {
        const auto own = values.subspan(plane * cells, cells);
        const std::vector<float> transformed =
            transform_cells(std::vector<float>(own.begin(), own.end()), m, n);
        coefficients.insert(coefficients.end(), transformed.begin(), transformed.end());
    }
    // Bands share their indices: a coefficient goes if it is small in all of them.
    std::vector<float> largest(count * size, 0.0f), score(count * size, 0.0f);
    for (std::size_t row = 0; row < count; ++row) {
        for (std::size_t k = 0; k < size; ++k) {
            float& most = largest[row * size + k];
            for (std::size_t band = 0; !is_average(k) && band < bands; ++band) {
                most = std::max(most, std::abs(coefficients[(row * bands + band) * size + k]));
            }
        }
    }
    const double energy = row_energy(values, m, n) / bands;
    const float least = find_threshold(largest, encoder.tolerance * encoder.tolerance * energy);
    for (std::size_t i = 0; i < score.size(); ++i) {
        score[i] = largest[i] < least ? 0.0f : selector.weight[i % size] * largest[i];
    }
    const std::uint32_t averages = formats::kCubeFaces * count;
    std::vector<char> stays(count * size, 0);
    for (const std::uint32_t i :
         find_largest(score, selector.kept > averages ? selector.kept - averages : 0)) {
        stays[i] = 1;
    }
    selector.kept = static_cast<std::uint32_t>(size);  // what is left is kept
    std::vector<formats::SparseRow> rows;
    for (std::size_t row = 0; row < count; ++row) {
        const auto own = std::span(coefficients).subspan(row * bands * size, bands * size);
        for (std::size_t i = 0; i < own.size(); ++i) {
            const std::size_t k = i % size;
            if (!is_average(k) && stays[row * size + k] == 0) {
                own[i] = 0;
            }
        }
        rows.push_back(select_coefficients(selector, own, bands));
    }
    return rows;
}

}  // namespace opaline::bake
