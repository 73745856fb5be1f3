
#include <vector>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/footprint.h"
#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

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
