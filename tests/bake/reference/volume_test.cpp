#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/reference/volume_flight.h"
#include "formats/media/fill_body.h"
#include "tests/bake/reference/volume_support.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using formats::TermSet;

TEST(ReferenceVolume, ScattersADistantLightOnceTwiceAndOften) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    const auto rows = read_volume_transport("radiance");
    ASSERT_FALSE(rows.empty());
    for (const TransportRow& row : rows) {
        const auto fixture = make_row_fixture(row, make_distant_light(row.light));
        bake::PathOptions options;
        options.terms =
            row.quantity == "order1" ? TermSet::volume_single : TermSet::volume_multiple;
        options.max_depth = row.quantity == "order2" ? 2 : options.max_depth;
        expect_within(row, march_grid(*fixture, row, options, 128000), limit_for(rows.size()));
    }
}

// The volume that is the inside of a mesh.
formats::Volume make_body_volume(Primitive mesh, const TransportRow& row, std::uint32_t voxels) {
    Scene scene = make_scene({std::move(mesh)});
    formats::Medium& medium = scene.materials[0].medium.emplace();
    const float s = row.albedo * row.sigma_t, a = row.sigma_t - s;
    medium.sigma_s = {s, s, s};
    medium.sigma_a = {a, a, a};
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = row.g;
    return formats::fill_body(scene, "Grey", voxels, "", "")->volume;
}

TEST(ReferenceVolume, AMeshedBallScattersADistantLightAsABallOfTheTableDoes) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    auto rows = read_volume_transport("radiance");
    std::erase_if(rows, [](const TransportRow& r) {
        return r.geometry != "sphere" || r.quantity != "order1";
    });
    ASSERT_FALSE(rows.empty());
    for (const TransportRow& row : rows) {
        const auto fixture = make_volume_fixture(
            {make_body_volume(make_sphere(5, row.size), row, 64)}, make_distant_light(row.light));
        bake::PathOptions options;
        options.terms = TermSet::volume_single;
        expect_within(row, march_grid(*fixture, row, options, 64000), limit_for(rows.size()));
    }
}

TEST(ReferenceVolume, LetsABeamOutWhereItIsKnownTo) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    const auto rows = read_volume_transport("escape");
    ASSERT_FALSE(rows.empty());
    for (const TransportRow& row : rows) {
        ASSERT_EQ(row.march, glm::vec3(0, 1, 0)) << row.name();
        expect_escape(
            row, limit_for(rows.size()), 64000, [&](formats::Environment sky, std::uint32_t depth) {
                bake::PathOptions options;
                options.max_depth = depth;
                return march_grid(*make_row_fixture(row, std::move(sky)), row, options, 64000);
            });
    }
}

// Layers of sigma(z) = sigma_t (1 + 0.8 sin(6 pi z / size)): only the depth counts, whatever the
// profile. Voxels are flat, so that the slab is wide and its layers are fine.
TEST(ReferenceVolume, LayersLetABeamOutAsAnEvenSlabDoes) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    auto rows = read_transport_rows("escape");
    std::erase_if(rows, [](const TransportRow& r) { return r.geometry != "sine"; });
    ASSERT_FALSE(rows.empty());
    for (const TransportRow& row : rows) {
        ASSERT_EQ(row.march, glm::vec3(0, -1, 0)) << row.name();
        constexpr int kLayers = 96;
        formats::Volume slab =
            make_volume(formats::fill_grid({-12, 0, -12}, {12, kLayers - 1, 12}, 1,
                                           [](glm::ivec3 v) {
                                               const double z = (v.y + 0.5) / kLayers;
                                               return 1 + 0.8 * std::sin(6 * std::numbers::pi * z);
                                           }),
                        row.sigma_t, row.albedo, row.g);
        slab.density.to_scene =
            glm::dmat4(glm::dvec4(4 * row.size, 0, 0, 0), glm::dvec4(0, row.size / kLayers, 0, 0),
                       glm::dvec4(0, 0, 4 * row.size, 0), glm::dvec4(0, 0, 0, 1));
        expect_escape(
            row, limit_for(rows.size()), 64000, [&](formats::Environment sky, std::uint32_t depth) {
                bake::PathOptions options;
                options.max_depth = depth;
                return look(*make_volume_fixture({slab}, std::move(sky)),
                            row.size * glm::vec3(0.3f, 2, 0.2f), {0, -1, 0}, options, 64000);
            });
    }
}

