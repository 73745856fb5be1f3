// Which samples of a picture see a surface that light passes in places.
#include "runtime/surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opaline::runtime {
namespace {

using formats::HoleMode;
using formats::HoleRecord;

TEST(Holes, AMaskIsThereWhereAlphaReachesItsCutoff) {
    const HoleRecord mask{.cutoff = 0.5f};
    EXPECT_TRUE(sees_surface(mask, 0.5f, {3, 4, 5}));
    EXPECT_FALSE(sees_surface(mask, 0.4999f, {3, 4, 5}));
    EXPECT_FALSE(sees_surface({.cutoff = 1.5f}, 1, {}));
}

TEST(Holes, AlphaOfABlendIsTheShareOfTheSamplesOfAnySquare) {
    const HoleRecord blend{.mode = HoleMode::blend};
    for (const float alpha : {0.0f, 0.1f, 0.5f, 0.77f, 1.0f}) {
        for (const std::uint32_t size : {6u, 12u, 48u}) {
            for (const std::uint32_t first : {0u, 1000u, 100001u}) {
                int seen = 0;
                for (std::uint32_t i = 0; i < size * size; ++i) {
                    seen += sees_surface(blend, alpha, {first + i % size, i / size, 7}) ? 1 : 0;
                }
                // Far less than the 0.5 / size of samples drawn at random.
                EXPECT_NEAR(seen / double(size * size), alpha, 1.3 / (size * std::sqrt(size)))
                    << alpha << " " << size;
            }
        }
    }
}

TEST(Holes, OfTwoSurfacesBehindEachOtherAreIndependentOnAverage) {
    const HoleRecord blend{.mode = HoleMode::blend};
    int both = 0;
    for (std::uint32_t vertex = 0; vertex < 64; ++vertex) {
        for (std::uint32_t i = 0; i < 900; ++i) {
            const std::uint32_t column = i % 30, row = i / 30;
            both += sees_surface(blend, 0.5f, {column, row, 1000}) &&
                            sees_surface(blend, 0.5f, {column, row, vertex})
                        ? 1
                        : 0;
        }
    }
    EXPECT_NEAR(both / (64 * 900.0), 0.25, 0.01);
}

TEST(Holes, AlphaIsTheProductOfRecordVertexAndImage) {
    formats::AssetView asset;
    const std::uint8_t pixels[]{51, 0, 0, 255, 0, 0};
    asset.images.push_back({2, 1, pixels});
    HoleRecord hole{.alpha = 0.5f};
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0, 0}, 0.5f), 0.25f);
    hole.image = 0;
    hole.wrap_u = formats::Wrap::clamp;
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0, 0.5f}, 0.5f), 0.05f);
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0.5f, 0.5f}, 1), 0.3f);
}

}  // namespace
}  // namespace opaline::runtime
