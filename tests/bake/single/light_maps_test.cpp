#include "bake/effects/single/light_maps.h"

#include <gtest/gtest.h>

#include "bake/effects/single/gather_direction.h"
#include "bake/effects/single/light_view.h"
#include "tests/bake/single/single_support.h"

namespace opaline::bake {
namespace {

using tests::make_grey_medium;
using tests::make_translucent_scene;
using tests::set_up;
using tests::SingleSetup;

// Smooth lights: constant, and wide lobes from a few sides.
std::vector<std::vector<double>> smooth_lights(const DirectionSet& directions) {
    const std::size_t texels = directions.inverse_solid_angle.size();
    std::vector<std::vector<double>> lights(5, std::vector<double>(texels, 0.0));
    const glm::dvec3 axes[] = {{0, 1, 0}, {0.6, 0, 0.8}, {-0.8, -0.6, 0}, {0, -0.6, -0.8}};
    for (const DirectionBlock& block : directions.blocks) {
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const std::uint32_t j = block.texel[lane];
            const glm::dvec3 w(block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]);
            const double omega = 1.0 / directions.inverse_solid_angle[j];
            lights[0][j] = omega;
            for (std::size_t a = 0; a < 4; ++a) {
                lights[a + 1][j] = omega * std::exp(8 * (glm::dot(w, axes[a]) - 1));
            }
        }
    }
    return lights;
}

// About `count` points of the medium, evenly spaced in the list.
std::vector<BodyPoint> some_points(const SingleSetup& setup, std::size_t count) {
    std::vector<BodyPoint> all, some;
    for (const BodyPoint& point : setup.points) {
        if (point.material == 0) {
            all.push_back(point);
        }
    }
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / count)) {
        some.push_back(all[i]);
    }
    return some;
}

SingleRows gather_all(const SingleSetup& setup, const DirectionSet& directions,
                      std::span<const BodyPoint> points, unsigned threads) {
    const BodyMesh mesh = make_body_mesh(setup.scene, setup.rays, 0, {});
    Context context;
    context.threads = threads;
    return gather_single_rows(setup.rays, mesh, light_view_size(mesh), directions, setup.medium,
                              points, context);
}

// Light maps against rays along the same directions: the worst light's RMS, and the bias of the
// constant one.
void expect_close_to_rays(const SingleSetup& setup, std::size_t count = 150) {
    const DirectionSet directions = make_direction_set(8);
    const auto shares = texel_shares(directions);
    const auto lights = smooth_lights(directions);
    const std::vector<BodyPoint> points = some_points(setup, count);
    const SingleRows maps = gather_all(setup, directions, points, 1);
    const std::uint32_t terms = setup.medium.phase.count();
    std::vector<float> exact(3 * lights[0].size() * terms), fast(exact.size());
    std::vector<double> difference(lights.size(), 0.0), reference(lights.size(), 0.0);
    double sum = 0, sum_exact = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        gather_single(setup.rays, directions, shares, setup.medium, points[p], exact);
        read_packed_row(maps.rows, p, fast);
        // From straight above, the brightest view.
        const std::vector<float> seen = tests::seen_from(exact, terms, points[p].normal);
        const std::vector<float> seen_fast = tests::seen_from(fast, terms, points[p].normal);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            double a = 0, b = 0;
            for (std::size_t j = 0; j < seen.size(); ++j) {
                a += lights[l][j % lights[l].size()] * seen[j];
                b += lights[l][j % lights[l].size()] * seen_fast[j];
            }
            reference[l] += a * a;
            difference[l] += (b - a) * (b - a);
            sum += l == 0 ? b - a : 0;
            sum_exact += l == 0 ? a : 0;
        }
    }
    for (std::size_t l = 0; l < lights.size(); ++l) {
        EXPECT_LT(std::sqrt(difference[l] / reference[l]), 0.01) << l;
    }
    EXPECT_LT(std::abs(sum / sum_exact), 0.005);
}

// Bumps from thinner than their features to thicker than their triangles.
TEST(LightMaps, AgreeWithRaysWithin1Percent) {
    auto floor = tests::make_quad({-4, -1.2f, -4}, {0, 0, 8}, {8, 0, 0});
    auto post = tests::transformed(tests::make_cube(1, false), tests::some_rotation(), 0.5f,
                                   {1.5f, 0.5f, 0.3f});
    floor.material = post.material = 1;
    auto sheet = tests::make_cube(16, false);
    for (glm::vec3& v : sheet.position) {
        v.z *= 0.005f;
    }
    const auto bumps = tests::make_bumpy_body(4);
    const struct {
        const char* name;
        std::vector<tests::Primitive> parts;
        formats::Medium medium;
    } rows[] = {{"sphere", {tests::make_sphere(4)}, make_grey_medium(8, 0.2f)},
                {"thin bumps", {bumps}, make_grey_medium(2, 0.2f)},
                {"bumps", {bumps}, make_grey_medium(10, 1)},
                {"dense bumps", {bumps}, make_grey_medium(40, 4)},
                {"on a floor beside a post", {floor, bumps, post}, make_grey_medium(5, 0.5f)},
                {"thin sheet",
                 {tests::transformed(sheet, tests::some_rotation(), 1, {})},
                 make_grey_medium(50, 5)}};
    for (const auto& row : rows) {
        SCOPED_TRACE(row.name);
        expect_close_to_rays(set_up(make_translucent_scene(row.parts, row.medium)));
    }
}