TEST(ReferenceVolume, ABallLetsAParallelBeamThroughByBeersLaw) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    auto rows = read_transport_rows("transmittance");
    std::erase_if(rows, [](const TransportRow& r) { return r.geometry != "sphere"; });
    ASSERT_FALSE(rows.empty());
    for (const TransportRow& row : rows) {
        const auto fixture = make_volume_fixture(
            {make_volume(make_ball_grid(row.size, row.size / 32), row.sigma_t, 0, 0)},
            make_white_sky());
        bake::Moments passing;
        for (std::uint32_t i = 0; i < 100000; ++i) {
            bake::RandomStream random(3, 0, i);
            const float r = row.size * std::sqrt(random.next());
            const float turn = 2 * std::numbers::pi_v<float> * random.next();
            passing.add(bake::estimate_transmittance(
                fixture->scene.volumes, {r * std::cos(turn), r * std::sin(turn), -3 * row.size},
                {0, 0, 1}, 6 * row.size, random));
        }
        // Voxels soften the rim, through which most passes where the ball is dense.
        EXPECT_NEAR(passing.mean.x, row.value,
                    4 * standard_error(passing) + 0.002 * (1 - row.value) * row.value + 2e-4)
            << row.name() << " sigma_t " << row.sigma_t;
    }
}

// Flights through an even medium, and directions by its phase function.
TEST(ReferenceVolume, PathsOfALengthGoAsFarAsIsKnown) {
    OPALINE_NEEDS_REFERENCE("volumes.csv");
    std::vector<VolumeRow> rows = read_volume_table();
    std::erase_if(rows, [](const VolumeRow& r) { return r.cell.at("group") != "moments"; });
    ASSERT_FALSE(rows.empty());
    for (const VolumeRow& row : rows) {
        const double length = row.number("arg");
        const auto even = [](auto) { return 1.0; };
        const auto fixture = make_volume_fixture(
            {make_volume(sample_grid(glm::dvec3(1.2 * length), length / 10, even),
                         static_cast<float>(row.number("sigma_t")), 1,
                         static_cast<float>(row.number("g")))},
            make_white_sky());
        const bake::VolumeSpace& space = fixture->scene.volumes;
        bake::Moments moments;
        for (std::uint32_t i = 0; i < 40000; ++i) {
            bake::RandomStream random(9, 0, i);
            glm::vec3 at(0), direction(0, 0, 1);
            float left = static_cast<float>(length);
            for (;;) {
                const bake::VolumeFlight flight =
                    bake::sample_volume_flight(space, at, direction, left, glm::vec3(1), random);
                at += flight.distance * direction;
                left -= flight.distance;
                if (!flight.collides) break;
                const float cosine = bake::sample_phase_cosine(space.volumes[0].phase,
                                                               [&] { return random.next(); });
                const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
                const float turn = 2 * std::numbers::pi_v<float> * random.next();
                direction = glm::normalize(bake::make_frame(direction).to_world(
                    {sine * std::cos(turn), sine * std::sin(turn), cosine}));
            }
            moments.add({direction.z, at.z, glm::dot(at, at)});
        }
        const std::string quantity = row.cell.at("quantity");
        const int which = quantity == "mean_cos" ? 0 : quantity == "mean_z" ? 1 : 2;
        EXPECT_NEAR(moments.mean[which], row.value(),
                    limit_for(rows.size()) * std::sqrt(moments.variance_of_mean()[which]))
            << row.id() << " " << quantity;
    }
}

