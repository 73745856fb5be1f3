#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Rgb;
using tests::all_finite;
using tests::bake_scene;
using tests::make_grey_medium;
using tests::make_translucent_scene;
using tests::relative_rms;
using tests::relight_primitive;
using tests::small_bake;
using tests::turned_inside_out;

BakeResult bake(std::vector<Primitive> primitives, const BakeOptions& options = small_bake()) {
    return bake_scene(make_translucent_scene(std::move(primitives), make_grey_medium(10, 0.2f)),
                      options);
}

std::vector<Rgb> studio(const BakeResult& result) {
    return relight_primitive(result.asset, "studio");
}

// Unit ball, 162 vertices: what several cases compare with.
const BakeResult& plain_ball() {
    static const BakeResult ball = bake({tests::make_sphere(2)});
    return ball;
}

// What is said of the mesh: that light crosses the body, and what lies between vertices, is not.
std::vector<formats::Diagnostic> faults_of_mesh(const BakeResult& result) {
    std::vector<formats::Diagnostic> faults;
    for (const formats::Diagnostic& warning : result.warnings) {
        if (warning.fault.find("turned outward") != std::string::npos ||
            warning.fault.find("open at") != std::string::npos) {
            faults.push_back(warning);
        }
    }
    return faults;
}

// A ball with dents deep enough to shadow each other.
Primitive dented() {
    auto ball = tests::make_sphere(3);
    for (glm::vec3& p : ball.position) {
        p *= 1 + 0.15f * std::sin(5 * p.x) * std::sin(6 * p.y + 1);
    }
    return ball;
}

TEST(Mesh, BodyInsideOutLooksLikeTheOneThatIsNot) {
    const BakeResult right = bake({dented()});
    const BakeResult turned = bake({turned_inside_out(dented())});
    EXPECT_TRUE(faults_of_mesh(right).empty());
    EXPECT_EQ(faults_of_mesh(turned).size(), 1u);
    // Another order of corners rounds otherwise.
    EXPECT_LT(relative_rms(studio(turned), studio(right)), 0.01);
}

TEST(Mesh, ShellWithinABodyOfTheSameMediumChangesNothing) {
    const Primitive outer = tests::make_sphere(3);
    BakeOptions options = small_bake();
    options.set(kSamples, 8000);
    const BakeResult alone = bake({outer}, options);
    const BakeResult nested = bake({outer, tests::make_sphere(2, 0.6f, {0.1f, 0, 0})}, options);
    EXPECT_TRUE(faults_of_mesh(nested).empty());
    // The sum over the outer surface has other samples, fewer of them.
    EXPECT_LT(relative_rms(studio(nested), studio(alone)), 0.01);
    EXPECT_TRUE(all_finite(nested.asset));
}

TEST(Mesh, AHoleIsReportedAndDarkensItsSurroundingsOnly) {
    const BakeResult whole = bake({tests::make_sphere(3)});
    Primitive open = tests::make_sphere(3);
    open.index.resize(open.index.size() - 12);  // four of 1280 triangles
    const BakeResult result = bake({open});
    ASSERT_EQ(faults_of_mesh(result).size(), 1u);
    EXPECT_NE(faults_of_mesh(result)[0].fault.find("open at"), std::string::npos);
    EXPECT_TRUE(all_finite(result.asset));
    EXPECT_LT(relative_rms(studio(result), studio(whole)), 0.05);
}

TEST(Mesh, WhatWalksLoseThroughAHoleIsStated) {
    Primitive open = tests::make_sphere(2);
    const auto losses = [](const Primitive& body) {
        std::string text;
        for (const auto& warning : bake({body}, bake_by(kWalked, 20000)).warnings) {
            text += warning.fault.find("random walks") == std::string::npos ? "" : warning.fault;
        }
        return text;
    };
    EXPECT_EQ(losses(open), "");
    open.index.resize(open.index.size() - 60);  // 20 of 320 triangles
    EXPECT_NE(losses(open).find("leave through holes"), std::string::npos);
}

TEST(Mesh, VerticesThatStandTwiceLookTheSame) {
    // Each triangle with vertices of its own, as exporters leave them.
    const Primitive shared = tests::make_sphere(2);
    Primitive split = shared;
    split.position.clear();
    split.normal.clear();
    for (std::uint32_t i = 0; i < split.index.size(); ++i) {
        split.position.push_back(shared.position[shared.index[i]]);
        split.normal.push_back(shared.normal[shared.index[i]]);
        split.index[i] = i;
    }
    const BakeResult b = bake({split});
    EXPECT_TRUE(faults_of_mesh(b).empty()) << "it is closed";
    const std::vector<Rgb> once = studio(plain_ball());
    std::vector<Rgb> expected;
    for (const std::uint32_t i : shared.index) {
        expected.push_back(once[i]);
    }
    EXPECT_LT(relative_rms(studio(b), expected), 1e-3);
}

