#include "bake/encode/select_coefficients.h"

#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "bake/base/largest.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {

using formats::kCubeFaces;

namespace {

// 0 * NaN and 0 * infinity are NaN and make the sum NaN: one test for all values.
bool all_finite(std::span<const float> values) {
    float nothing = 0;
    for (const float value : values) {
        nothing += 0 * value;
    }
    return nothing == 0;
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
    if (!all_finite(coefficients)) {
        constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
        return {bands, {}, {}, std::vector<float>(std::size_t{bands} * kCubeFaces, kNotANumber)};
    }
    std::vector<float> score(size);
    for (std::size_t k = 0; k < size; ++k) {
        float squares = 0;
        for (std::uint32_t band = 0; band < bands; ++band) {
            const float value =
                (bands == 1 ? 1.0f : kLuminance[band]) * coefficients[band * size + k];
            squares += value * value;
        }
        // The square of the score has the same order and needs no square root.
        score[k] = selector.weight[k] * selector.weight[k] * squares;
    }
    formats::SparseRow row;
    row.bands = bands;
    row.index = find_largest(score, selector.kept > kCubeFaces ? selector.kept - kCubeFaces : 0);
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