// Segments follow one another, cover what is dense, and their bounds hold.
TEST(ReferenceVolume, BoundsOfCellsAreNeverExceeded) {
    auto second = make_volume(make_ball_grid(0.7, 0.05), 3, 1, 0);
    second.density.to_scene[3] = glm::dvec4(0.31, -0.2, 0.4, 1);
    second.density.to_scene[1] *= 1.7;  // anisotropic voxels
    const auto fixture = make_volume_fixture(
        {make_volume(make_blob(0.3, 0.07), 4, 0.5f, 0), second}, make_white_sky());
    const bake::VolumeSpace& space = fixture->scene.volumes;
    bake::RandomStream random(11, 0, 0);
    const auto u = [&] { return 2 * random.next() - 1; };
    int dense = 0;
    for (int ray = 0; ray < 200; ++ray) {
        const glm::vec3 from(3 * u(), 3 * u(), 3 * u());
        const glm::vec3 direction =
            glm::normalize(glm::vec3(0.5f * u(), 0.5f * u(), 0.5f * u()) - from);
        bake::VolumeMarch march(space, from, direction, 9);
        auto segment = march.next();
        for (int i = 0; i < 3000; ++i) {
            const float t = 9 * (static_cast<float>(i) + 0.5f) / 3000;
            while (segment && segment->end < t) {
                const float end = segment->end;
                segment = march.next();
                ASSERT_TRUE(!segment || segment->begin >= end);
            }
            for (std::size_t v = 0; v < 2; ++v) {
                const float density = space.volumes[v].density(from + t * direction);
                const float bound = segment && segment->begin <= t ? segment->bound[v] : 0;
                // A point at a cell's face may round to its other side.
                if (density > bound * 1.0001f && segment && std::abs(segment->end - t) > 1e-5f &&
                    std::abs(segment->begin - t) > 1e-5f) {
                    ADD_FAILURE() << "ray " << ray << " at " << t << ": " << density << " > "
                                  << bound;
                }
                EXPECT_TRUE(segment || density == 0);
                dense += density > 0;
            }
        }
    }
    EXPECT_GT(dense, 10000);
}

TEST(ReferenceVolume, InAFurnaceIsInvisibleWhereNothingIsAbsorbed) {
    auto volume = make_volume(make_blob(0.5, 0.125), 6, 1, 0.8f);
    volume.sigma_t = {0.5f, 6, 20};
    const auto fixture = make_volume_fixture({volume}, make_white_sky());
    const bake::Moments m = look(*fixture, {0.1f, 0.2f, -3}, {0, 0, 1}, {}, 40000);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(m.mean[c], 1, 4 * std::sqrt(m.variance_of_mean()[c]) + 1e-5) << c;
        EXPECT_LT(m.variance_of_mean()[c], 1e-4);
    }
}

// A channel's light knows nothing of the other channels.
TEST(ReferenceVolume, ChannelsAreThoseOfGreyMedia) {
    auto colored = make_volume(make_blob(0.5, 0.125), 1, 0.9f, 0.5f);
    colored.sigma_t = {1, 4, 8};
    colored.albedo = {0.95f, 0.8f, 0.99f};
    const formats::Environment light = make_distant_light(glm::normalize(glm::vec3(1, 1, 0)));
    const bake::Moments all =
        look(*make_volume_fixture({colored}, light), {0.3f, 0, -3}, {0, 0, 1}, {}, 100000);
    const float sigma[3] = {1, 4, 8}, albedo[3] = {0.95f, 0.8f, 0.99f};
    for (int c = 0; c < 3; ++c) {
        const bake::Moments one =
            look(*make_volume_fixture(
                     {make_volume(make_blob(0.5, 0.125), sigma[c], albedo[c], 0.5f)}, light),
                 {0.3f, 0, -3}, {0, 0, 1}, {}, 100000);
        const double error = std::sqrt(all.variance_of_mean()[c] + one.variance_of_mean().x);
        EXPECT_NEAR(all.mean[c], one.mean.x, 4 * error);
        EXPECT_LT(error, 0.03 * one.mean.x);
    }
}

TEST(ReferenceVolume, OverlappingVolumesAddUp) {
    const formats::Environment light = make_distant_light({0, 1, 0});
    const auto whole = make_volume(make_blob(0.5, 0.125), 5, 0.9f, 0.6f);
    auto part = whole, rest = whole;
    part.sigma_t = {1.5f, 1.5f, 1.5f};
    rest.sigma_t = {3.5f, 3.5f, 3.5f};
    // The rest on another lattice: twice as fine, and turned by a quarter.
    rest.density = make_blob(0.5, 0.0625);
    rest.density.to_scene = glm::dmat4(glm::dvec4(0, 0.0625, 0, 0), glm::dvec4(-0.0625, 0, 0, 0),
                                       glm::dvec4(0, 0, 0.0625, 0), glm::dvec4(0, 0, 0, 1));
    const bake::Moments one =
        look(*make_volume_fixture({whole}, light), {0.2f, 0, -3}, {0, 0, 1}, {}, 100000);
    const bake::Moments two =
        look(*make_volume_fixture({part, rest}, light), {0.2f, 0, -3}, {0, 0, 1}, {}, 100000);
    const double error = std::hypot(standard_error(one), standard_error(two));
    // The voxels of one are coarser: .26 % of density in the middle.
    EXPECT_NEAR(two.mean.x, one.mean.x, 4 * error + 0.003 * one.mean.x);
    EXPECT_LT(error, 0.02 * one.mean.x);
}

