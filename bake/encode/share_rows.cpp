#include "bake/encode/share_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bake/encode/share_details.h"
#include "bake/plan/knobs.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMostOfMean = 2;

bool keeps_all(const RowEncoder& encoder) {
    return encoder.selector.kept >= encoder.selector.weight.size();
}

std::uint32_t details_of(const RowEncoder& encoder) {
    return encoder.selector.kept - std::min(encoder.selector.kept, formats::kCubeFaces);
}

// Of each row: its sum of squared face averages, to the power of -1/4.
std::vector<float> weigh_rows(const formats::SparseRows& rows, const RowShape& shape) {
    // Of the mean square: rows that hold hardly any light are not worth ever more details.
    constexpr double kDark = 1e-4;
    const std::size_t count = rows.row_offset.size() - 1;
    std::vector<double> square(count);
    for (std::size_t i = 0; i < rows.average_code.size(); ++i) {
        const std::size_t band_row = i / formats::kCubeFaces;
        const double value = static_cast<double>(rows.average_scale[band_row]) *
                             static_cast<double>(rows.average_code[i]);
        square[band_row / shape.bands] += std::isfinite(value) ? value * value : 0;
    }
    const double mean = std::accumulate(square.begin(), square.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(1, square.size()));
    std::vector<float> weight(count, 1.0f);
    for (std::size_t row = 0; row < count && mean > 0; ++row) {
        const double own = square[row] / mean;
        weight[row] = static_cast<float>(std::pow(own + kDark, -0.25));
    }
    return weight;
}

}  // namespace

RowEncoder widen(const RowEncoder& encoder) {
    RowEncoder wide = encoder;
    const auto all = static_cast<std::uint32_t>(encoder.selector.weight.size());
    wide.selector.kept = keeps_all(encoder) ? encoder.selector.kept
                                            : std::min(all, kMostOfMean * encoder.selector.kept);
    return wide;
}

void reserve_rows(formats::SparseRows& rows, const RowEncoder& wide, std::size_t count,
                  std::uint32_t bands) {
    const std::size_t details =
        count * std::min<std::size_t>(details_of(wide), formats::cubemap_texels(rows.cubemap_size));
    if (rows.index_bytes == 2) {
        rows.index16.reserve(details);
    } else {
        rows.index32.reserve(details);
    }
    if (rows.code_bits == 8) {
        rows.code8.reserve(details * bands);
    } else {
        rows.code16.reserve(details * bands);
    }
}

formats::SparseRows share_rows(formats::SparseRows rows, const RowShape& shape,
                               const RowEncoder& encoder) {
    const std::size_t count = rows.row_offset.size() - 1;
    if (keeps_all(encoder) || count == 0) return rows;
    std::size_t most = 0;
    for (std::size_t row = 0; row < count; ++row) {
        most += std::min(rows.row_offset[row + 1] - rows.row_offset[row], details_of(encoder));
    }
    return share_details(rows, shape.bands, encoder.selector,
                         {std::vector<std::uint32_t>(count), weigh_rows(rows, shape), {most}});
}

LossMeter::LossMeter(const RowEncoder& wide, const RowShape& shape)
    : shape_(shape), encoder_(wide) {
    encoder_.code_bits = 16;
    rows_ = empty_rows(encoder_);
}

void LossMeter::add(const DenseRow& row) {
    encode_receiver(encoder_, row, rows_);
    beyond_.push_back(receiver_loss(row, shape_.seen, rows_, beyond_.size()));
}

void LossMeter::append(const LossMeter& tail) {
    formats::append_rows(rows_, tail.rows_);
    beyond_.insert(beyond_.end(), tail.beyond_.begin(), tail.beyond_.end());
}

std::vector<RowLoss> LossMeter::losses(const formats::SparseRows& kept) const {
    std::vector<RowLoss> losses = beyond_;
    std::vector<float> values(std::size_t{shape_.terms} * shape_.bands *
                              formats::cubemap_texels(rows_.cubemap_size));
    const DenseRow wide{values, rows_.cubemap_size, shape_.terms, shape_.bands};
    for (std::size_t i = 0; i < losses.size(); ++i) {
        const formats::RowRange range = rows_of_receiver(rows_, i, wide);
        for (std::uint32_t term = 0; term < shape_.terms; ++term) {
            for (std::uint32_t band = 0; band < shape_.bands; ++band) {
                formats::decode_row(rows_.view(), range, term, band, wide.plane(term, band));
            }
        }
        losses[i].lost += receiver_loss(wide, shape_.seen, kept, i).lost;
    }
    return losses;
}

}  // namespace opaline::bake
