#include "bake/encode/shorten_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/detail_codes.h"

namespace opaline::bake {
namespace {

using formats::kCubeFaces;
using formats::PrimitiveRecord;
using formats::SparseRows;
using formats::SparseRowsView;

std::uint32_t index_at(const SparseRowsView& rows, std::size_t detail) {
    return rows.index_bytes == 2 ? rows.index16[detail] : rows.index32[detail];
}

float value_at(const SparseRowsView& rows, std::size_t code) {
    return static_cast<float>(rows.code_bits == 8 ? formats::detail_value(rows.code8[code])
                                                  : formats::detail_value(rows.code16[code]));
}

// Where a row and its codes stand.
struct RowPlace {
    std::size_t first_detail = 0, details = 0, first_code = 0, band_row = 0;
    std::uint32_t bands = 1;
};

// The squared score of each detail; what is not finite is dropped first.
std::vector<float> score_details(const SparseRowsView& rows, const RowPlace& place,
                                 std::span<const float> weight) {
    constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};
    std::vector<float> score(place.details);
    for (std::size_t i = 0; i < place.details; ++i) {
        float squares = 0;
        for (std::uint32_t band = 0; band < place.bands; ++band) {
            const float value = (place.bands == 1 ? 1.0f : kLuminance[band]) *
                                rows.detail_scale[place.band_row + band] *
                                value_at(rows, place.first_code + i * place.bands + band);
            squares += value * value;
        }
        const float side = weight[index_at(rows, place.first_detail + i)];
        score[i] = std::isfinite(squares) ? side * side * squares : 0.0f;
    }
    return score;
}

// The `count` details with the largest scores, ascending.
std::vector<std::uint32_t> choose_details(std::span<const float> score, std::size_t count) {
    std::vector<std::uint32_t> chosen(score.size());
    std::iota(chosen.begin(), chosen.end(), 0u);
    if (count < chosen.size()) {
        std::nth_element(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count),
                         chosen.end(), [&](std::uint32_t a, std::uint32_t b) {
                             return score[a] != score[b] ? score[a] > score[b] : a < b;
                         });
        chosen.resize(count);
        std::sort(chosen.begin(), chosen.end());
    }
    return chosen;
}

void append_chosen(const SparseRowsView& from, const RowPlace& place,
                   std::span<const std::uint32_t> chosen, SparseRows& to) {
    for (const std::uint32_t i : chosen) {
        const std::size_t detail = place.first_detail + i;
        if (from.index_bytes == 2) {
            to.index16.push_back(from.index16[detail]);
        } else {
            to.index32.push_back(from.index32[detail]);
        }
        for (std::uint32_t band = 0; band < place.bands; ++band) {
            const std::size_t code = place.first_code + std::size_t{i} * place.bands + band;
            if (from.code_bits == 8) {
                to.code8.push_back(from.code8[code]);
            } else {
                to.code16.push_back(from.code16[code]);
            }
        }
    }
    for (std::uint32_t band = 0; band < place.bands; ++band) {
        const std::size_t band_row = place.band_row + band;
        to.average_scale.push_back(from.average_scale[band_row]);
        to.detail_scale.push_back(from.detail_scale[band_row]);
        const auto averages = from.average_code.subspan(kCubeFaces * band_row, kCubeFaces);
        to.average_code.insert(to.average_code.end(), averages.begin(), averages.end());
    }
    to.row_offset.push_back(to.row_offset.back() + static_cast<std::uint32_t>(chosen.size()));
}

std::uint64_t rows_of_primitives(const formats::AssetView& asset) {
    std::uint64_t rows = 0;
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        rows += asset.rows_of(p).rows;
    }
    return rows;
}

}  // namespace

formats::AssetView ShortRows::view_of(const formats::AssetView& asset) const {
    formats::AssetView view = asset;
    view.primitives = primitives;
    view.transport = rows.view();
    return view;
}

formats::Result<ShortRows> shorten_rows(const formats::AssetView& asset, std::uint32_t kept) {
    const SparseRowsView& from = asset.transport;
    if (rows_of_primitives(asset) > from.rows()) {
        return formats::make_error(formats::ErrorKind::bad_input, "", "section TRAN",
                                   "primitives share rows", "bake the scene again");
    }
    const Selector selector = make_selector(from.cubemap_size, kept);
    const std::size_t count = kept > kCubeFaces ? kept - kCubeFaces : 0;
    ShortRows out{{asset.primitives.begin(), asset.primitives.end()}, {}};
    out.rows.cubemap_size = from.cubemap_size;
    out.rows.code_bits = from.code_bits;
    out.rows.index_bytes = from.index_bytes;
    for (std::size_t p = 0; p < out.primitives.size(); ++p) {
        PrimitiveRecord& primitive = out.primitives[p];
        const formats::RowRange range = asset.rows_of(p);
        primitive.first_row = static_cast<std::uint32_t>(out.rows.row_offset.size() - 1);
        primitive.first_band_row = static_cast<std::uint32_t>(out.rows.detail_scale.size());
        primitive.first_code = out.rows.code8.size() + out.rows.code16.size();
        const std::size_t first = from.row_offset[range.first_row];
        for (std::uint32_t row = 0; row < range.rows; ++row) {
            const std::size_t detail = from.row_offset[range.first_row + row];
            const RowPlace place{detail, from.row_offset[range.first_row + row + 1] - detail,
                                 range.first_code + (detail - first) * range.bands,
                                 range.first_band_row + std::size_t{row} * range.bands,
                                 range.bands};
            append_chosen(from, place,
                          choose_details(score_details(from, place, selector.weight), count),
                          out.rows);
        }
    }
    return out;
}

std::uint32_t longest_row(const formats::AssetView& asset) {
    std::uint32_t most = 0;
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::RowRange range = asset.rows_of(p);
        for (std::uint32_t row = range.first_row; row < range.first_row + range.rows; ++row) {
            most = std::max(most, kCubeFaces + asset.transport.row_offset[row + 1] -
                                      asset.transport.row_offset[row]);
        }
    }
    return most;
}

}  // namespace opaline::bake
