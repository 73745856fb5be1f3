#include "bake/effects/multiple/walks/site_row_sum.h"

#include <gtest/gtest.h>

#include <vector>

#include "bake/effects/multiple/walks/site_rows.h"

namespace opaline::tests {
namespace {

TEST(SiteRows, SumsOfSeveralRowsAreThoseOfEachRowByItself) {
    constexpr std::size_t kTexels = 44;
    for (const std::uint32_t bands : {1u, 3u}) {
        bake::SiteRows rows;
        rows.bands = bands;
        bake::SiteRows::Block block;
        for (std::uint32_t site = 0; site < 3; ++site) {
            for (std::uint32_t k = site; k < kTexels; k += 2 + site) {
                block.index.push_back(k);
                for (std::uint32_t b = 0; b < bands; ++b) {
                    block.value.push_back(static_cast<float>(1 + k + 20 * b + 100 * site));
                }
            }
            block.offset.push_back(static_cast<std::uint32_t>(block.index.size()));
        }
        rows.blocks.push_back(block);
        const std::size_t step = bands == 1 ? 1 : 4;
        for (const std::uint32_t count : {1u, 4u, 9u}) {
            bake::SiteRowSum sum(kTexels, count, bands);
            std::vector<std::vector<float>> alone(count, std::vector<float>(step * kTexels));
            for (std::uint32_t site = 0; site < 3; ++site) {
                bake::SiteRowSum::Weights weights{};
                for (std::uint32_t r = 0; r < count; ++r) {
                    weights[r] = {0.5f + static_cast<float>(r), static_cast<float>(site), 2};
                    bake::add_site_row(rows, site, 0, {weights[r][0], weights[r][1], weights[r][2]},
                                       alone[r]);
                }
                sum.add(rows, site, weights);
            }
            // The last row twice in the first term, each row in the term of its number.
            std::vector<float> values(count * bands * kTexels);
            const bake::DenseRow dense{values, 0, count, bands};
            std::vector<bake::SiteRowSum::Share> shares(count + 1);
            for (std::uint32_t r = 0; r < count; ++r) {
                shares[r].term = r;
                shares[r].of_row[r] = 1;
            }
            shares[count].of_row[count - 1] = 2;
            sum.add_to(shares, dense);
            for (std::uint32_t r = 0; r < count; ++r) {
                for (std::uint32_t b = 0; b < bands; ++b) {
                    for (std::size_t k = 0; k < kTexels; ++k) {
                        const float last = alone[count - 1][step * k + b];
                        EXPECT_EQ(sum.at(r, k, b), alone[r][step * k + b]);
                        EXPECT_EQ(dense.plane(r, b)[k],
                                  alone[r][step * k + b] + (r == 0 ? 2 * last : 0))
                            << bands << " bands, row " << r << " of " << count;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace opaline::tests
