#include "bake/scene/inspect_scene.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>
#include <vector>

#include "bake/scene/body_shells.h"
#include "bake/scene/coverage.h"
#include "bake/scene/horizon.h"
#include "bake/scene/parts_apart.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using tests::make_cube;
using tests::make_quad;
using tests::make_scene;
using tests::make_sphere;
using tests::some_rotation;
using tests::transformed;

MaterialFacts inspect(std::vector<Primitive> primitives) {
    return inspect_scene(make_scene(std::move(primitives))).material[0];
}

MaterialFacts inspect_medium(std::vector<Primitive> primitives) {
    return inspect_scene(
               tests::make_translucent_scene(std::move(primitives), tests::make_grey_medium(40, 1)))
        .material[0];
}

// Alone, a convex body has nothing above its horizons, and others have.
bool is_convex(const Primitive& p) {
    return inspect_scene(make_scene({p})).is_open();
}

// Points moved out along their direction from the centre: stays a star seen from there.
Primitive star(double amplitude, int levels = 3) {
    Primitive p = make_sphere(levels);
    for (glm::vec3& x : p.position) {
        x *= 1 + amplitude * std::sin(5 * x.x) * std::sin(4 * x.y + 1) * std::cos(6 * x.z);
    }
    return p;
}

// A sheet rolled up: every fold bends the same way, but the inner turn looks at the outer.
Primitive roll(double turns) {
    const int steps = static_cast<int>(32 * turns);
    Primitive p;
    p.name = "roll";
    for (int i = 0; i <= steps; ++i) {
        const double phi = 2 * std::numbers::pi * i / 32;
        const double r = 1 + 0.1 * phi;
        for (const float y : {0.0f, 1.0f}) {
            p.position.push_back({r * std::cos(phi), y, r * std::sin(phi)});
            p.normal.push_back({std::cos(phi), 0, std::sin(phi)});
        }
    }
    for (std::uint32_t v = 0; v + 3 < p.position.size(); v += 2) {
        p.index.insert(p.index.end(), {v, v + 1, v + 3, v, v + 3, v + 2});
    }
    return p;
}

TEST(InspectScene, ACubeIsMeasured) {
    const MaterialFacts facts = inspect({make_cube(1, false)});
    EXPECT_EQ(facts.triangles, 12);
    EXPECT_EQ(facts.receivers, 24);
    EXPECT_NEAR(facts.area, 24, 1e-12);
    EXPECT_NEAR(facts.mean_edge, (4 + 2 * std::sqrt(2.0)) / 3, 1e-12);
    EXPECT_EQ(facts.low, glm::vec3(-1));
    EXPECT_EQ(facts.high, glm::vec3(1));
    EXPECT_EQ(inspect_medium({make_cube(1, false)}).open_edges, 0u);
    EXPECT_EQ(inspect_medium({make_quad({}, {1, 0, 0}, {0, 0, -1})}).open_edges, 4u);
}

// A hollow's edges are no ridges of the medium around it.
TEST(InspectScene, SharpEdgesAreTheRidgesOfABodyAndOfItsCopies) {
    const Primitive cube = make_cube(4, false);
    EXPECT_NEAR(inspect_medium({cube}).sharp_edges, 24, 1e-5);
    EXPECT_EQ(inspect_medium({make_sphere(3)}).sharp_edges, 0);
    const Primitive hollow = transformed(make_cube(4, true), glm::mat3(1), 0.5f, {0, 0, 0});
    EXPECT_NEAR(inspect_medium({cube, hollow}).sharp_edges, 24, 1e-5);
    const Primitive copy = transformed(cube, some_rotation(), 0.5f, {9, 0, 0});
    EXPECT_NEAR(inspect_medium({cube, copy}).sharp_edges, 36, 1e-4);
}

