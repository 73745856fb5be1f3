#include "bake/encode/select_coefficients.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bake/base/largest.h"
#include "bake/base/vector8.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {

using formats::kCubeFaces;

namespace {

// NaN and infinity have all bits of the exponent.
OPALINE_VECTOR_CLONES
bool all_finite(const float* value, std::size_t count) {
    constexpr std::int32_t kExponent = 0x7f800000;
    std::int32_t found = 0;
    for (std::size_t k = 0; k < count; ++k) {
        std::int32_t bits;
        __builtin_memcpy(&bits, value + k, sizeof bits);
        found |= (bits & kExponent) == kExponent ? 1 : 0;
    }
    return found == 0;
}

OPALINE_VECTOR_CLONES
void add_squares(const float* value, std::size_t count, float share, float* sum) {
    for (std::size_t k = 0; k < count; ++k) {
        sum[k] += share * value[k] * (share * value[k]);
    }
}

OPALINE_VECTOR_CLONES
void weigh_squares(const float* weight, std::size_t count, float* square) {
    for (std::size_t k = 0; k < count; ++k) {
        square[k] = weight[k] * weight[k] * square[k];
    }
}

}  // namespace

Selector make_selector(std::uint32_t cubemap_size, std::uint32_t kept, float area_prior) {
    Selector selector{cubemap_size, kept, {}};
    selector.weight.reserve(formats::cubemap_texels(cubemap_size));
    for (std::uint32_t face = 0; face < kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < cubemap_size; ++row) {
            for (std::uint32_t column = 0; column < cubemap_size; ++column) {
                const auto side =
                    static_cast<float>(formats::haar_support(cubemap_size, row, column));
                selector.weight.push_back(row + column == 0 ? 0.0f : std::pow(side, area_prior));
            }
        }
    }
    return selector;
}

formats::SparseRow select_coefficients(const Selector& selector,
                                       std::span<const float> coefficients, std::uint32_t bands) {
    constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};
    const std::size_t size = selector.weight.size();
    assert(coefficients.size() == bands * size && (bands == 1 || bands == 3));
    if (!all_finite(coefficients.data(), coefficients.size())) {
        constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
        return {bands, {}, {}, std::vector<float>(std::size_t{bands} * kCubeFaces, kNotANumber)};
    }
    // The square of the score has the same order and needs no square root.
    std::vector<float> score(size);
    for (std::uint32_t band = 0; band < bands; ++band) {
        add_squares(&coefficients[band * size], size, bands == 1 ? 1.0f : kLuminance[band],
                    score.data());
    }
    weigh_squares(selector.weight.data(), size, score.data());
    formats::SparseRow row;
    row.bands = bands;
    row.index = find_largest(score, selector.kept > kCubeFaces ? selector.kept - kCubeFaces : 0);
    row.value.reserve(bands * row.index.size());
    row.average.reserve(std::size_t{bands} * kCubeFaces);
    const std::uint32_t face_size = selector.cubemap_size * selector.cubemap_size;
    for (std::uint32_t band = 0; band < bands; ++band) {
        for (const std::uint32_t k : row.index) {
            row.value.push_back(coefficients[band * size + k]);
        }
        for (std::uint32_t face = 0; face < kCubeFaces; ++face) {
            row.average.push_back(coefficients[band * size + std::size_t{face} * face_size]);
        }
    }
    return row;
}

formats::Status require_finite(const formats::SparseRows& rows, std::uint32_t terms,
                               std::uint32_t bands, const std::string& stage) {
    assert(terms > 0 && bands > 0);
    if (const auto faulty = formats::find_faulty_row(rows, bands)) {
        return formats::make_error(formats::ErrorKind::bad_input, "", stage,
                                   "the light transport of vertex " +
                                       std::to_string(*faulty / terms) + " is not a finite number",
                                   "look for extreme numbers in its mesh and its medium");
    }
    return formats::ok_status();
}

}  // namespace opaline::bake
