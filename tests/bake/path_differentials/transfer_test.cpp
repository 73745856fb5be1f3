#include "tests/bake/path_differentials/transfer.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::moved;
using tests::Vector;

TEST(Transfer, ToAPlaneIsADerivative) {
    tests::RandomInputs random(4);
    tests::ColumnErrors ends, lengths;
    double off_plane = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 P = random.vector(2), N = random.unit();
        const glm::dvec3 D = -random.unit_facing(N, 0.1), dP = random.vector(0.2);
        const glm::dvec3 dD = random.change_of(D, 0.5);
        const double t = random.uniform(0.1, 5);
        const glm::dvec3 Q = P + t * D;
        const TransferChange change = transfer_to_plane(D, N, t, dP, dD);
        const auto distance = [&](auto x) {
            using S = decltype(x);
            return tests::plane_distance<S>(moved(P, dP, x), moved(D, dD, x), N, Q);
        };
        ends.add([&](auto x) { return moved(P, dP, x) + distance(x) * moved(D, dD, x); },
                 change.dP);
        lengths.add([&](auto x) { return tests::alone(distance(x)); },
                    tests::alone_column(change.dt));
        off_plane =
            std::max(off_plane, std::abs(glm::dot(N, change.dP)) / (1e-3 + glm::length(change.dP)));
    }
    tests::expect_derivatives(ends);
    tests::expect_derivatives(lengths, 1e-11);
    EXPECT_LT(off_plane, 1e-12);
}

TEST(Transfer, ToASphereNeedsItsTangentPlaneAlone) {
    tests::RandomInputs random(5);
    tests::ColumnErrors errors;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 center = random.vector(), N = random.unit();
        const double radius = random.uniform(0.5, 2), t = random.uniform(0.5, 3);
        const glm::dvec3 D = -random.unit_facing(N, 0.2), P = center + radius * N - t * D;
        const glm::dvec3 dP = random.vector(0.2), dD = random.change_of(D, 0.5);
        errors.add(
            [&](auto x) {
                using S = decltype(x);
                const Vector<S> from = moved(P, dP, x), along = moved(D, dD, x);
                return from + tests::sphere_distance<S>(from, along, center, radius) * along;
            },
            transfer_to_plane(D, N, t, dP, dD).dP);
    }
    tests::expect_derivatives(errors, 1e-11);
}

TEST(Transfer, ConnectionsAreDerivatives) {
    tests::RandomInputs random(6);
    tests::ColumnErrors directions, lengths;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 X = random.vector(), Y = X + random.uniform(0.3, 3) * random.unit();
        const glm::dvec3 dX = random.vector(), dY = random.vector();
        const Connection segment = connect(X, Y);
        const auto between = [&](auto x) { return moved(Y, dY, x) - moved(X, dX, x); };
        directions.add([&](auto x) { return tests::normalized(between(x)); },
                       segment.direction_change(dX, dY));
        lengths.add([&](auto x) { return tests::alone(tests::length(between(x))); },
                    tests::alone_column(segment.length_change(dX, dY)));
        EXPECT_LT(std::abs(glm::dot(segment.D, segment.direction_change(dX, dY))), 1e-12 * 20);
    }
    tests::expect_derivatives(directions, 1e-11);
    tests::expect_derivatives(lengths, 1e-11);
}

TEST(Transfer, InAVolumeKeepsTheChangeAlongTheRay) {
    const glm::dvec3 D(0, 0, 1);
    const glm::dvec3 dP = transfer_in_volume(D, 2, 0.5, {1, 0, 0}, {0, 3, 0});
    EXPECT_EQ(dP, glm::dvec3(1, 6, 0.5));
}

}  // namespace
}  // namespace opaline::bake