TEST(Mesh, TrianglesWithoutAreaChangeNothing) {
    Primitive body = tests::make_sphere(2);
    for (std::uint32_t v = 0; v + 2 < 40; v += 2) {
        body.index.insert(body.index.end(), {v, v, v + 1, v, v, v});
    }
    const BakeResult result = bake({body});
    EXPECT_TRUE(faults_of_mesh(result).empty());
    EXPECT_TRUE(all_finite(result.asset));
    EXPECT_LT(relative_rms(studio(result), studio(plain_ball())), 2e-3);
}

TEST(Mesh, VertexWithoutANormalIsDarkAndSpoilsNoOther) {
    Primitive body = tests::make_sphere(2);
    const std::vector<Rgb> clean = studio(plain_ball());
    body.normal[7] = glm::vec3(0);
    body.position.push_back({0, 0, 5});  // and one that no triangle has
    body.normal.push_back(glm::vec3(0));
    const BakeResult result = bake({body});
    EXPECT_TRUE(all_finite(result.asset));
    std::vector<Rgb> found = studio(result);
    EXPECT_EQ(found[7], Rgb{});
    EXPECT_EQ(found.back(), Rgb{});
    found[7] = clean[7];
    found.pop_back();
    EXPECT_LT(relative_rms(found, clean), 0.01);
}

TEST(Mesh, CreasesAndCornersAreSmoothInTheirNeighbourhood) {
    // On an edge of a box the inward normal runs along the other sides' planes.
    Primitive box = tests::make_cube(8, false);
    for (std::size_t v = 0; v < box.normal.size(); ++v) {
        box.normal[v] = glm::normalize(box.position[v] * box.position[v] * box.position[v]);
    }
    const BakeResult result = bake({box});
    EXPECT_TRUE(all_finite(result.asset));
    const std::vector<Rgb> white = relight_primitive(result.asset, "white");
    for (std::size_t v = 0; v < white.size(); ++v) {
        // Corners get more than their share of light, but not another order.
        EXPECT_GT(white[v].g, 0.1f) << v;
        EXPECT_LT(white[v].g, 1.2f) << v;
    }
    // Copies of one vertex on two or three sides are one.
    for (std::size_t v = 0; v < white.size(); ++v) {
        for (std::size_t w = 0; w < v; ++w) {
            if (box.position[v] == box.position[w]) {
                EXPECT_NEAR(white[v].g, white[w].g, 0.02f * white[w].g) << v << ' ' << w;
            }
        }
    }
}

TEST(Mesh, NormalsThatLeaveTheBodyAreDarkerAndDisturbNoOther) {
    Primitive body = tests::make_sphere(2);
    for (std::size_t v = 0; v < body.normal.size(); v += 5) {
        body.normal[v] = -body.normal[v];
    }
    const std::vector<Rgb> expected = relight_primitive(plain_ball().asset, "white");
    const std::vector<Rgb> found = relight_primitive(bake({body}).asset, "white");
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (v % 5 == 0) {
            // What scatters many times asks only where a vertex is.
            EXPECT_LT(found[v].g, 0.9f * expected[v].g) << v;
        } else {
            EXPECT_NEAR(found[v].g, expected[v].g, 0.03f * expected[v].g) << v;
        }
    }
}

TEST(Mesh, EmptyAndFlatBodiesBakeToNothing) {
    Primitive flat = tests::make_sphere(1);
    for (glm::vec3& p : flat.position) {
        p = glm::vec3(1, 2, 3);
    }
    Primitive loose = tests::make_sphere(0);
    loose.index.clear();
    const BakeResult result = bake({flat, loose});
    ASSERT_EQ(result.asset.position.size(), flat.position.size() + loose.position.size());
    EXPECT_TRUE(result.asset.transport.index16.empty());
    for (const char* light : {"white", "sun:40,50"}) {
        for (std::size_t primitive = 0; primitive < 2; ++primitive) {
            for (const Rgb c : relight_primitive(result.asset, light, primitive)) {
                EXPECT_EQ(c, Rgb{}) << light;
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
