#include "bake/encode/receiver_error.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace opaline::bake {
namespace {

// Where the last `row.terms` rows stand.
formats::RowRange last_rows(const DenseRow& row, const formats::SparseRows& stored) {
    const auto rows = static_cast<std::uint32_t>(stored.row_offset.size() - 1);
    formats::RowRange range;
    range.first_row = rows - row.terms;
    range.rows = row.terms;
    range.bands = row.bands;
    range.first_band_row =
        static_cast<std::uint32_t>(stored.detail_scale.size()) - row.terms * row.bands;
    const std::uint64_t details = stored.row_offset[rows] - stored.row_offset[range.first_row];
    range.first_code = stored.code8.size() + stored.code16.size() - details * row.bands;
    return range;
}

double squared_norm(std::span<const float> values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value) * static_cast<double>(value);
    }
    return sum;
}

// a = sqrt(4 pi) a + b.
void join_constant(std::span<float> a, std::span<const float> b) {
    const float constant = 2 * std::sqrt(std::numbers::pi_v<float>);
    for (std::size_t j = 0; j < a.size(); ++j) {
        a[j] = constant * a[j] + b[j];
    }
}

}  // namespace

float receiver_error(const DenseRow& row, TermsSeen seen, const formats::SparseRows& stored) {
    const formats::SparseRowsView rows = stored.view();
    const formats::RowRange range = last_rows(row, stored);
    const bool is_joined = seen == TermsSeen::together && row.terms > 1;
    double lost = 0, all = 0;
    std::vector<float> difference(row.size()), whole(row.size()), decoded(row.size());
    // Of the row and what is stored of it.
    const auto take = [&](std::uint32_t term, std::uint32_t band, std::span<float> values,
                          std::span<float> apart) {
        const std::span<const float> plane = row.plane(term, band);
        formats::decode_row(rows, range, term, band, decoded);
        for (std::size_t j = 0; j < plane.size(); ++j) {
            values[j] = plane[j];
            apart[j] = plane[j] - decoded[j];
        }
    };
    std::vector<float> next_difference(is_joined ? row.size() : 0), next_whole(next_difference);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        for (std::uint32_t term = 0; term < row.terms; ++term) {
            take(term, band, whole, difference);
            if (is_joined && term == 0) {
                ++term;
                take(term, band, next_whole, next_difference);
                join_constant(whole, next_whole);
                join_constant(difference, next_difference);
            }
            lost += squared_norm(difference);
            all += squared_norm(whole);
        }
    }
    return all > 0 || std::isnan(all) ? static_cast<float>(std::sqrt(lost / all)) : 0.0f;
}

}  // namespace opaline::bake
