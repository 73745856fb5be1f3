#include "tests/bake/path_differentials/flight_sample.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::alone;
using tests::alone_column;

template <class S>
S textbook_distance(S sigma, S length, S u, bool bounded) {
    using std::exp, std::log;
    const S Q = bounded ? S(1) - exp(S(0) - sigma * length) : S(1);
    return (S(0) - log(S(1) - u * Q)) / sigma;
}

TEST(FlightSample, DistancesAreDerivatives) {
    tests::RandomInputs random(22);
    for (const bool bounded : {false, true}) {
        tests::ColumnErrors own, extinction, length;
        for (int i = 0; i < tests::kRandomCases; ++i) {
            const double sigma = random.uniform(0.1, 2), L = random.uniform(0.2, 2);
            const double u = random.uniform(0.01, 0.98);
            const FlightSample at =
                bounded ? sample_bounded_distance(sigma, L, u) : sample_flight_distance(sigma, u);
            const auto t = [&](auto ds, auto dL, auto du) {
                using S = decltype(ds + dL + du);
                return alone(textbook_distance<S>(S(sigma) + ds, S(L) + dL, S(u) + du, bounded));
            };
            own.add([&](auto d) { return t(0 * d, 0 * d, d); }, alone_column(at.dt_du));
            extinction.add([&](auto d) { return t(d, 0 * d, 0 * d); }, alone_column(at.dt_dsigma));
            length.add([&](auto d) { return t(0 * d, d, 0 * d); }, alone_column(at.dt_dlength));
        }
        tests::expect_derivatives(own, 1e-11);
        tests::expect_derivatives(extinction, 1e-9);  // the textbook's own cancellation
        tests::expect_derivatives(length, 1e-11);
    }
}

// dt/du times the density of t, sigma e^(-sigma t) or that over Q, is 1.
TEST(FlightSample, StepsSpanTheirPdf) {
    tests::RandomInputs random(23);
    for (int i = 0; i < 1000; ++i) {
        const double sigma = random.uniform(0.01, 5), L = random.uniform(0.2, 4);
        const double u = random.uniform();
        const FlightSample free = sample_flight_distance(sigma, u);
        EXPECT_NEAR(free.dt_du * sigma * std::exp(-sigma * free.t), 1, 1e-12);
        const FlightSample bounded = sample_bounded_distance(sigma, L, u);
        const double Q = -std::expm1(-sigma * L);
        EXPECT_NEAR(bounded.dt_du * sigma * std::exp(-sigma * bounded.t) / Q, 1, 1e-12);
        EXPECT_LE(bounded.t, L * (1 + 1e-15));
    }
}

// Extinction a + k.x: optical depth (a + k.P) t + k.D t^2 / 2, solved for t by dual numbers.
TEST(FlightSample, InAGradientOfExtinctionIsADerivative) {
    tests::RandomInputs random(24);
    tests::ColumnErrors own, older;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 P = random.vector(), D = random.unit(), k = random.vector(0.4);
        const glm::dvec3 dP = random.vector(), dD = random.vector();
        const double a = 3, u = random.uniform(0.02, 0.9);
        const auto distance = [&](auto du, auto x) {
            using S = decltype(du + x);
            using std::log, std::sqrt;
            const tests::Vector<S> from = tests::moved(P, dP, x), along = tests::moved(D, dD, x);
            const S start = S(a) + tests::dot(tests::Vector<S>(k), from);
            const S slope = tests::dot(tests::Vector<S>(k), along);
            const S depth = S(0) - log(S(1) - S(u) - du);
            return alone(S(2) * depth / (start + sqrt(start * start + S(2) * slope * depth)));
        };
        const double t = distance(0.0, 0.0).x;
        const VariedFlight flight{a + glm::dot(k, P + t * D), k * t, k * (t * t / 2)};
        own.add([&](auto d) { return distance(d, 0 * d); }, alone_column(flight.own_change(u)));
        older.add([&](auto d) { return distance(0 * d, d); }, alone_column(flight.change(dP, dD)));
    }
    tests::expect_derivatives(own, 1e-11);
    tests::expect_derivatives(older, 1e-9, 1e-6);
}

// Hard case: small sigma L. In extended precision the difference keeps its digits.
TEST(FlightSample, ThinMediaKeepTheDigitsOfTheirDerivatives) {
    for (const double x : {1e-3, 1.01e-4, 0.99e-4, 1e-5, 1e-8, 1e-12}) {
        for (const double u : {0.05, 0.3, 0.9}) {
            const double L = 2, sigma = x / L;
            const long double X = x, U = u, Q = -std::expm1(-X), one = 1 - U * Q;
            const long double t = -std::log1p(-U * Q) / sigma;
            const FlightSample at = sample_bounded_distance(sigma, L, u);
            EXPECT_NEAR(at.t, static_cast<double>(t), 4e-14) << x;
            EXPECT_NEAR(at.dt_du, static_cast<double>(Q / (sigma * one)), 1e-11) << x;
            if (x > 1e-7) {
                const long double slope = (U * L * std::exp(-X) / one - t) / sigma;
                EXPECT_NEAR(at.dt_dsigma / static_cast<double>(slope), 1, 2e-11) << x;
            } else {
                EXPECT_NEAR(at.dt_dsigma, -L * L * u * (1 - u) / 2, 1e-6) << x;
            }
        }
    }
    const FlightSample empty = sample_bounded_distance(0, 2, 0.3);
    EXPECT_EQ(empty.t, 0.6);
    EXPECT_EQ(empty.dt_du, 2);
}

}  // namespace
}  // namespace opaline::bake
