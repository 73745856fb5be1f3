#include "bake/exchange/scatterers.h"

#include <gtest/gtest.h>

#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

struct Found {
    std::vector<Scatterer> scatterers;
    std::uint64_t rays = 0;
};

Found find_in(formats::Scene scene, std::size_t count) {
    const tests::LitScene lit(std::move(scene));
    const std::vector<RowLayout> layouts = lit.layouts();
    const BakeInputs inputs = lit.inputs();
    const Knobs knobs;
    Found found;
    found.scatterers = find_scatterers({inputs, knobs, {}, layouts, {}, {}}, count, found.rays);
    return found;
}

TEST(Scatterers, LieWhereReceiversLook) {
    const Found found = find_in(tests::make_plates(0.5f, 0.5f, 8), 256);
    EXPECT_EQ(found.scatterers.size(), 256u);
    EXPECT_EQ(found.rays, 2u * 81 * 16);
    std::size_t upper = 0;
    for (const Scatterer& s : found.scatterers) {
        upper += s.material;
        EXPECT_NEAR(s.position.y, s.material == 1 ? 0.5 : 0, 1e-6);
        EXPECT_EQ(s.normal.y, s.material == 1 ? -1 : 1) << "the sides that face each other";
        EXPECT_FALSE(s.behind);
        EXPECT_NEAR(s.albedo.diffuse.g, 0.5, 1e-6);
        EXPECT_GT(s.outside.origin.y * s.normal.y, s.position.y * s.normal.y);
    }
    EXPECT_NEAR(static_cast<double>(upper), 128, 30);
}

TEST(Scatterers, ALoneConvexBodyHasNone) {
    EXPECT_TRUE(find_in(tests::make_scene({tests::make_sphere(2)}), 64).scatterers.empty());
}

TEST(Scatterers, SheetsAreSeenFromBothSides) {
    formats::Scene scene = tests::make_plates(0.5f, 0.5f, 8);
    scene.materials[0].sheet = formats::Sheet{};
    scene.primitives.push_back(tests::make_quad({0, -0.5f, 0}, {0, 0, 1}, {1, 0, 0}, 8));
    scene.primitives[2].material = 1;
    std::size_t front = 0, behind = 0;
    for (const Scatterer& s : find_in(scene, 512).scatterers) {
        if (s.material == 0) {
            (s.behind ? behind : front) += 1;
            EXPECT_EQ(s.normal.y, s.behind ? -1 : 1);
            EXPECT_EQ(s.outside.origin.y > 0, !s.behind);
            EXPECT_EQ(s.beyond.origin.y > 0, s.behind);
        }
    }
    EXPECT_GT(front, 50u);
    EXPECT_GT(behind, 50u);
}

}  // namespace
}  // namespace opaline::bake
