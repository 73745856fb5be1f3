#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/single/ray_single.h"
#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "tests/bake/single/grey_medium.h"
#include "tests/bake/single/single_support.h"
#include "tests/support/reference_table.h"
#include "tests/support/touching_bodies.h"

namespace opaline::bake {
namespace {

using tests::gather;
using tests::make_grey_medium;
using tests::make_translucent_scene;
using tests::set_up;
using tests::vertex_at;

using tests::kIsotropic;

// Smooth in s, so that the reference's own quadrature error does not matter.
void use_fine_quadrature(SingleMedium& medium, bool jacobian) {
    medium.rule = make_gauss_rule(300);
    medium.path.sigma_m = 0;
    medium.boundary.jacobian = jacobian;
}

TEST(RaySingle, TessellatedSphereAgreesWithTheAnalyticOneWithin1Percent) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "sphere_T1");
    for (const auto& row : rows) {
        auto setup = set_up(make_translucent_scene(
            {tests::make_sphere(6, static_cast<float>(row.number("radius")))},
            make_grey_medium(static_cast<float>(row.number("sigma_s")),
                             static_cast<float>(row.number("sigma_a")),
                             static_cast<float>(row.number("eta")))));
        use_fine_quadrature(setup.medium, row.input.at("jac") == "exact");
        double sum = 0;
        const std::size_t points[] = {0, 5, 11, 100, 1000, 7777};
        for (const std::size_t p : points) {
            const auto cone = tests::make_cone(setup.points[p].normal, row.number("cos_light"));
            sum += gather(setup, cone, p)[0] / 6.0;
        }
        EXPECT_NEAR(sum, row.expected, row.tolerance_or(0.01)) << row.name();
    }
}

TEST(RaySingle, WideSlabIsAHalfSpace) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "ss_plane_T1");
    for (const auto& row : rows) {
        // A cube 60 mean free paths wide: its faces are effectively at infinity.
        const double sigma_t = row.number("sigma_t"), sigma_s = row.number("sigma_s");
        auto setup = set_up(make_translucent_scene(
            {tests::transformed(tests::make_cube(2, false), glm::mat3(1),
                                static_cast<float>(200 / sigma_t), glm::vec3(0))},
            make_grey_medium(static_cast<float>(sigma_s), static_cast<float>(sigma_t - sigma_s),
                             static_cast<float>(row.number("eta")))));
        use_fine_quadrature(setup.medium, row.input.at("jac") == "exact");
        const std::size_t middle = vertex_at(setup, {0, static_cast<float>(200 / sigma_t), 0});
        const auto cone = tests::make_cone({0, 1, 0}, row.number("cos_i"));
        // Only rounding: coefficients are floats, and so is the sum.
        EXPECT_NEAR(gather(setup, cone, middle)[0], row.expected, row.tolerance_or(3e-5))
            << row.name();
    }
}

TEST(RaySingle, TransportIsTheMeanOverEachTexel) {
    const auto setup =
        set_up(make_translucent_scene({tests::make_sphere(5)}, make_grey_medium(0.8f, 0.1f, 1.3f)));
    const DirectionSet directions = make_direction_set(8);
    const std::size_t point = 321;
    const auto transport = gather(setup, directions, point);
    // The same nodes on the analytic sphere.
    std::vector<double> expected(384);
    double largest = 0;
    const auto nodes = place_path_nodes(setup.medium.rule, setup.medium.path, 2.0);
    const auto shares = texel_shares(directions);
    for (std::size_t b = 0; b < shares.size(); ++b) {
        const DirectionBlock& block = directions.blocks[b];
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::dvec3 w(block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]);
            const double cos_light = glm::dot(w, glm::dvec3(setup.points[point].normal));
            for (const PathNode& node : nodes) {
                const double r = 1 - node.depth, along = r * cos_light;
                const double chord = std::sqrt(along * along + (1 - r) * (1 + r)) - along;
                const Entry<double> e = enter(along + chord, Interface<double>{1.3f, true});
                expected[block.texel[lane]] += shares[b][lane] * kIsotropic * node.weight[0] *
                                               e.throughput *
                                               std::exp(-0.9f * chord * e.path_ratio);
            }
        }
    }
    for (const double value : expected) {
        largest = std::max(largest, value);
    }
    for (std::size_t j = 0; j < 384; ++j) {
        EXPECT_NEAR(transport[j], expected[j], 0.01 * largest) << j;
    }
}

TEST(RaySingle, OpaqueThingsBlockLightBothOutsideAndInside) {
    const DirectionSet directions = make_direction_set(8);
    const auto medium = make_grey_medium(1, 0.1f);
    auto lid = tests::make_cube(1, true);
    lid.material = 1;
    for (glm::vec3& v : lid.position) {
        v *= 3.0f;  // a closed box around the body
    }
    auto core = tests::make_sphere(2, 0.5f);
    core.material = 1;
    const auto free = set_up(make_translucent_scene({tests::make_sphere(4)}, medium));
    const auto boxed = set_up(make_translucent_scene({tests::make_sphere(4), lid}, medium));
    const auto cored = set_up(make_translucent_scene({tests::make_sphere(4), core}, medium));
    const auto expected = gather(free, directions, 0);
    EXPECT_EQ(tests::dot_one(gather(boxed, directions, 0), directions), glm::dvec3(0));
    const auto with_core = gather(cored, directions, 0);
    const double total = tests::dot_one(expected, directions).x;
    const double left = tests::dot_one(with_core, directions).x;
    EXPECT_LT(left, 0.99 * total);
    EXPECT_GT(left, 0.3 * total);
    for (std::size_t j = 0; j < expected.size(); ++j) {
        EXPECT_LE(with_core[j], expected[j]);
    }
}