// As scans leave them: what is missing of the surface hardly matters to volume and area.
TEST(InspectScene, BodyWithSmallHolesIsAsThickAsWithoutAndASheetHasNoThickness) {
    const MaterialFacts whole = inspect_medium({make_sphere(3)});
    for (const std::ptrdiff_t apart : {1200, 300}) {  // 3 holes, and 12
        Primitive holed = make_sphere(3);
        for (std::ptrdiff_t hole = 0; hole < 3600; hole += apart) {
            const auto at = holed.index.begin() + hole;
            holed.index.erase(at, at + 6);
        }
        for (const glm::vec3 centre : {glm::vec3(0), glm::vec3(100, 0, 0)}) {
            const MaterialFacts facts =
                inspect_medium({transformed(holed, glm::mat3(1), 1, centre)});
            EXPECT_GT(facts.open_edges, 0u);
            EXPECT_TRUE(facts.has_thickness()) << "holes bound " << facts.holes;
            EXPECT_NEAR(facts.volume / facts.area, whole.volume / whole.area, 0.03 / 3);
        }
    }
    Primitive half = make_sphere(3);
    half.index.resize(half.index.size() / 2);
    EXPECT_FALSE(inspect_medium({half}).has_thickness());
    EXPECT_FALSE(inspect_medium({make_quad({}, {1, 0, 0}, {0, 0, -1}, 4)}).has_thickness());
}

// Copies of a mesh, moved, turned and scaled, have its holes. Two that touch are one surface: their
// common border is no hole. What all of them have by one search of the whole surface is the truth.
TEST(InspectScene, CopiesHaveTheHolesOfTheirMeshAndJoinWhereTheyTouch) {
    Primitive holed = make_sphere(3);
    holed.index.erase(holed.index.begin() + 300, holed.index.begin() + 306);
    holed.index.erase(holed.index.begin() + 1200, holed.index.begin() + 1203);
    const auto tile = [](float x) { return make_quad({x, -9, 0}, {0, 0, 1}, {1, 0, 0}, 4); };
    std::vector<Primitive> primitives{holed, transformed(holed, some_rotation(), 0.3f, {4, 0, 1}),
                                      transformed(holed, glm::mat3(1), 2.5f, {9, 1, 0}), tile(0),
                                      tile(1)};
    Primitive other = make_sphere(2, 0.5f, {0, 7, 0});  // of the same mesh by its name alone
    other.index.resize(60);
    primitives.push_back(other);
    const auto scene = tests::make_translucent_scene(primitives, tests::make_grey_medium(40, 1));
    const BodyShells all = make_body_shells(scene, 0);
    const MaterialFacts facts = inspect_scene(scene).material[0];
    EXPECT_EQ(facts.open_edges, all.open_edges);
    EXPECT_NEAR(facts.holes, bound_hole_area(all) / facts.area, 1e-5 * facts.holes);
}

// So that 200 dragons are inspected as one: turned, moved and scaled, but not stretched.
TEST(PartsApart, ACopyIsKnownByItsDistances) {
    const Primitive mesh = star(0.2, 3);
    const float sine = 0.6f, cosine = 0.8f;
    const glm::mat3 turn(cosine, sine, 0, -sine, cosine, 0, 0, 0, 1);
    const auto scale = scale_of_copy(transformed(mesh, turn, 3, {100, 0, 5}), mesh);
    ASSERT_TRUE(scale);
    EXPECT_NEAR(*scale, 3, 1e-4);
    EXPECT_FALSE(
        scale_of_copy(transformed(mesh, glm::mat3(1, 0, 0, 0, 1.1f, 0, 0, 0, 1), 1, {}), mesh));
}

// Along each axis: which boxes meet does not depend on the one that is swept.
TEST(PartsApart, ATowerOfTwoThatTouchOneAboveAndOneBesideHasThreeParts) {
    for (const glm::vec3 up : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)}) {
        const glm::vec3 beside(up.z, up.x, up.y);
        const auto scene = tests::make_translucent_scene(
            {make_sphere(1, 1, 9.0f * up), make_sphere(1), make_sphere(1, 1, 1.9f * up),
             make_sphere(1, 1, 2.5f * beside)},
            tests::make_grey_medium(40, 1));
        EXPECT_THAT(list_parts_apart(scene, 0),
                    testing::ElementsAre(testing::ElementsAre(0u), testing::ElementsAre(1u, 2u),
                                         testing::ElementsAre(3u)));
    }
}

