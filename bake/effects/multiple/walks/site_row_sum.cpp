#include "bake/effects/multiple/walks/site_row_sum.h"

#include "bake/base/vector8.h"

namespace opaline::bake {
namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr std::size_t kMostLanes = 4 * SiteRowSum::kMostRows;

struct Entries {
    std::span<const std::uint32_t> index;
    const float* value;
    std::uint32_t bands;
};

// sum[lanes * index[k] + lane] += factor[lane] * value of k.
template <class Vector, std::size_t kVectors>
OPALINE_INLINE void add_entries(const Entries& entries, const float* factor, std::size_t vectors,
                                float* sum) {
    constexpr std::size_t kWidth = sizeof(Vector) / sizeof(float);
    vectors = kVectors > 0 ? kVectors : vectors;
    const std::size_t bands = entries.bands;
    const std::uint32_t* const index = entries.index.data();
    const std::size_t count = entries.index.size();
    for (std::size_t k = 0; k < count; ++k) {
        const float* const from = entries.value + bands * k;
        const Float4 own = bands == 1 ? Float4{from[0], from[0], from[0], from[0]}
                                      : Float4{from[0], from[1], from[2], 0};
        Vector value{};
        for (std::size_t part = 0; part < kWidth; part += 4) {
            __builtin_memcpy(reinterpret_cast<char*>(&value) + part * sizeof(float), &own,
                             sizeof own);
        }
        float* const to = sum + vectors * kWidth * index[k];
        for (std::size_t v = 0; v < vectors; ++v) {
            Vector all, f;
            __builtin_memcpy(&all, to + v * kWidth, sizeof all);
            __builtin_memcpy(&f, factor + v * kWidth, sizeof f);
            all += f * value;
            __builtin_memcpy(to + v * kWidth, &all, sizeof all);
        }
    }
}

using Float16 = float __attribute__((vector_size(64)));

OPALINE_VECTOR_CLONES
void add_to_four_lanes(const Entries& entries, const float* factor, float* sum) {
    add_entries<Float4, 1>(entries, factor, 1, sum);
}

OPALINE_VECTOR_CLONES
void add_to_sixteen_lanes(const Entries& entries, const float* factor, float* sum) {
    add_entries<Float16, 1>(entries, factor, 1, sum);
}

OPALINE_VECTOR_CLONES
void add_to_lanes(const Entries& entries, const float* factor, std::size_t lanes, float* sum) {
    add_entries<Float4, 0>(entries, factor, lanes / 4, sum);
}

// A plane of a receiver's rows, and its share of each row of the sums.
struct Plane {
    float* to;
    const float* share;
};

// to[k] += share[row] * sums[lanes * k + step * row] for all planes and rows.
OPALINE_VECTOR_CLONES
void add_shares(const float* sums, std::size_t lanes, std::size_t step, std::size_t texels,
                std::size_t rows, const Plane* planes, std::size_t count) {
    constexpr std::size_t kPart = 32;
    float column[SiteRowSum::kMostRows][kPart];
    for (std::size_t first = 0; first < texels; first += kPart) {
        const std::size_t here = texels - first < kPart ? texels - first : kPart;
        for (std::size_t k = 0; k < here; ++k) {
            for (std::size_t row = 0; row < rows; ++row) {
                column[row][k] = sums[lanes * (first + k) + step * row];
            }
        }
        for (std::size_t p = 0; p < count; ++p) {
            float* const to = planes[p].to + first;
            for (std::size_t row = 0; row < rows; ++row) {
                const float share = planes[p].share[row];
                if (share != 0) {
                    for (std::size_t k = 0; k < here; ++k) {
                        to[k] += share * column[row][k];
                    }
                }
            }
        }
    }
}

}  // namespace

SiteRowSum::SiteRowSum(std::size_t texels, std::uint32_t rows, std::uint32_t bands)
    : rows_(rows),
      bands_(bands),
      texels_(texels),
      lanes_(bands == 1 ? 4 * std::size_t{(rows + 3) / 4} : 4 * std::size_t{rows}),
      lines_((texels * lanes_ + 15) / 16 + 1) {}

void SiteRowSum::add(const SiteRows& from, std::size_t site, const Weights& weights) {
    std::array<float, kMostLanes> factor{};
    for (std::uint32_t r = 0; r < rows_; ++r) {
        for (std::uint32_t b = 0; b < bands_; ++b) {
            factor[lane(r, b)] = weights[r][b];
        }
    }
    const SiteRows::Block& block = from.blocks[site / SiteRows::kPerBlock];
    const std::size_t i = site % SiteRows::kPerBlock, first = block.offset[i];
    const Entries entries{std::span(block.index).subspan(first, block.offset[i + 1] - first),
                          block.value.data() + bands_ * first, bands_};
    float* const sum = lines_.front().value.data();
    if (lanes_ == 4) {
        add_to_four_lanes(entries, factor.data(), sum);
    } else if (lanes_ == 16) {
        add_to_sixteen_lanes(entries, factor.data(), sum);
    } else {
        add_to_lanes(entries, factor.data(), lanes_, sum);
    }
}

void SiteRowSum::add_to(std::span<const Share> shares, const DenseRow& to) const {
    std::vector<Plane> planes(shares.size());
    for (std::uint32_t band = 0; band < bands_; ++band) {
        for (std::size_t s = 0; s < shares.size(); ++s) {
            planes[s] = {to.plane(shares[s].term, band).data(), shares[s].of_row.data()};
        }
        add_shares(sums() + lane(0, band), lanes_, lane(1, 0), texels_, rows_, planes.data(),
                   planes.size());
    }
}

}  // namespace opaline::bake
