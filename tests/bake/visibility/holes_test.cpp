#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "bake/trace/ray_scene.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using bake::LaneMask;
using bake::RayPacket;
using bake::RayScene;
using formats::Material;

/// A plate of 2 x 2 at height 1, facing down, with coordinates over it.
Scene plate() {
    Scene scene = make_scene({make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})});
    Primitive& p = scene.primitives[0];
    p.texcoord.clear();
    for (const glm::vec3& at : p.position) {
        p.texcoord.emplace_back(0.5f * (at.x + 1), 0.5f * (at.z + 1));
    }
    return scene;
}

/// A checkerboard of side x side texels, every other one clear.
formats::Image8 checkers(std::uint32_t side) {
    formats::Image8 image{side, side, {}};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint8_t alpha = (i % side + i / side) % 2 == 0 ? 255 : 0;
        image.rgba.insert(image.rgba.end(), {200, 200, 200, alpha});
    }
    return image;
}

/// Which of kRays rays from the origin toward the plate are blocked; rays of a packet at a time.
constexpr std::uint32_t kSide = 256;
std::vector<bool> blocked_from_below(const Scene& scene, bool nearest) {
    const RayScene rays = build_rays(scene);
    std::vector<bool> blocked;
    for (std::uint32_t i = 0; i < kSide * kSide; i += RayPacket::kSize) {
        RayPacket packet = bake::rays_from({0, 0, 0});
        LaneMask lanes;
        for (std::uint32_t k = 0; k < RayPacket::kSize; ++k) {
            const float x = (static_cast<float>((i + k) % kSide) + 0.5f) / (kSide / 2) - 1;
            const float z = (static_cast<float>((i + k) / kSide) + 0.5f) / (kSide / 2) - 1;
            const glm::vec3 d = glm::normalize(glm::vec3(x, 1, z));
            packet.dir_x[k] = d.x, packet.dir_y[k] = d.y, packet.dir_z[k] = d.z;
            packet.tfar[k] = 100;
            lanes[k] = -1;
        }
        if (nearest) {
            const auto hits = rays.closest(lanes, packet);
            for (std::uint32_t k = 0; k < RayPacket::kSize; ++k) {
                blocked.push_back(hits.hit[k] != 0);
            }
        } else {
            rays.occluded(lanes, packet);
            for (std::uint32_t k = 0; k < RayPacket::kSize; ++k) {
                blocked.push_back(packet.tfar[k] < 0);
            }
        }
    }
    return blocked;
}

double share(const std::vector<bool>& blocked) {
    return static_cast<double>(std::count(blocked.begin(), blocked.end(), true)) /
           static_cast<double>(blocked.size());
}

TEST(Holes, TheShadowOfACutOutIsThatOfTheSameGeometryCut) {
    // Clear for u < 1/2: the geometry that is left is the half with x > 0.
    Scene scene = plate();
    scene.materials[0].alpha_mode = Material::AlphaMode::mask;
    scene.materials[0].base_color_image = 0;
    scene.materials[0].wrap_u = formats::TextureWrap::clamp;
    scene.images = {{2, 1, {9, 9, 9, 0, 9, 9, 9, 255}}};
    const Scene cut = make_scene({make_quad({0, 1, -1}, {1, 0, 0}, {0, 0, 2})});
    for (const bool nearest : {false, true}) {
        EXPECT_EQ(blocked_from_below(scene, nearest), blocked_from_below(cut, nearest));
    }
}

TEST(Holes, ABlendOfThreeTenthsTransmitsSevenTenths) {
    Scene scene = plate();
    scene.materials[0].alpha_mode = Material::AlphaMode::blend;
    scene.materials[0].alpha = 0.3f;
    constexpr double kError = 4 * 0.46 / kSide;
    const auto blocked = blocked_from_below(scene, false);
    EXPECT_NEAR(share(blocked), 0.3, kError);
    // The nearest hit and any hit agree ray by ray.
    EXPECT_EQ(blocked_from_below(scene, true), blocked);
    // Two layers transmit the square.
    scene.primitives.push_back(scene.primitives[0]);
    for (glm::vec3& p : scene.primitives[1].position) {
        p.y += 0.001f;
    }
    EXPECT_NEAR(share(blocked_from_below(scene, false)), 1 - 0.7 * 0.7, kError);
}

TEST(Holes, TheHierarchyOutlivesItsScene) {
    auto scene = std::make_unique<Scene>(plate());
    scene->materials[0].alpha_mode = Material::AlphaMode::mask;
    scene->materials[0].base_color_image = 0;
    scene->images = {checkers(2)};
    auto built = bake::EmbreeScene::build(*scene, 1);
    ASSERT_TRUE(built);
    const bake::EmbreeScene moved = std::move(*built);
    scene.reset();
    EXPECT_FALSE(moved.has_chances());
    EXPECT_EQ(moved.triangles(), 2u);
}

}  // namespace
}  // namespace opaline::tests
