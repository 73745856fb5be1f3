#include <gtest/gtest.h>

#include "bake/physics/fresnel.h"
#include "tests/bake/varied/varied_body.h"

namespace opaline::tests {
namespace {

// Veins of strong contrast and a density that rises from 0.1 to 1, bands with extinctions of their
// own: two codes that share nothing but the field and the triangles.
TEST(WalksBesideReference, SeeTheSameLightOfAVeinedBallOfVaryingDensity) {
    formats::Medium medium = make_forward_medium(4, 0.95f, 0.4f, 1.3f);
    medium.sigma_s = {6, 4, 2};
    Scene scene = make_mapped_ball(medium);
    variation_of(scene).marble =
        formats::Marble{0.5f, {{0.05f, 0.1f, 0.9f}, {0.9f, 0.2f, 0.1f}, {1, 1, 1}}};
    variation_of(scene).density = add_inner_texture(scene, {2, 1, {25, 0, 0, 0, 255, 0, 0, 0}});
    variation_of(scene).g = 0.4f;
    const auto walked = make_walked_scene(scene, false);
    const auto fixture = make_fixture(std::move(scene), make_white_sky());
    const auto passed = bake::fresnel_transmittance(1, 1.3);
    double largest = 0, smallest = 1;
    for (const glm::vec3 axis :
         {glm::vec3(0.6f, 0.8f, 0), {0, 0.6f, 0.8f}, {-0.8f, 0, 0.6f}, {0, -1, 0}}) {
        // Where the line meets a facet.
        const auto hit = fixture->scene.surfaces.closest_hit({3.0f * axis}, -axis, 10);
        ASSERT_TRUE(hit);
        bake::WalkStart start{hit->position - 1e-5f * hit->flat, axis, hit->flat, 1, axis};
        const BandsLeaving leaving =
            walk_bands(walked->space, start, 12000, [](const auto&) { return true; });
        bake::PathOptions terms;
        terms.terms = bake::TermSet::single | bake::TermSet::multiple;
        const bake::PathSpace space = fixture->space(terms);
        bake::ReferenceReceiver receiver;
        receiver.position = hit->position;
        receiver.outside = hit->position + 1e-5f * hit->flat;
        receiver.inside = start.position;
        receiver.normal = receiver.to_eye = axis;
        receiver.medium = 0;
        const bake::Moments seen = merged(trace_in_parts(32000, [&](bake::RandomStream& random) {
            return bake::trace_receiver(space, receiver, random);
        }));
        for (int b = 0; b < 3; ++b) {
            const auto at = static_cast<std::size_t>(b);
            const double walks = passed * leaving.mean[at], error = leaving.error[at];
            EXPECT_NEAR(walks, seen.mean[b],
                        4 * std::hypot(error, std::sqrt(seen.variance_of_mean()[b])))
                << axis.x << ' ' << axis.y << ' ' << axis.z << " band " << b;
            EXPECT_LT(error, 0.02 * walks);
            largest = std::max(largest, walks);
            smallest = std::min(smallest, walks);
        }
    }
    EXPECT_GT(largest, 2 * smallest) << "there is nothing to tell apart";
}

}  // namespace
}  // namespace opaline::tests
