#include <gtest/gtest.h>

#include "bake/scattering/fresnel.h"
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
        constexpr std::uint32_t kWalks = 12000;
        glm::dvec3 sum(0), squares(0);
        std::vector<bake::WalkExit> exits;
        bake::WalkCounts counts;
        for (std::uint32_t w = 0; w < kWalks; ++w) {
            glm::dvec3 own(0);
            for (bake::WalkGroup group; group.flies_as < walked->space.bands.size();
                 ++group.flies_as) {
                bake::WalkRandom random({1, bake::RandomStage::body_walk, group.flies_as, w});
                exits.clear();
                bake::follow_walk(walked->space, group, start, {1}, random, exits, counts);
                for (const bake::WalkExit& exit : exits) {
                    own += glm::dvec3(exit.weight[0], exit.weight[1], exit.weight[2]);
                }
            }
            sum += own / static_cast<double>(kWalks);
            squares += own * own / static_cast<double>(kWalks);
        }
        bake::EstimateOptions options;
        options.samples = 4000;
        bake::PathOptions terms;
        terms.terms = bake::TermSet::single | bake::TermSet::multiple;
        const bake::PathSpace space = fixture->space(terms);
        bake::ReferenceReceiver receiver;
        receiver.position = hit->position;
        receiver.outside = hit->position + 1e-5f * hit->flat;
        receiver.inside = start.position;
        receiver.normal = receiver.to_eye = axis;
        receiver.medium = 0;
        const auto estimate =
            bake::estimate_pixels(8, options, {}, [&](std::uint32_t, bake::RandomStream& random) {
                return bake::trace_receiver(space, receiver, random);
            });
        bake::Moments seen;
        for (const bake::Moments& m : estimate->pixel) {
            seen.merge(m);
        }
        for (int b = 0; b < 3; ++b) {
            const double walks = passed * sum[b];
            const double error = std::sqrt((squares[b] - sum[b] * sum[b]) / kWalks);
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
