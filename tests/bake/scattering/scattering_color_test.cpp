#include "bake/physics/scattering_color.h"

#include <gtest/gtest.h>

#include "formats/gltf/map_medium.h"

namespace opaline::bake {
namespace {

// glTF's drafts print the inversion with constants of six digits.
TEST(ScatteringColor, AlbedoIsThatOfTheInversionWhichGltfsDraftsPrint) {
    for (const double g : {-0.5, 0.0, 0.8}) {
        for (double color = 0.02; color <= 1; color += 0.02) {
            EXPECT_NEAR(albedo_of_color(color, g),
                        formats::gltf::single_scattering_albedo(color, g), 2e-5)
                << color << ' ' << g;
        }
    }
}

TEST(ScatteringColor, ColorAndAlbedoAreInversesUpToTheLastDigits) {
    for (const double g : {-0.9, 0.0, 0.9}) {
        for (const double albedo : {0.0, 1e-3, 0.3, 0.9, 0.999, 0.9999999, 1.0}) {
            const double color = scattering_color(albedo, g);
            EXPECT_GE(color, 0);
            EXPECT_LE(color, 1);
            EXPECT_NEAR(1 - albedo_of_color(color, g), 1 - albedo, 1e-12 + 1e-7 * (1 - albedo))
                << albedo << ' ' << g;
        }
        EXPECT_EQ(albedo_of_color(0, g), 0);
        EXPECT_EQ(albedo_of_color(1, g), 1);
    }
}

}  // namespace
}  // namespace opaline::bake
