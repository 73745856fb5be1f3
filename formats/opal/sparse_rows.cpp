#include "formats/opal/sparse_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "formats/opal/cubemap.h"
#include "formats/opal/detail_codes.h"

namespace opaline::formats {
namespace {

// NaN where any of them is not finite.
float largest_magnitude(std::span<const float> values) {
    float largest = 0;
    for (const float value : values) {
        if (!std::isfinite(value)) {
            return std::numeric_limits<float>::quiet_NaN();
        }
        largest = std::max(largest, std::abs(value));
    }
    return largest;
}

// One scale for a set of values so that the largest uses the full code range. A scale too small to
// be inverted means values that are zero for every purpose.
float code_scale(float largest, std::int32_t limit) {
    const float scale = largest / static_cast<float>(limit);
    return std::isnan(scale) || scale >= std::numeric_limits<float>::min() ? scale : 0.0f;
}

std::int16_t quantise(float value, float scale, std::int32_t limit) {
    if (!(scale > 0)) {
        return 0;
    }
    const auto code = static_cast<std::int32_t>(std::lround(value / scale));
    return static_cast<std::int16_t>(std::clamp(code, -limit, limit));
}

// The code whose detail_value is nearest.
std::int8_t quantise_root(float value, float scale) {
    if (!(scale > 0)) {
        return 0;
    }
    const float target = std::abs(value) / scale;
    auto root = static_cast<std::int32_t>(std::lround(std::sqrt(target)));
    // Squares have their middle above that of their roots.
    if (target < static_cast<float>(root * root - root) + 0.5f) {
        --root;
    }
    root = std::clamp(root, 0, 127);
    return static_cast<std::int8_t>(value < 0 ? -root : root);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

constexpr std::int32_t kAverageLimit = 32767;

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
    if (details > std::numeric_limits<std::uint32_t>::max() - rows.row_offset.back()) {
        return false;
    }
    const std::int32_t limit = rows.code_bits == 8 ? kLargestDetail8 : kLargestDetail16;
    const std::span<const float> values(row.value), averages(row.average);
    const std::size_t first_band_row = rows.detail_scale.size();
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
    for (std::size_t i = 0; i < details; ++i) {
        if (rows.index_bytes == 2) {
            rows.index16.push_back(static_cast<std::uint16_t>(row.index[i]));
        } else {
            rows.index32.push_back(row.index[i]);
        }
        for (std::uint32_t band = 0; band < row.bands; ++band) {
            const float scale = rows.detail_scale[first_band_row + band];
            const float value = values[band * details + i];
            if (rows.code_bits == 8) {
                rows.code8.push_back(quantise_root(value, scale));
            } else {
                rows.code16.push_back(quantise(value, scale, limit));
            }
        }
    }
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
    if (tail.row_offset.back() > std::numeric_limits<std::uint32_t>::max() - base) {
        return false;
    }
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

SparseRows pick_rows(const SparseRows& rows, std::uint32_t bands,
                     std::span<const std::uint32_t> from) {
    SparseRows picked = make_sparse_rows(rows.cubemap_size, rows.code_bits);
    const auto copy = [](auto& to, const auto& values, std::size_t first, std::size_t count) {
        if (!values.empty()) {
            const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
            to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
        }
    };
    std::size_t details = 0;
    for (const std::uint32_t r : from) {
        details += rows.row_offset[r + 1] - rows.row_offset[r];
    }
    picked.row_offset.reserve(from.size() + 1);
    picked.average_scale.reserve(from.size() * bands);
    picked.detail_scale.reserve(from.size() * bands);
    picked.average_code.reserve(from.size() * bands * kCubeFaces);
    picked.index16.reserve(rows.index16.empty() ? 0 : details);
    picked.index32.reserve(rows.index32.empty() ? 0 : details);
    picked.code8.reserve(rows.code8.empty() ? 0 : details * bands);
    picked.code16.reserve(rows.code16.empty() ? 0 : details * bands);
    for (const std::uint32_t r : from) {
        const std::size_t first = rows.row_offset[r], count = rows.row_offset[r + 1] - first;
        const std::size_t band_row = std::size_t{r} * bands;
        picked.row_offset.push_back(picked.row_offset.back() + static_cast<std::uint32_t>(count));
        copy(picked.average_scale, rows.average_scale, band_row, bands);
        copy(picked.detail_scale, rows.detail_scale, band_row, bands);
        copy(picked.average_code, rows.average_code, band_row * kCubeFaces, bands * kCubeFaces);
        copy(picked.index16, rows.index16, first, count);
        copy(picked.index32, rows.index32, first, count);
        copy(picked.code8, rows.code8, first * bands, count * bands);
        copy(picked.code16, rows.code16, first * bands, count * bands);
    }
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