TEST(LightMaps, HarmonicsTermsAgreeWithRaysWithin1Percent) {
    auto setup =
        set_up(make_translucent_scene({tests::make_bumpy_body(4)}, make_grey_medium(8, 0.8f)));
    for (const std::size_t degrees : {2u, 3u}) {
        setup.medium.phase.lambda = {1, 0.6f, 0.36f};
        setup.medium.phase.lambda.resize(degrees);
        expect_close_to_rays(setup, 100);
    }
}

TEST(LightMaps, RowsDependNeitherOnThreadsNorOnHowPointsAreCut) {
    const auto setup =
        set_up(make_translucent_scene({tests::make_bumpy_body(3)}, make_grey_medium(8, 0.2f)));
    const DirectionSet directions = make_direction_set(8);
    const auto points = some_points(setup, 300);
    const SingleRows one = gather_all(setup, directions, points, 1);
    const SingleRows two = gather_all(setup, directions, points, 2);
    EXPECT_EQ(one.rows.packed, two.rows.packed);
    EXPECT_EQ(one.rows.scale, two.rows.scale);
    EXPECT_EQ(one.counts.rays, two.counts.rays);
    const auto rest = std::span(points).subspan(100);
    const SingleRows cut = gather_all(setup, directions, rest, 2);
    std::vector<float> a(3 * 384), b(a.size());
    for (const std::size_t p : {0u, 7u, 150u}) {
        read_packed_row(cut.rows, p, a);
        read_packed_row(one.rows, 100 + p, b);
        EXPECT_EQ(a, b) << p;
    }
}

TEST(TexelDirections, ThoseOfTexelsAreAsGoodAsFourInEachForSmoothLights) {
    const auto setup =
        set_up(make_translucent_scene({tests::make_bumpy_body(4)}, make_grey_medium(8, 0.8f)));
    const DirectionSet four = make_direction_set(16), one = make_texel_directions(16);
    ASSERT_EQ(one.blocks.size() * 4, four.blocks.size());
    std::vector<int> met(1536, 0);
    for (const DirectionBlock& block : one.blocks) {
        for (const std::uint32_t texel : block.texel) {
            ++met[texel];
        }
    }
    EXPECT_EQ(met, std::vector<int>(1536, 1));
    const auto lights = smooth_lights(four);
    double difference = 0, reference = 0;
    for (const std::size_t p : {0u, 100u, 777u, 1500u, 2222u}) {
        const auto a = tests::gather(setup, four, p), b = tests::gather(setup, one, p);
        for (const auto& light : lights) {
            double fine = 0, coarse = 0;
            for (std::size_t j = 0; j < a.size(); ++j) {
                fine += light[j % 1536] * a[j];
                coarse += light[j % 1536] * b[j];
            }
            reference += fine * fine;
            difference += (fine - coarse) * (fine - coarse);
        }
    }
    EXPECT_LT(std::sqrt(difference / reference), 0.01);
}

TEST(LightMaps, ShellsWithinShellsAreNoBoundary) {
    const auto setup = set_up(
        make_translucent_scene({tests::make_sphere(4), tests::make_sphere(3, 0.6f, {0.1f, 0, 0})},
                               make_grey_medium(1, 0.1f)));
    const std::vector<std::uint8_t> inner = find_inner_triangles(setup.scene, setup.rays, 0, {});
    for (std::size_t t = 0; t < inner.size(); ++t) {
        EXPECT_EQ(inner[t] != 0, t >= setup.scene.primitives[0].index.size() / 3) << t;
    }
    expect_close_to_rays(setup);
}

TEST(PackedRows, ErrorsStayBelowTheirBound) {
    for (int i = 0; i < 2000; ++i) {
        const float a = std::exp2(-0.01f * static_cast<float>(i));
        const std::array<float, 3> positive{a, 0.37f * a, 0.011f * a};
        const std::array<float, 3> mixed{0.37f * a, -a, -0.011f * a};
        const auto read = unpack_values<3>(pack_values<3>(positive, false), false);
        const auto signs = unpack_values<3>(pack_values<3>(mixed, true), true);
        ASSERT_NEAR(unpack_values<1>(pack_values<1>({a}, false), false)[0], a, a / 512) << i;
        ASSERT_NEAR(unpack_values<1>(pack_values<1>({-a}, true), true)[0], -a, a / 256) << i;
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(read[c], positive[c], a / 512) << i;
            ASSERT_NEAR(signs[c], mixed[c], a / 256) << i;
        }
    }
    for (const bool has_sign : {false, true}) {
        EXPECT_EQ(unpack_values<3>(pack_values<3>({0, 0, 0}, has_sign), has_sign),
                  (std::array<float, 3>{0, 0, 0}));
        EXPECT_EQ(unpack_values<1>(pack_values<1>({0}, has_sign), has_sign)[0], 0.0f);
    }
}

TEST(PackedRows, OneBandTakesTwoBytesAndOnlyItsOwnBits) {
    for (int i = 0; i < 2000; ++i) {
        const float a = std::exp2(-0.02f * static_cast<float>(i));
        for (const bool has_sign : {false, true}) {
            std::uint16_t word;
            const std::uint32_t packed = pack_values<1>({a}, has_sign);
            store_packed<1>(packed, &word);
            ASSERT_EQ(load_packed<1>(&word), packed) << a;
        }
    }
    constexpr std::size_t kBytes = std::size_t{384} * 4 * 400;
    EXPECT_EQ(packed_rows_in(kBytes, 384, 4, 3), 100u);
    EXPECT_EQ(packed_rows_in(kBytes, 384, 4, 1), 200u);
}

}  // namespace
}  // namespace opaline::bake
