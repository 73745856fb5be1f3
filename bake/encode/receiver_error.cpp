#include "bake/encode/receiver_error.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace opaline::bake {
namespace {

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

float RowLoss::error() const {
    return all > 0 || std::isnan(all) ? static_cast<float>(std::sqrt(lost / all)) : 0.0f;
}

formats::RowRange rows_of_receiver(const formats::SparseRows& stored, std::size_t receiver,
                                   const DenseRow& row) {
    formats::RowRange range;
    range.first_row = static_cast<std::uint32_t>(receiver) * row.terms;
    range.rows = row.terms;
    range.bands = row.bands;
    range.first_band_row = range.first_row * row.bands;
    range.first_code = std::uint64_t{stored.row_offset[range.first_row]} * row.bands;
    return range;
}

RowLoss receiver_loss(const DenseRow& row, TermsSeen seen, const formats::SparseRows& stored,
                      std::size_t receiver) {
    const formats::SparseRowsView rows = stored.view();
    const formats::RowRange range = rows_of_receiver(stored, receiver, row);
    const bool is_joined = seen == TermsSeen::together && row.terms > 1;
    RowLoss loss;
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
            loss.lost += squared_norm(difference);
            loss.all += squared_norm(whole);
        }
    }
    return loss;
}

}  // namespace opaline::bake
