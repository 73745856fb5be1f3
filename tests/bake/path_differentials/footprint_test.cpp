#include "bake/physics/path_differentials/footprint.h"

#include <numbers>

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

glm::dvec2 random_normal(tests::RandomInputs& random) {
    const double r = std::sqrt(-2 * std::log(1 - random.uniform()));
    const double phi = 2 * std::numbers::pi * random.uniform();
    return {r * std::cos(phi), r * std::sin(phi)};
}

/// Normally distributed in both coordinates, of sizes whose logarithm is normal with deviation 0.7.
std::vector<glm::dvec2> random_set(tests::RandomInputs& random, std::size_t count) {
    std::vector<glm::dvec2> vectors(count);
    for (glm::dvec2& v : vectors) {
        v = std::exp(0.7 * random_normal(random).x) * random_normal(random);
    }
    return vectors;
}

// 1500 random sets, minimum and mean of area over the polygon's, as an independent program measured
// them. Its distribution is not known: sizes as above have the same means.
TEST(Footprint, RepresentativesHaveTheSharesOfTheAreaThatWereMeasured) {
    struct Row {
        std::size_t count;
        double best, rms;
    };
    for (const Row& row : {Row{3, 0.893, 0.710}, Row{6, 0.790, 0.394}, Row{12, 0.731, 0.215}}) {
        tests::RandomInputs random(30);
        double best = 0, rms = 0;
        const int sets = 1500;
        for (int i = 0; i < sets; ++i) {
            const auto vectors = random_set(random, row.count);
            const double area = polygon_area(vectors), share = pair_area(best_pair(vectors)) / area;
            best += share;
            rms += pair_area(rms_pair(vectors)) / area;
            EXPECT_GE(share, 0.6366);
        }
        EXPECT_NEAR(best / sets, row.best, 0.01);
        EXPECT_NEAR(rms / sets, row.rms, 0.01);
    }
}

TEST(Footprint, OfTwoVectorsAllRulesAgree) {
    tests::RandomInputs random(31);
    for (int i = 0; i < 1000; ++i) {
        const auto vectors = random_set(random, 2);
        const double area = polygon_area(vectors);
        for (const FootprintPair& pair :
             {best_pair(vectors), rms_pair(vectors), polygon_pair(vectors)}) {
            EXPECT_NEAR(pair_area(pair), area, 1e-12 * area + 1e-15);
        }
    }
}

TEST(Footprint, PolygonPairHasTheExactAreaWhateverOrderAndSigns) {
    tests::RandomInputs random(32);
    for (int i = 0; i < 1000; ++i) {
        auto vectors = random_set(random, 7);
        const double area = polygon_area(vectors), best = pair_area(best_pair(vectors));
        const PairExtent rms = pair_extent(rms_pair(vectors));
        EXPECT_NEAR(pair_area(polygon_pair(vectors)), area, 1e-12 * area);
        std::swap(vectors[0], vectors[5]);
        vectors[3] = -vectors[3];
        vectors[1] = -vectors[1];
        EXPECT_NEAR(pair_area(best_pair(vectors)), best, 1e-12 * area);
        EXPECT_NEAR(pair_extent(rms_pair(vectors)).minor, rms.minor, 1e-12 * rms.major);
    }
}

// Hard case: three vectors 120 degrees apart, whose sum is 0.
TEST(Footprint, SignsThatCancelDoNotMatter) {
    const double h = std::sqrt(3.0) / 2;
    const std::vector<glm::dvec2> star{{1, 0}, {-0.5, h}, {-0.5, -h}};
    const double area = polygon_area(star);  // a regular hexagon of side 1
    EXPECT_NEAR(area, 3 * h, 1e-15);
    EXPECT_GE(pair_area(best_pair(star)), 2 / std::numbers::pi * area);
    const PairExtent round = pair_extent(rms_pair(star));
    EXPECT_NEAR(round.major, round.minor, 1e-7);
}

// Hard case: all vectors along the axes of coordinates, or on the line that splits.
TEST(Footprint, VectorsAlongTheSplittingLineAreNotLost) {
    const std::vector<glm::dvec2> cross{{2, 0}, {0, 1}, {-1, 0}, {0, -3}};
    EXPECT_NEAR(pair_area(polygon_pair(cross)), 12, 1e-14);
    EXPECT_NEAR(pair_area(best_pair(cross)), 12, 1e-14);
    const std::vector<glm::dvec2> upright{{0, 2}, {1, 0}, {-1, 0}};
    EXPECT_NEAR(polygon_area(upright), 4, 1e-15);
    EXPECT_NEAR(pair_area(polygon_pair(upright)), 4, 1e-14);
}

// Hard case: no columns, columns of 0.
TEST(Footprint, WithoutVectorsIsAPoint) {
    for (const std::vector<glm::dvec2>& none :
         {std::vector<glm::dvec2>{}, {glm::dvec2(0), glm::dvec2(0)}}) {
        EXPECT_EQ(polygon_area(none), 0);
        for (const FootprintPair& pair : {best_pair(none), polygon_pair(none), rms_pair(none)}) {
            EXPECT_EQ(pair.A, glm::dvec2(0));
            EXPECT_EQ(pair.B, glm::dvec2(0));
            EXPECT_EQ(pair_extent(pair).minor, 0);
        }
    }
}

// Hard case: a line has its length and no width, and nothing is divided by that.
TEST(Footprint, ParallelColumnsAreALine) {
    const std::vector<glm::dvec2> line{{1, 2}, {-2, -4}, {0.5, 1}};
    const PairExtent worst = pair_extent(polygon_pair(line));
    EXPECT_NEAR(worst.major, 3.5 * std::sqrt(5.0), 1e-13);
    EXPECT_EQ(worst.minor, 0);
    const PairExtent rms = pair_extent(rms_pair(line));
    EXPECT_NEAR(rms.major, std::sqrt(5.25 * 5), 1e-13);
    EXPECT_EQ(rms.minor, 0);
}

}  // namespace
}  // namespace opaline::bake
