#include "tests/bake/path_differentials/path_gradient.h"

#include "tests/bake/path_differentials/event_check.h"
#include "tests/bake/path_differentials/transfer.h"

namespace opaline::bake {
namespace {

using tests::alone;
using tests::alone_column;
using tests::moved;

TEST(PathGradient, CosinesAndLobesAreLogarithmicDerivatives) {
    tests::RandomInputs random(25);
    tests::ColumnErrors cosines, powers, phases;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 N = random.unit(), D = random.unit_facing(N, 0.1);
        const glm::dvec3 dN = random.change_of(N), dD = random.change_of(D);
        const double S_ = random.uniform(1, 60), g = random.uniform(-0.9, 0.9);
        const auto cosine = [&](auto x) { return tests::dot(moved(N, dN, x), moved(D, dD, x)); };
        using std::log;
        cosines.add([&](auto x) { return alone(log(cosine(x))); },
                    alone_column(dln_cosine(N, D, dN, dD)));
        powers.add([&](auto x) { return alone(decltype(x)(S_) * log(cosine(x))); },
                   alone_column(dln_power(N, D, S_, dN, dD)));
        phases.add(
            [&](auto x) {
                using S = decltype(x);
                return alone(S(-1.5) * log(S(1 + g * g) - S(2 * g) * cosine(x)));
            },
            alone_column(
                dln_henyey_greenstein(g, glm::dot(N, D), glm::dot(dN, D) + glm::dot(N, dD))));
    }
    tests::expect_derivatives(cosines, 1e-10);
    tests::expect_derivatives(powers, 1e-10);
    tests::expect_derivatives(phases, 1e-10);
}

TEST(PathGradient, MicrofacetsAreLogarithmicDerivatives) {
    tests::RandomInputs random(26);
    tests::ColumnErrors lobes;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 N = random.unit(), in = random.unit_facing(N, 0.1);
        const glm::dvec3 out = random.unit_facing(N, 0.1), dN = random.change_of(N);
        const DirectionPair pair{in, out, random.change_of(in), random.change_of(out)};
        const double alpha = random.uniform(0.1, 1);
        const auto ln = [&](auto x) {
            using S = decltype(x);
            return alone(tests::ln_microfacet<S>(moved(N, dN, x), moved(in, pair.din, x),
                                                 moved(out, pair.dout, x), alpha));
        };
        lobes.add([&](auto x) { return ln(x); }, alone_column(dln_microfacet(N, dN, pair, alpha)));
    }
    tests::expect_derivatives(lobes, 1e-9);
}

TEST(PathGradient, GeometryIsTwoCosinesAndADistance) {
    tests::RandomInputs random(27);
    tests::ColumnErrors errors;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 X = random.vector(), D = random.unit();
        const glm::dvec3 Y = X + random.uniform(0.5, 3) * D;
        const glm::dvec3 NX = random.unit_facing(D, 0.2), NY = -random.unit_facing(D, 0.2);
        const glm::dvec3 dX = random.vector(0.5), dY = random.vector(0.5);
        const glm::dvec3 dNX = random.change_of(NX), dNY = random.change_of(NY);
        const Connection segment = connect(X, Y);
        const glm::dvec3 dD = segment.direction_change(dX, dY);
        const double dr = segment.length_change(dX, dY);
        errors.add(
            [&](auto x) {
                using S = decltype(x);
                using std::log, std::abs;
                const tests::Vector<S> d = moved(Y, dY, x) - moved(X, dX, x);
                const S r2 = tests::dot(d, d);
                // cos cos' / r^2 = (N.d)(N'.d) / r^4
                return alone(log(abs(tests::dot(moved(NX, dNX, x), d))) +
                             log(abs(tests::dot(moved(NY, dNY, x), d))) - S(2) * log(r2));
            },
            alone_column(dln_geometry(dln_cosine(NX, segment.D, dNX, dD),
                                      dln_cosine(NY, segment.D, dNY, dD), segment.r, dr)));
    }
    tests::expect_derivatives(errors, 1e-9);
}

// Hard case: 1 / cos at grazing angles and on the horizon.
TEST(PathGradient, GrazingCosinesAreClamped) {
    const glm::dvec3 N(0, 0, 1), dD(0, 0, 1);
    for (const double c : {1e-3, 1e-5, 1e-9, 0.0, -1e-9}) {
        const double ell = dln_cosine(N, {std::sqrt(1 - c * c), 0, c}, glm::dvec3(0), dD);
        EXPECT_LE(std::abs(ell), 1e4 * (1 + 1e-12)) << c;
        EXPECT_GE(0.7 / std::abs(ell), 7e-5 * (1 - 1e-12)) << c;  // a finite step is left
    }
}

}  // namespace
}  // namespace opaline::bake
