// Volumes that are the inside of meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formats/media/fill_body.h"
#include "tests/bake/reference/volume_support.h"

namespace opaline::tests {
namespace {

using formats::TermSet;

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

TEST(ReferenceBodyVolume, AMeshedBallScattersADistantLightAsABallOfTheTableDoes) {
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

// A plate 16 wide and 1 thick, seen and lit from above. Light that is scattered once in depth t,
// of unit irradiance: albedo p int exp(-t / v - t / l) dt / v up to tau, with cosines v and l.
TEST(ReferenceBodyVolume, AMeshedSlabScattersOnceAsTheClosedFormSays) {
    TransportRow row;
    row.g = 0.75f, row.albedo = 0.9f, row.sigma_t = 2;
    Primitive plate = make_cube(1, false);
    for (glm::vec3& p : plate.position) {
        p *= glm::vec3(8, 0.5f, 8);
    }
    const glm::vec3 march(0.6f, -0.8f, 0);
    row.light = {0, 0.8f, 0.6f};
    const auto fixture = make_volume_fixture({make_body_volume(std::move(plate), row, 128)},
                                             make_distant_light(row.light));
    const double cosine = -glm::dot(glm::dvec3(-row.light), glm::dvec3(march)), g = 0.75;
    const double phase =
        (1 - g * g) / (4 * std::numbers::pi) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
    const double slope = 2 / 0.8;
    row.value = 0.9 * phase / 0.8 * -std::expm1(-2 * slope) / slope;
    bake::PathOptions options;
    options.terms = TermSet::volume_single;
    expect_within(row, look(*fixture, -2.0f * march, march, options, 128000), 4);
}

}  // namespace
}  // namespace opaline::tests
