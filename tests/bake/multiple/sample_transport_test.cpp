#include "bake/effects/multiple/sample_transport.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/receivers/surface_samples.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

double length(const SparseVector& vector) {
    double squares = 0;
    for (const float value : vector.value) {
        squares += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(squares);
}

// Half of the sky, weighted by the cosine: the mean over the sphere is 1/4. A row with all entries
// has the norm of the whole vector times the area of its sample, with and without shared rays.
TEST(SampleTransport, OfAConvexBodyIsTheCosineTimesTheAreaOfEachSample) {
    const formats::Scene scene = tests::make_scene({tests::make_sphere(2)});
    const auto rays = RayScene::build(scene, 1);
    const auto samples = sample_surface(scene, {0}, 150, 1, {});
    ASSERT_GT(samples.size(), SparseVectors::kPerBlock) << "more than one block";
    for (const bool share_rays : {false, true}) {
        const SampleTransport found =
            bake_sample_transport(*rays, samples, {16, 6 * 16 * 16, 1, share_rays}, {});
        ASSERT_EQ(found.rows.size(), samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_NEAR(found.mean[i], 0.25, 0.02) << i;
            const double whole =
                static_cast<double>(samples[i].area) * static_cast<double>(found.norm[i]);
            EXPECT_NEAR(length(found.rows[i]), whole, 1e-5 * whole) << i;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
