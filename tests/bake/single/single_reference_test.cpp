#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "tests/bake/single/grey_medium.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

constexpr const char* kTable = "translucency.csv";
using tests::grey;
using tests::kIsotropic;

Interface<double> interface_of(const tests::ReferenceRow& row) {
    const auto jacobian = row.input.find("jac");
    return {row.number("eta"), jacobian == row.input.end() || jacobian->second == "exact"};
}

// T_1 of a sphere at a point whose normal makes the given cosine with the light: isotropic, the
// path inside by the chord to the sphere.
double sphere(const tests::ReferenceRow& row, const PathRule& rule, double sigma_m) {
    const Interface<double> side = interface_of(row);
    const double radius = row.number("radius"), sigma_s = row.number("sigma_s");
    const double sigma_t = sigma_s + row.number("sigma_a");
    double sum = 0;
    for (const PathNode& node :
         place_path_nodes(rule, grey(sigma_s, sigma_t, sigma_m), 2 * radius)) {
        const double r = radius - node.depth;  // signed distance from the centre along the normal
        const double along = r * row.number("cos_light");
        const double chord = std::sqrt(along * along + (radius - r) * (radius + r)) - along;
        const Entry<double> e = enter((along + chord) / radius, side);
        sum +=
            node.weight[0] * kIsotropic * e.throughput * std::exp(-sigma_t * chord * e.path_ratio);
    }
    return sum;
}

template <class Value>
void expect_rows(const char* check, Value&& value) {
    OPALINE_REFERENCE_ROWS(rows, kTable, check);
    for (const auto& row : rows) {
        EXPECT_NEAR(value(row), row.expected, row.tolerance()) << row.name();
    }
}

PathRule midpoints(const tests::ReferenceRow& row) {
    return make_midpoint_rule(static_cast<std::uint32_t>(row.number("N")));
}

TEST(SingleReference, EntryAndMidpoints) {
    expect_rows("refracted_cos", [](const auto& row) {
        return enter(row.number("cos_i"), interface_of(row)).refracted_cosine;
    });
    // The path keeps its depth below the tangent plane.
    expect_rows("refracted_path", [](const auto& row) {
        return row.number("s_i") * enter(row.number("cos_i"), interface_of(row)).path_ratio;
    });
    expect_rows("ss_jacobian", [](const auto& row) {
        const double eta = row.number("eta"), c = row.number("cos_i");
        // The ratio of both forms of the throughput.
        return enter(c, Interface<double>{eta, true}).throughput /
               enter(c, Interface<double>{eta, false}).throughput;
    });
    const auto nodes = [](const auto& row) {
        return place_path_nodes(midpoints(row), grey(1, 1, row.number("sigma_m")),
                                row.number("d_m"));
    };
    expect_rows("ss16_s_first", [&](const auto& row) { return nodes(row).front().depth; });
    expect_rows("ss16_s_last", [&](const auto& row) { return nodes(row).back().depth; });
}

// int_0^d sigma_s e^{-2 sigma_t s} ds: a slab seen and lit along its normal, eta = 1.
double slab(const PathRule& rule, const PathMedium& medium, double length) {
    double sum = 0;
    for (const PathNode& node : place_path_nodes(rule, medium, length)) {
        sum += node.weight[1] * std::exp(-medium.sigma_t[1] * node.depth);
    }
    return sum;
}

TEST(SingleReference, SlabByMidpointsAndByGauss) {
    expect_rows("ss16_slab", [](const auto& row) {
        return slab(midpoints(row),
                    grey(row.number("sigma_s"), row.number("sigma_t"), row.number("sigma_m")),
                    row.number("d_m"));
    });
    expect_rows("ss_slab_true", [](const auto& row) {
        return slab(make_gauss_rule(8),
                    grey(row.number("sigma_s"), row.number("sigma_t"), row.number("sigma_t")),
                    row.number("d_m"));
    });
}

// Exitance over incident flux of a half space under uniform light: the view path integrated along
// the refracted direction, 1/(1 + mu_o'/mu_i') per unit albedo, both cosines over the hemisphere.
TEST(SingleReference, HalfSpaceReflectancePerAlbedo) {
    const PathRule gauss = make_gauss_rule(200);
    expect_rows("ss_halfspace_reflectance_per_albedo", [&](const auto& row) {
        const Interface<double> side = interface_of(row);
        const Interface<double> plain{side.eta, false};
        double sum = 0;
        for (std::size_t i = 0; i < gauss.position.size(); ++i) {
            const double mu_i = gauss.position[i];
            const Entry<double> in = enter(mu_i, side);
            for (std::size_t o = 0; o < gauss.position.size(); ++o) {
                const double mu_o = gauss.position[o];
                const Entry<double> out = enter(mu_o, plain);
                const double a = in.refracted_cosine, b = out.refracted_cosine;
                sum += gauss.weight[i] * gauss.weight[o] * in.throughput * out.throughput * mu_o *
                       a / (a + b);
            }
        }
        // 2 pi per hemisphere, twice, by pi incident.
        return sum * 2 * std::numbers::pi * 2 * std::numbers::pi * kIsotropic / std::numbers::pi;
    });
}

TEST(SingleReference, SphereByFineQuadratureAndByTheSixteenPointsOfThePaper) {
    const PathRule fine = make_gauss_rule(1000);
    expect_rows("sphere_T1", [&](const auto& row) { return sphere(row, fine, 0); });
    expect_rows("sphere_T1_16",
                [](const auto& row) { return sphere(row, midpoints(row), row.number("sigma_m")); });
}

}  // namespace
}  // namespace opaline::bake
