#include "bake/encode/share_details.h"

#include <array>
#include <bit>
#include <cassert>
#include <utility>

#include "formats/opal/detail_codes.h"

namespace opaline::bake {
namespace {

using formats::SparseRows;

std::uint32_t index_of(const SparseRows& rows, std::size_t detail) {
    return rows.index_bytes == 2 ? rows.index16[detail] : rows.index32[detail];
}

// Of a detail, before its row's weight; squared.
float square_of(const SparseRows& rows, std::uint32_t bands, std::size_t row, std::size_t detail) {
    constexpr std::array<float, 3> kLuminanceOfBand{0.2126f, 0.7152f, 0.0722f};
    float sum = 0;
    for (std::uint32_t band = 0; band < bands; ++band) {
        const std::size_t at = detail * bands + band;
        const std::int32_t steps = rows.code_bits == 8 ? formats::detail_value(rows.code8[at])
                                                       : formats::detail_value(rows.code16[at]);
        const float value = (bands == 1 ? 1.0f : kLuminanceOfBand[band]) *
                            rows.detail_scale[row * bands + band] * static_cast<float>(steps);
        sum += value * value;
    }
    return sum;
}

// The smallest score that a pool keeps, and how many of that one.
struct Cut {
    std::uint32_t bits = 0;  // of the score: positive floats are in the order of their bits
    std::size_t equal = 0;
};

// Counts of the upper halves of scores' bits, then of the lower halves of those in one bucket.
using Histogram = std::vector<std::size_t>;
constexpr std::uint32_t kHalf = 16;

// The bucket in which the `most`-th largest is, which becomes its number among those of the bucket;
// 0 where there are not so many.
std::uint32_t find_bucket(const Histogram& histogram, std::size_t& most) {
    for (std::size_t bucket = histogram.size() - 1; bucket > 0; --bucket) {
        if (histogram[bucket] >= most) return static_cast<std::uint32_t>(bucket);
        most -= histogram[bucket];
    }
    return 0;
}

// Calls with the row, the detail and its score, in their order.
template <typename Visit>
void visit_details(const SparseRows& rows, std::uint32_t bands, const Selector& selector,
                   const DetailPools& pools, Visit&& visit) {
    for (std::size_t row = 0; row + 1 < rows.row_offset.size(); ++row) {
        for (std::size_t i = rows.row_offset[row]; i < rows.row_offset[row + 1]; ++i) {
            const float weight = pools.weight[row] * selector.weight[index_of(rows, i)];
            const float score = weight * weight * square_of(rows, bands, row, i);
            visit(row, i, score > 0 ? score : 0.0f);  // not NaN
        }
    }
}

}  // namespace

SparseRows share_details(const SparseRows& rows, std::uint32_t bands, const Selector& selector,
                         const DetailPools& pools) {
    assert(pools.pool.size() + 1 == rows.row_offset.size() &&
           pools.weight.size() == pools.pool.size());
    const std::size_t count = pools.most.size();
    std::vector<Histogram> upper(count, Histogram(std::size_t{1} << kHalf)), lower = upper;
    visit_details(rows, bands, selector, pools, [&](std::size_t row, std::size_t, float score) {
        ++upper[pools.pool[row]][std::bit_cast<std::uint32_t>(score) >> kHalf];
    });
    std::vector<Cut> cuts(count);
    for (std::size_t p = 0; p < count; ++p) {
        cuts[p].equal = pools.most[p];
        cuts[p].bits = find_bucket(upper[p], cuts[p].equal) << kHalf;
    }
    visit_details(rows, bands, selector, pools, [&](std::size_t row, std::size_t, float score) {
        const std::uint32_t p = pools.pool[row], bits = std::bit_cast<std::uint32_t>(score);
        if (bits >> kHalf == cuts[p].bits >> kHalf) ++lower[p][bits & 0xffffu];
    });
    for (std::size_t p = 0; p < count; ++p) {
        cuts[p].bits |= find_bucket(lower[p], cuts[p].equal);
    }
    SparseRows kept = formats::make_sparse_rows(rows.cubemap_size, rows.code_bits);
    kept.average_scale = rows.average_scale;
    kept.detail_scale = rows.detail_scale;
    kept.average_code = rows.average_code;
    kept.row_offset.resize(rows.row_offset.size());
    visit_details(rows, bands, selector, pools, [&](std::size_t row, std::size_t i, float score) {
        Cut& cut = cuts[pools.pool[row]];
        const auto bits = std::bit_cast<std::uint32_t>(score);
        if (bits == 0 || bits < cut.bits) return;
        if (bits == cut.bits) {
            if (cut.equal == 0) return;
            --cut.equal;
        }
        ++kept.row_offset[row + 1];
        if (rows.index_bytes == 2) {
            kept.index16.push_back(rows.index16[i]);
        } else {
            kept.index32.push_back(rows.index32[i]);
        }
        for (std::uint32_t band = 0; band < bands; ++band) {
            if (rows.code_bits == 8) {
                kept.code8.push_back(rows.code8[i * bands + band]);
            } else {
                kept.code16.push_back(rows.code16[i * bands + band]);
            }
        }
    });
    for (std::size_t row = 1; row < kept.row_offset.size(); ++row) {
        kept.row_offset[row] += kept.row_offset[row - 1];
    }
    return kept;
}

}  // namespace opaline::bake
