#include <numbers>
#include <vector>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/footprint.h"
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

/// Columns at a vertex: dP in the plane of N_g, or anywhere; dD perpendicular to D.
std::vector<DifferentialColumn> random_columns(tests::RandomInputs& random, const MergeSpace& space,
                                               std::size_t count) {
    std::vector<DifferentialColumn> columns(count);
    for (DifferentialColumn& column : columns) {
        column.dP = space.N_g ? random.change_of(*space.N_g) : random.vector();
        column.dD = random.change_of(space.D);
        column.dlnW = random.uniform(-3, 3);
    }
    return columns;
}

MergeSpace random_surface(tests::RandomInputs& random) {
    const glm::dvec3 N = random.unit();
    return {random.unit_facing(N, 0.1), N};
}

/// A random linear map of (dP, dD, dlnW) to the plane, as all later events are one.
struct LaterEvents {
    glm::dmat3 position{0.0}, direction{0.0};
    glm::dvec3 gradient{0};

    glm::dvec2 vector(const DifferentialColumn& column, double step) const {
        return glm::dvec2(step *
                          (position * column.dP + direction * column.dD + gradient * column.dlnW));
    }
};

LaterEvents random_events(tests::RandomInputs& random) {
    const auto matrix = [&] {
        return glm::dmat3(random.vector(), random.vector(), random.vector());
    };
    return {matrix(), matrix(), random.vector()};
}

PairExtent rms_after(const std::vector<DifferentialColumn>& columns,
                     const std::vector<double>& steps, const LaterEvents& events) {
    std::vector<glm::dvec2> vectors;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        vectors.push_back(events.vector(columns[i], steps[i]));
    }
    return pair_extent(rms_pair(vectors));
}

/// Largest relative change of later rms footprints by merging.
double merging_error(tests::RandomInputs& random, const MergeSpace& space,
                     std::vector<DifferentialColumn> columns) {
    std::vector<double> steps;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        steps.push_back(random.uniform(0.01, 1));
    }
    const std::vector<DifferentialColumn> before = columns;
    columns.resize(merge_columns(columns, steps, space));
    EXPECT_LE(columns.size(), space.N_g ? 5u : 6u);
    double error = 0;
    for (int k = 0; k < 4; ++k) {
        const LaterEvents events = random_events(random);
        const PairExtent old = rms_after(before, steps, events);
        const PairExtent now = rms_after(columns, std::vector<double>(columns.size(), 1.0), events);
        error = std::max({error, std::abs(now.major / old.major - 1),
                          std::abs(now.minor - old.minor) / old.major});
    }
    return error;
}

TEST(MergeColumns, KeepEveryLaterRmsFootprint) {
    tests::RandomInputs random(36);
    double surface = 0, volume = 0;
    for (int i = 0; i < 1000; ++i) {
        const MergeSpace on = random_surface(random), in{random.unit(), std::nullopt};
        surface = std::max(surface, merging_error(random, on, random_columns(random, on, 10)));
        volume = std::max(volume, merging_error(random, in, random_columns(random, in, 10)));
    }
    EXPECT_LT(surface, 1e-12);
    EXPECT_LT(volume, 1e-12);
}

TEST(MergeColumns, OfFewIndependentOnesAreNoMoreThanThese) {
    tests::RandomInputs random(37);
    for (int i = 0; i < 100; ++i) {
        const MergeSpace space = random_surface(random);
        auto columns = random_columns(random, space, 3);
        for (std::size_t k = 0; k < 4; ++k) {  // combinations of the first three
            const double a = random.uniform(-1, 1), b = random.uniform(-1, 1);
            columns.push_back({a * columns[0].dP + b * columns[1].dP + columns[2].dP,
                               a * columns[0].dD + b * columns[1].dD + columns[2].dD,
                               a * columns[0].dlnW + b * columns[1].dlnW + columns[2].dlnW, 1});
        }
        EXPECT_LT(merging_error(random, space, columns), 1e-7);
        auto merged = columns;
        const std::vector<double> steps(merged.size(), 0.5);
        EXPECT_EQ(merge_columns(merged, steps, space), 3u);
    }
}

// Positions of kilometres and directions of nanoradians are of one path.
TEST(MergeColumns, SmallDirectionsDoNotDrownInLargePositions) {
    tests::RandomInputs random(38);
    const MergeSpace space = random_surface(random);
    auto columns = random_columns(random, space, 8);
    double before = 0, after = 0;
    for (DifferentialColumn& column : columns) {
        column.dP *= 1e4;
        column.dD *= 1e-10;
        before += glm::dot(column.dD, column.dD);
    }
    const std::vector<double> steps(columns.size(), 1.0);
    columns.resize(merge_columns(columns, steps, space));
    for (const DifferentialColumn& column : columns) {
        after += glm::dot(column.dD, column.dD);
        EXPECT_LT(std::abs(glm::dot(column.dD, space.D)), 1e-12 * glm::length(column.dD) + 1e-30);
        EXPECT_LT(std::abs(glm::dot(column.dP, *space.N_g)), 1e-8);
    }
    EXPECT_NEAR(after / before, 1, 1e-12);
}

TEST(MergeColumns, NothingMergesToNothing) {
    std::vector<DifferentialColumn> columns(7);
    const std::vector<double> steps(columns.size(), 1.0);
    EXPECT_EQ(merge_columns(columns, steps, {{0, 0, 1}, glm::dvec3(0, 0, 1)}), 0u);
}

}  // namespace

}  // namespace opaline::bake
