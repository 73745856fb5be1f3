#include "formats/opal/sparse_rows.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>

#include "formats/opal/cubemap.h"
#include "formats/opal/detail_codes.h"

namespace opaline::formats {
namespace {

// NaN where any of them is not finite. Magnitudes order as their bits do, which need no branch.
float largest_magnitude(std::span<const float> values) {
    constexpr std::int32_t kMagnitude = 0x7fffffff, kInfinity = 0x7f800000;
    std::int32_t most = 0;
    for (const float value : values) {
        most = std::max(most, std::bit_cast<std::int32_t>(value) & kMagnitude);
    }
    return most < kInfinity ? std::bit_cast<float>(most) : std::numeric_limits<float>::quiet_NaN();
}

// One scale for a set of values so that the largest uses the full code range. A scale too small to
// be inverted means values that are zero for every purpose.
float code_scale(float largest, std::int32_t limit) {
    const float scale = largest / static_cast<float>(limit);
    return std::isnan(scale) || scale >= std::numeric_limits<float>::min() ? scale : 0.0f;
}

std::int16_t quantise(float value, float scale, std::int32_t limit) {
    if (!(scale > 0)) return 0;
    const auto code = static_cast<std::int32_t>(std::lround(value / scale));
    return static_cast<std::int16_t>(std::clamp(code, -limit, limit));
}

// The codes whose detail_value is nearest. The loop has neither a branch nor a call: it runs four
// or more at once.
void quantise_roots(std::span<const float> values, float scale, std::int8_t* code) {
    if (!(scale > 0)) {
        std::fill_n(code, values.size(), std::int8_t{0});
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float target = std::abs(values[i]) / scale;
        const auto below = static_cast<std::int32_t>(std::sqrt(target));
        // Squares have their middle above that of their roots.
        const std::int32_t over = target < static_cast<float>(below * below + below) + 0.5f ? 0 : 1;
        const std::int32_t root = std::min(below + over, 127);
        code[i] = static_cast<std::int8_t>(values[i] < 0 ? -root : root);
    }
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

constexpr std::int32_t kAverageLimit = 32767;

// Of details band by band, whose scales are the last ones.
void append_codes(SparseRows& rows, std::span<const float> values, std::uint32_t bands) {
    const std::size_t details = values.size() / bands;
    const std::size_t first_8 = rows.code8.size(), first_16 = rows.code16.size();
    rows.code8.resize(first_8 + (rows.code_bits == 8 ? values.size() : 0));
    rows.code16.resize(first_16 + (rows.code_bits == 8 ? 0 : values.size()));
    std::vector<std::int8_t> codes(rows.code_bits == 8 ? details : 0);
    for (std::uint32_t band = 0; band < bands; ++band) {
        const std::span<const float> own = values.subspan(band * details, details);
        const float scale = rows.detail_scale[rows.detail_scale.size() - bands + band];
        if (rows.code_bits == 8) {
            quantise_roots(own, scale, codes.data());
            for (std::size_t i = 0; i < details; ++i) {
                rows.code8[first_8 + i * bands + band] = codes[i];
            }
        } else {
            for (std::size_t i = 0; i < details; ++i) {
                rows.code16[first_16 + i * bands + band] =
                    quantise(own[i], scale, kLargestDetail16);
            }
        }
    }
}

}  // namespace

SparseRowsView SparseRows::view() const {
    return {cubemap_size, code_bits, index_bytes, row_offset, average_scale, detail_scale,
            average_code, index16,   index32,     code8,      code16};
}

SparseRows make_sparse_rows(std::uint32_t cubemap_size, std::uint32_t code_bits) {
    SparseRows rows;
    rows.cubemap_size = cubemap_size;
    rows.code_bits = code_bits;
    rows.index_bytes = cubemap_texels(cubemap_size) <= 65536 ? 2 : 4;
    return rows;
}

bool append_row(SparseRows& rows, const SparseRow& row) {
    const std::size_t details = row.index.size();
    assert(row.value.size() == details * row.bands && row.average.size() == kCubeFaces * row.bands);
    if (details > std::numeric_limits<std::uint32_t>::max() - rows.row_offset.back()) return false;
    const std::int32_t limit = rows.code_bits == 8 ? kLargestDetail8 : kLargestDetail16;
    const std::span<const float> values(row.value), averages(row.average);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        const auto average = averages.subspan(std::size_t{band} * kCubeFaces, kCubeFaces);
        const float average_scale = code_scale(largest_magnitude(average), kAverageLimit);
        rows.average_scale.push_back(average_scale);
        for (const float value : average) {
            rows.average_code.push_back(quantise(value, average_scale, kAverageLimit));
        }
        rows.detail_scale.push_back(
            code_scale(largest_magnitude(values.subspan(band * details, details)), limit));
    }
    for (const std::uint32_t index : row.index) {
        if (rows.index_bytes == 2) {
            rows.index16.push_back(static_cast<std::uint16_t>(index));
        } else {
            rows.index32.push_back(index);
        }
    }
    append_codes(rows, values, row.bands);
    rows.row_offset.push_back(rows.row_offset.back() + static_cast<std::uint32_t>(details));
    return true;
}

std::optional<std::uint32_t> find_faulty_row(const SparseRows& rows, std::uint32_t bands) {
    assert(bands > 0 && rows.detail_scale.size() == rows.average_scale.size());
    for (std::size_t band_row = 0; band_row < rows.detail_scale.size(); ++band_row) {
        if (!std::isfinite(rows.average_scale[band_row] + rows.detail_scale[band_row])) {
            return static_cast<std::uint32_t>(band_row / bands);
        }
    }
    return std::nullopt;
}

bool append_rows(SparseRows& rows, const SparseRows& tail) {
    assert(tail.cubemap_size == rows.cubemap_size && tail.code_bits == rows.code_bits);
    const std::uint32_t base = rows.row_offset.back();
    if (tail.row_offset.back() > std::numeric_limits<std::uint32_t>::max() - base) return false;
    for (std::size_t r = 1; r < tail.row_offset.size(); ++r) {
        rows.row_offset.push_back(base + tail.row_offset[r]);
    }
    append(rows.average_scale, tail.average_scale);
    append(rows.detail_scale, tail.detail_scale);
    append(rows.average_code, tail.average_code);
    append(rows.index16, tail.index16);
    append(rows.index32, tail.index32);
    append(rows.code8, tail.code8);
    append(rows.code16, tail.code16);
    return true;
}

SparseRows pick_rows(SparseRows rows, std::uint32_t bands, std::span<const std::uint32_t> from) {
    SparseRows picked = make_sparse_rows(rows.cubemap_size, rows.code_bits);
    std::size_t details = 0;
    picked.row_offset.reserve(from.size() + 1);
    for (const std::uint32_t r : from) {
        details += rows.row_offset[r + 1] - rows.row_offset[r];
        picked.row_offset.push_back(static_cast<std::uint32_t>(details));
    }
    // One part after the other, each gone once it is copied: not all are there twice.
    const auto take = [&](auto& to, auto& values, std::size_t count, const auto& copy) {
        if (!values.empty()) {
            to.reserve(count);
            for (const std::uint32_t r : from) {
                copy(to, values, r);
            }
            std::remove_reference_t<decltype(values)>().swap(values);
        }
    };
    const auto of_row = [](std::size_t each) {
        return [each](auto& to, const auto& values, std::uint32_t r) {
            const auto first = values.begin() + static_cast<std::ptrdiff_t>(r * each);
            to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(each));
        };
    };
    const auto of_details = [&](std::size_t each) {
        return [&rows, each](auto& to, const auto& values, std::uint32_t r) {
            const auto place = [&](std::uint32_t row) {
                return values.begin() +
                       static_cast<std::ptrdiff_t>(std::size_t{rows.row_offset[row]} * each);
            };
            to.insert(to.end(), place(r), place(r + 1));
        };
    };
    take(picked.average_scale, rows.average_scale, from.size() * bands, of_row(bands));
    take(picked.detail_scale, rows.detail_scale, from.size() * bands, of_row(bands));
    take(picked.average_code, rows.average_code, from.size() * bands * kCubeFaces,
         of_row(std::size_t{bands} * kCubeFaces));
    take(picked.index16, rows.index16, details, of_details(1));
    take(picked.index32, rows.index32, details, of_details(1));
    take(picked.code8, rows.code8, details * bands, of_details(bands));
    take(picked.code16, rows.code16, details * bands, of_details(bands));
    return picked;
}

