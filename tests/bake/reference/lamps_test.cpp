#include <gtest/gtest.h>

#include "bake/base/frame.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

using formats::Light;

constexpr double kPi = std::numbers::pi;

void expect_within(const bake::Moments& m, double expected, double slack = 0) {
    EXPECT_NEAR(m.mean.x, expected, 3 * standard_error(m) + slack * std::abs(expected));
}

/// A floor of albedo 1/2 under a black sky.
Scene floor_scene() {
    Scene scene = make_scene({make_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100})});
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    return scene;
}

/// Irradiance of the floor at x, from the radiance that it sends up.
bake::Moments irradiance_at(const ReferenceFixture& fixture, float x, std::uint32_t samples) {
    return merged(trace_in_parts(samples, [&](bake::RandomStream& random) {
        auto sample = bake::trace_ray(fixture.space(), {x, 0.01f, 0}, {0, -1, 0}, random);
        sample.radiance *= static_cast<float>(2 * kPi);
        return sample;
    }));
}

bake::Moments lit_by(const Light& light, float x) {
    Scene scene = floor_scene();
    scene.lights = {light};
    return irradiance_at(*make_fixture(std::move(scene), {}), x, 4);
}

TEST(ReferenceLamps, APointLightGivesIntensityTimesCosineOverSquaredDistance) {
    Light light;
    light.intensity = {10, 20, 30};
    light.position = {0, 2, 0};
    for (const float x : {0.0f, 1.0f, 5.0f}) {
        const double d2 = 4 + static_cast<double>(x * x);
        const bake::Moments m = lit_by(light, x);
        for (int band = 0; band < 3; ++band) {
            EXPECT_NEAR(m.mean[band] / (10 * (band + 1) * 2 / (d2 * std::sqrt(d2))), 1, 1e-4);
        }
    }
}

TEST(ReferenceLamps, ManyLightsAddUp) {
    Scene scene = floor_scene();
    double sum = 0;
    for (int i = 0; i < 5; ++i) {
        Light light;
        light.position = {static_cast<float>(i), 1.0f + 0.5f * static_cast<float>(i), 0};
        scene.lights.push_back(light);
        const glm::dvec3 way(light.position);
        sum += way.y / std::pow(glm::length(way), 3);
    }
    expect_within(irradiance_at(*make_fixture(std::move(scene), {}), 0, 2000), sum);
}

TEST(ReferenceLamps, ASphereOfRadianceLGivesPiLSineSquared) {
    // [exact for a point whose horizon lies below the sphere] of sine radius / distance.
    for (const bool close : {false, true}) {
        const float radius = close ? 1.6f : 0.2f;
        Scene scene = floor_scene();
        scene.primitives.push_back(make_sphere(5, radius, {0, 2, 0}));
        scene.materials.emplace_back().emission = {3, 3, 3};
        scene.materials[1].base_color = {0, 0, 0};
        scene.primitives[1].material = 1;
        const double sine = static_cast<double>(radius) / 2;
        // The mesh lies within the sphere: it is up to 0.1 % smaller. No light comes back.
        expect_within(irradiance_at(*make_fixture(std::move(scene), {}), 0, 20000),
                      3 * kPi * sine * sine, 2e-3);
    }
}

TEST(ReferenceLamps, AFurnaceOfEmissionOneAndAlbedoHalfHasRadianceTwo) {
    Scene scene = make_scene({make_cube(2, true)});
    scene.materials[0].emission = {1, 1, 1};
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    const auto fixture = make_fixture(std::move(scene), {});
    for (int side = 0; side < 6; ++side) {
        const bake::Moments m = merged(trace_in_parts(4000, [&](bake::RandomStream& random) {
            glm::vec3 d(2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1);
            d[side / 2] = side % 2 == 0 ? 1.5f : -1.5f;
            return bake::trace_ray(fixture->space(), {0.1f, -0.2f, 0.3f}, glm::normalize(d),
                                   random);
        }));
        expect_within(m, 2);
        EXPECT_LT(standard_error(m), 0.02);
    }
}

TEST(ReferenceLamps, OnlyTheFrontGlowsUnlessTheMaterialIsDoubleSided) {
    Scene scene = make_scene({make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})});
    scene.materials[0].emission = {1, 1, 1};
    for (const bool both : {false, true}) {
        scene.materials[0].double_sided = both;
        const auto fixture = make_fixture(scene, {});
        bake::RandomStream random(1, 2, 3);
        EXPECT_EQ(bake::trace_ray(fixture->space(), {0.3f, 1, 0}, {0, -1, 0}, random).radiance.x,
                  1);
        EXPECT_EQ(bake::trace_ray(fixture->space(), {0.3f, -1, 0}, {0, 1, 0}, random).radiance.x,
                  both ? 1 : 0);
    }
}