// Shallow everywhere, but wide: each edge folds by little, all of them by much.
Primitive bowl() {
    Primitive p = make_sphere(5);
    for (glm::vec3& x : p.position) {
        x.y *= 0.2f + 0.8f * std::min(1.0f, 1.2f * (x.x * x.x + x.z * x.z));
    }
    return p;
}

TEST(InspectScene, ConvexBodiesAreToldFromOthers) {
    EXPECT_TRUE(is_convex(star(0, 4)));
    EXPECT_FALSE(is_convex(star(0.06, 4))) << "nearly a ball";
    EXPECT_TRUE(is_convex(roll(0.25)));
    EXPECT_FALSE(is_convex(roll(2))) << "bends one way everywhere";
    EXPECT_FALSE(is_convex(bowl()));
    // Turned and moved, no four points of a side are in a plane any more.
    const Primitive p = transformed(make_cube(40, false), some_rotation(), 0.37f, {3, -2, 5});
    EXPECT_TRUE(is_convex(p));
    EXPECT_TRUE(inspect_scene(make_scene({p})).is_open());
}

TEST(InspectScene, NothingStandsAboveTheHorizonsOfAConvexBodyAlone) {
    const auto is_open = [](std::vector<Primitive> primitives) {
        return inspect_scene(make_scene(std::move(primitives))).is_open();
    };
    EXPECT_TRUE(is_open({make_sphere(3)}));
    EXPECT_TRUE(is_open({make_cube(4, false)}));
    EXPECT_TRUE(is_open({transformed(make_sphere(3), some_rotation(), 1e-4f, {1, 0, 2})}));
    // Tiles of one floor.
    EXPECT_TRUE(is_open(
        {make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), make_quad({1, 0, 0}, {0, 0, 1}, {1, 0, 0})}));
    EXPECT_FALSE(is_open({make_cube(4, true)})) << "a room";
    EXPECT_FALSE(is_open({make_sphere(3), make_sphere(3, 1, {5, 0, 0})})) << "two balls";
    EXPECT_FALSE(is_open({make_sphere(3), make_sphere(3, 1.0001f)})) << "a ball within another";
    EXPECT_FALSE(is_open({make_sphere(3), make_quad({-5, -1, -5}, {0, 0, 10}, {10, 0, 0})}))
        << "a ball on a floor";
}

TEST(InspectScene, ARoofOverAPointCountsHoweverLowItsCornersStand) {
    Primitive roof = make_quad({-100, 0.01f, -100}, {200, 0, 0}, {0, 0, 200});
    const MaterialFacts facts =
        inspect({make_quad({0, 0, 0}, {0, 0, 0.001f}, {0.001f, 0, 0}), roof});
    EXPECT_EQ(facts.horizon.elevation, 1);
}

TEST(InspectScene, NormalsThatLeanMoreThanTheirFacetsSeeTheBodyItself) {
    const auto leaning = [](double angle) {
        Primitive p = make_cube(2, false);
        for (glm::vec3& n : p.normal) {
            n = glm::mat3(glm::rotate(glm::mat4(1), static_cast<float>(angle), {0.6f, 0, 0.8f})) *
                n;
        }
        return inspect({p}).horizon.elevation;
    };
    EXPECT_NEAR(leaning(0.02), 0.02, 0.02);
    EXPECT_GE(leaning(0.02), 0.019);
    EXPECT_EQ(leaning(0.1), 1);
}