void decode_row(const SparseRowsView& rows, const RowRange& range, std::uint32_t row,
                std::uint32_t band, std::span<float> dense) {
    std::fill(dense.begin(), dense.end(), 0.0f);
    const std::uint32_t n = rows.cubemap_size;
    const std::size_t band_row = std::size_t{range.first_band_row} + row * range.bands + band;
    for (std::uint32_t face = 0; face < kCubeFaces; ++face) {
        dense[std::size_t{face} * n * n] =
            static_cast<float>(rows.average_code[band_row * kCubeFaces + face]) *
            rows.average_scale[band_row];
    }
    const std::uint32_t first = rows.row_offset[range.first_row];
    const std::uint32_t begin = rows.row_offset[range.first_row + row];
    const std::uint32_t end = rows.row_offset[range.first_row + row + 1];
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::size_t code_at = range.first_code + std::size_t{i - first} * range.bands + band;
        const std::int32_t value = rows.code_bits == 8 ? detail_value(rows.code8[code_at])
                                                       : detail_value(rows.code16[code_at]);
        const std::uint32_t index = rows.index_bytes == 2 ? rows.index16[i] : rows.index32[i];
        dense[index] = static_cast<float>(value) * rows.detail_scale[band_row];
    }
}

}  // namespace opaline::formats