/// Mean radiance, by the cosine, that leaves a ball of radius 1 around the origin, over the whole
/// of a sphere around it of radius 1.001.
bake::Moments mean_exitant(const ReferenceFixture& fixture, std::uint32_t samples) {
    return merged(trace_in_parts(samples, [&](bake::RandomStream& random) {
        const float y = 2 * random.next() - 1, s = std::sqrt(1 - y * y);
        const float phi = static_cast<float>(2 * kPi) * random.next();
        const glm::vec3 n(s * std::cos(phi), y, s * std::sin(phi));
        const float c = std::sqrt(1 - random.next()), q = std::sqrt(1 - c * c);
        const float psi = static_cast<float>(2 * kPi) * random.next();
        const glm::vec3 d =
            bake::make_frame(-n).to_world({q * std::cos(psi), q * std::sin(psi), c});
        return bake::trace_ray(fixture.space(), 1.001f * n, d, random);
    }));
}

TEST(ReferenceLamps, AllPowerOfALampInAWhiteMediumLeavesItsBody) {
    // A white lamp, which reflects what comes back, in a medium that absorbs nothing.
    for (const float eta : {1.0f, 1.4f}) {
        const Primitive lamp = make_sphere(3, 0.5f);
        Scene scene = make_scene({make_sphere(4), lamp});
        scene.materials[0].medium = make_medium(2, 1, 0.3f, eta);
        scene.materials.emplace_back().emission = {4, 4, 4};
        scene.primitives[1].material = 1;
        // pi L A over pi times the area of the sphere of radius 1.001.
        const double expected = 4 * formats::surface_area(lamp) / (4 * kPi * 1.001 * 1.001);
        expect_within(mean_exitant(*make_fixture(std::move(scene), {}), 64000), expected, 2e-3);
    }
}

TEST(ReferenceLamps, LightOfAPointInAWhiteMediumLeavesScatteredOrUnseen) {
    Scene scene = make_scene({make_sphere(4)});
    scene.materials[0].medium = make_medium(1.5f, 1, 0.3f, 1);
    scene.lights.emplace_back();
    // No ray meets the light itself: the share exp(-sigma) that comes straight is not seen.
    const double expected = (1 - std::exp(-1.5)) / (kPi * 1.001 * 1.001);
    expect_within(mean_exitant(*make_fixture(std::move(scene), {}), 64000), expected, 5e-3);
}

TEST(ReferenceLamps, TheirLightIsATermOfItsOwn) {
    Scene scene = floor_scene();
    const auto radiance = [](const Scene& input, bool has_sky, formats::TermSet terms) {
        const auto fixture =
            make_fixture(input, has_sky ? make_white_sky() : formats::Environment{});
        bake::PathOptions options;
        options.terms = terms;
        bake::RandomStream random(1, 2, 3);
        return bake::trace_ray(fixture->space(options), {0, 1, 0}, {0, -1, 0}, random).radiance.x;
    };
    const auto others = formats::TermSet::all & ~formats::TermSet::emitters;
    const float plain = radiance(scene, true, others);
    scene.lights.emplace_back().position = {0, 2, 0};
    EXPECT_EQ(radiance(scene, true, others), plain);
    const float own = radiance(scene, false, formats::TermSet::all);
    EXPECT_GT(own, 0);
    EXPECT_EQ(radiance(scene, true, formats::TermSet::emitters), own);
    EXPECT_EQ(radiance(scene, true, formats::TermSet::diffuse), plain);
}

TEST(ReferenceLamps, ReceiversShowTheirOwnEmission) {
    Scene scene = make_scene({make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})});
    scene.materials[0].emission = {7, 8, 9};
    const auto fixture = make_fixture(std::move(scene), {});
    const auto chosen = bake::choose_receivers(fixture->scene, 1, 1, std::nullopt);
    bake::RandomStream random(1, 2, 3);
    EXPECT_EQ(bake::trace_receiver(fixture->space(), chosen.at(0), random).radiance,
              glm::vec3(7, 8, 9));
}

TEST(ReferenceLamps, ATextureIsDrawnByWhatItSendsOut) {
    // Half of the lamp's square is dark: its form factor is that of the other half.
    Scene scene = floor_scene();
    scene.primitives.push_back(make_quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}));
    scene.primitives[1].material = 1;
    scene.primitives[1].texcoord.clear();
    for (const glm::vec3& p : scene.primitives[1].position) {
        scene.primitives[1].texcoord.emplace_back(p.x + 0.5f, 0.5f);
    }
    formats::Material& lamp = scene.materials.emplace_back();
    lamp.emission = {1, 1, 1};
    lamp.base_color = {0, 0, 0};
    lamp.emission_image = 0;
    formats::Image8 image{256, 1, {}};
    for (int i = 0; i < 256; ++i) {
        image.rgba.insert(image.rgba.end(), 4, i < 128 ? std::uint8_t{255} : std::uint8_t{0});
    }
    scene.images = {image};
    // Irradiance below the corner of a rectangle a x b at distance 1 is L/2 (A atan B + ...), which
    // for two quarters of 0.5 x 0.5 on one side of the middle makes:
    const double q = 0.5 / std::sqrt(1.25);
    const double corner = 0.5 * 2 * q * std::atan(q);
    expect_within(irradiance_at(*make_fixture(std::move(scene), {}), 0, 20000), 2 * corner, 5e-3);
}

}  // namespace
}  // namespace opaline::tests