TEST(RaySingle, AnotherLimbOfTheBodyBlocksLight) {
    // Two cubes of one medium, one above the other: the lower one gets no light from straight
    // above.
    const auto lower = tests::make_cube(2, false);
    const auto upper = tests::transformed(lower, glm::mat3(1), 3, {0, 6, 0});
    const auto setup = set_up(make_translucent_scene({lower, upper}, make_grey_medium(1, 0.1f)));
    const std::size_t top = vertex_at(setup, {0, 1, 0});
    EXPECT_EQ(gather(setup, tests::make_cone({0, 1, 0}, 0.99), top)[0], 0);
    EXPECT_GT(gather(setup, tests::make_cone({0, 1, 0}, 0.1), top)[0], 0);
}

TEST(RaySingle, AShellOfTheSameMediumInsideIsNotABoundary) {
    const DirectionSet directions = make_direction_set(8);
    const auto medium = make_grey_medium(1, 0.1f);
    const auto outer = tests::make_sphere(4);
    const auto alone = set_up(make_translucent_scene({outer}, medium));
    const auto nested = set_up(
        make_translucent_scene({outer, tests::make_sphere(2, 0.6f, {0.1f, 0.05f, 0})}, medium));
    for (const std::size_t p : {0u, 17u, 900u}) {
        const auto a = gather(alone, directions, p), b = gather(nested, directions, p);
        for (std::size_t j = 0; j < a.size(); ++j) {
            EXPECT_EQ(a[j], b[j]) << p << ' ' << j;
        }
    }
    const auto path = trace_inward_path(nested.rays, nested.points[0], 100);
    EXPECT_TRUE(path.nested);
    EXPECT_NEAR(path.length, 2, 0.01);
}

// Inward normals of some vertices of the outer faces run along the inner walls, where a ray meets
// one wall of two. Such a cup of glass was black there.
TEST(RaySingle, JustInsideACupOneShellIsAroundEveryVertex) {
    const auto cup = set_up(make_translucent_scene({tests::make_cup()}, make_grey_medium(0, 0.1f)));
    for (const BodyPoint& point : cup.points) {
        EXPECT_EQ(shells_at(trace_inward_path(cup.rays, point, 100), 0), 1)
            << point.position.x << ' ' << point.position.y << ' ' << point.position.z;
    }
}

TEST(RaySingle, HolesAreCountedAndDark) {
    auto body = tests::make_cube(2, false);
    const auto closed = set_up(make_translucent_scene({body}, make_grey_medium(1, 0.1f)));
    body.index.resize(body.index.size() * 5 / 6);  // the +z side
    const auto open = set_up(make_translucent_scene({body}, make_grey_medium(1, 0.1f)));
    EntryCounts counts;
    const DirectionSet directions = make_direction_set(8);
    gather(closed, directions, 0, &counts);
    EXPECT_EQ(counts.missing, 0u);
    // Amid the -z side, looking through the hole.
    const std::size_t opposite = vertex_at(open, {0, 0, -1});
    const auto transport = gather(open, directions, opposite, &counts);
    EXPECT_GT(counts.missing, 0u);
    EXPECT_GT(tests::dot_one(transport, directions).x, 0);
    const auto path = trace_inward_path(open.rays, open.points[opposite], 5);
    EXPECT_TRUE(path.open);
    EXPECT_EQ(path.length, 5);
    for (const float value : transport) {
        EXPECT_TRUE(std::isfinite(value) && value >= 0);
    }
}

TEST(RaySingle, NormalsThatPointIntoTheBodyGatherNothing) {
    auto body = tests::make_cube(1, false);
    for (glm::vec3& normal : body.normal) {
        normal = -normal;
    }
    const auto setup = set_up(make_translucent_scene({body}, make_grey_medium(1, 0.1f)));
    const DirectionSet directions = make_direction_set(8);
    EXPECT_EQ(tests::dot_one(gather(setup, directions, 0), directions), glm::dvec3(0));
}

TEST(RaySingle, InwardPathOfASphereIsItsDiameter) {
    const auto setup =
        set_up(make_translucent_scene({tests::make_sphere(5)}, make_grey_medium(1, 0.1f)));
    for (const BodyPoint& point : setup.points) {
        const InwardPath path = trace_inward_path(setup.rays, point, 100);
        EXPECT_FALSE(path.open);
        EXPECT_FALSE(path.nested);
        // The facets lie up to h^2/8 = 1.5e-4 inside.
        ASSERT_NEAR(path.length, 2, 3e-4) << point.position.x << ' ' << point.position.y;
    }
}

constexpr const char* kTable = "translucency.csv";
using tests::grey;

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