// Light of a sun that falls through smoke onto a white floor, and what is seen of the floor.
TEST(ReferenceVolume, ShadowsSurfacesAndHidesThemByBeersLaw) {
    const auto black = make_volume(make_ball_grid(0.5, 0.02), 2, 0, 0);
    Scene scene = make_scene({make_cube(1, false)});
    for (glm::vec3& p : scene.primitives[0].position) {
        p = p * glm::vec3(20, 0.1f, 20) - glm::vec3(0, 2, 0);
    }
    Scene with = scene;
    with.volumes = {black};
    const formats::Environment sun = make_distant_light({0, 1, 0});
    const auto clear = make_fixture(scene, sun), smoky = make_fixture(with, sun);
    const double through = std::exp(-2.0);  // 2 per metre, a metre
    bake::PathOptions options;
    options.terms = TermSet::diffuse;
    const glm::vec3 aside = glm::normalize(glm::vec3(-3, -2, 0));
    const double lit =
        look(*clear, glm::vec3(0.01f, -1.9f, 0.02f) - 4.0f * aside, aside, options, 16).mean.x;
    ASSERT_GT(lit, 0.05);
    // From the side, the view passes below the ball: the shadow alone.
    const bake::Moments shadow =
        look(*smoky, glm::vec3(0.01f, -1.9f, 0.02f) - 4.0f * aside, aside, options, 40000);
    EXPECT_NEAR(shadow.mean.x / lit, through, 4 * standard_error(shadow) / lit + 0.002);
    // From above, both the light and the view pass the ball.
    const bake::Moments both = look(*smoky, {0.01f, 3, 0.02f}, {0, -1, 0}, options, 160000);
    EXPECT_NEAR(both.mean.x / lit, through * through, 4 * standard_error(both) / lit + 0.001);
}

// Smoke fills what no body does.
TEST(ReferenceVolume, IsNotInsideOfBodies) {
    Scene scene = make_slab(make_medium(1, 0.5f, 0, 1), 1);
    Scene smoky = scene;
    smoky.volumes = {
        make_volume(sample_grid(glm::dvec3(0.35), 0.05, [](auto) { return 1.0; }), 50, 0.5f, 0)};
    bake::PathOptions options;
    options.terms = TermSet::unscattered;
    for (const Scene& s : {scene, smoky}) {
        const auto fixture = make_fixture(s, make_white_sky());
        const bake::Moments m = look(*fixture, {0.11f, 3, 0.07f}, {0, -1, 0}, options, 40000);
        EXPECT_NEAR(m.mean.x, std::exp(-1.0), 4 * standard_error(m));
    }
}

// Up to a million mean free paths a voxel: finite, and right at both ends.
TEST(ReferenceVolume, HoldsAtAnyDensity) {
    for (const float sigma : {0.0f, 1e-12f, 1e-3f, 1e5f, 1e7f}) {
        const auto fixture = make_volume_fixture(
            {make_volume(make_ball_grid(1, 0.1), sigma, 0.5f, 0.9f)}, make_white_sky());
        const bake::Moments m = look(*fixture, {0.05f, 0, -3}, {0, 0, 1}, {}, 3200);
        EXPECT_TRUE(std::isfinite(m.mean.x));
        EXPECT_GE(m.mean.x, 0);
        EXPECT_LE(m.mean.x, 1 + 4 * standard_error(m));
        if (sigma <= 1e-12f) {
            EXPECT_NEAR(m.mean.x, 1, 1e-6);
        }
        // A half space of this medium shows 4 to 6 percent (albedo .5, g .9), once it is seen.
        if (sigma >= 1e5f) {
            EXPECT_LT(m.mean.x, 0.2);
        }
    }
}

}  // namespace
}  // namespace opaline::tests