TEST(InspectScene, ElevationBoundsEveryPointOfEveryTriangle) {
    const Primitive p = transformed(star(0.03), some_rotation(), 1, {});
    std::vector<HorizonTree::Triangle> triangles;
    for (std::size_t i = 0; i < p.index.size(); i += 3) {
        triangles.push_back(
            {p.position[p.index[i]], p.position[p.index[i + 1]], p.position[p.index[i + 2]]});
    }
    const HorizonTree tree = make_horizon_tree(triangles);
    for (std::size_t v = 0; v < p.position.size(); v += 17) {
        HorizonSearch search{0, 0, 1, 1'000'000};
        look_over_horizon(tree, p.position[v], glm::dvec3(p.normal[v]), search);
        ASSERT_FALSE(search.nodes_left <= 0);
        double highest = 0;
        for (const auto& [a, b, c] : triangles) {
            for (int i = 0; i <= 6; ++i) {
                for (int j = 0; i + j <= 6; ++j) {
                    const glm::dvec3 to = (i / 6.0) * glm::dvec3(a) + (j / 6.0) * glm::dvec3(b) +
                                          ((6 - i - j) / 6.0) * glm::dvec3(c) -
                                          glm::dvec3(p.position[v]);
                    const double length = glm::length(to);
                    if (length > 1e-6) {
                        highest = std::max(highest, glm::dot(glm::dvec3(p.normal[v]), to) / length);
                    }
                }
            }
        }
        EXPECT_GE(search.sine, highest - 1e-9) << v;
        EXPECT_LE(search.sine, 3 * highest + 1e-9) << v;
    }
}

TEST(InspectScene, ConstantColoursAreToldFromOthers) {
    auto scene = make_scene({make_cube(1, false)});
    EXPECT_EQ(inspect_scene(scene).material[0].color_contrast, 0);
    EXPECT_EQ(inspect_scene(scene).material[0].brightest_vertex, 1);
    scene.primitives[0].color.assign(24, {0.5f, 0.25f, 0.125f});
    EXPECT_EQ(inspect_scene(scene).material[0].color_contrast, 0);
    EXPECT_EQ(inspect_scene(scene).material[0].brightest_vertex, 0.5f);
    scene.primitives[0].color[3].g = 0.75f;
    EXPECT_EQ(inspect_scene(scene).material[0].color_contrast, 0.5f);

    scene.primitives[0].color.clear();
    scene.images.push_back({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
    scene.materials[0].base_color_image = 0;
    EXPECT_EQ(inspect_scene(scene).material[0].color_contrast, 0) << "alpha is no colour";
    scene.images[0].rgba[5] = 0;
    EXPECT_EQ(inspect_scene(scene).material[0].color_contrast, 1);
}

// On the side where the light arrives: black paper with a lobe is not black for others.
TEST(InspectScene, ThinWallsSendOnWhatTheirLobesMirrorInItsColour) {
    auto scene = make_scene({make_sphere(1)});
    formats::Material& paper = scene.materials[0];
    paper.base_color = {0.5f, 0.5f, 0.5f};
    paper.sheet = formats::Sheet{.reflect = {0.3f, 0.3f, 0.3f}, .transmit = {0.2f, 0.2f, 0.2f}};
    EXPECT_NEAR(inspect_scene(scene).material[0].surroundings.brightest, 0.25, 1e-6);
    EXPECT_TRUE(inspect_scene(scene).material[0].surroundings.is_grey);
    paper.gloss.specular = 1;
    paper.gloss.roughness = 0.3f;
    EXPECT_GT(inspect_scene(scene).material[0].surroundings.brightest, 0.32);
    EXPECT_TRUE(inspect_scene(scene).material[0].surroundings.is_grey);
    paper.gloss.specular_color = {1, 0.5f, 0};
    EXPECT_FALSE(inspect_scene(scene).material[0].surroundings.is_grey);
}

TEST(InspectScene, MediaAreGreyOnlyIfAllThreeBandsAreExactlyAlike) {
    auto scene = make_scene({make_sphere(1)});
    formats::Medium& medium = scene.materials[0].medium.emplace();
    medium.sigma_s = {5, 5, 5};
    medium.sigma_a = {1, 1, 1};
    EXPECT_TRUE(inspect_scene(scene).material[0].is_grey);
    EXPECT_TRUE(inspect_scene(scene).material[0].mirrors);
    medium.sigma_a.b = std::nextafter(1.0f, 2.0f);
    medium.eta = 1;
    EXPECT_FALSE(inspect_scene(scene).material[0].is_grey);
    EXPECT_FALSE(inspect_scene(scene).material[0].mirrors);
}

}  // namespace
}  // namespace opaline::bake
