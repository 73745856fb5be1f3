// Vertices of one place and one normal share their rows: the file of an unwelded mesh is that of
// the welded one, vertex by vertex.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

#include "bake/effects/effects.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/scene/shared_rows.h"
#include "tests/support/bake.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Rgb;
using formats::Scene;

Primitive take_vertices(const Primitive& from, const std::vector<std::uint32_t>& vertices,
                        std::vector<std::uint32_t> index) {
    Primitive p = from;
    p.position.clear();
    p.normal.clear();
    for (const std::uint32_t v : vertices) {
        p.position.push_back(from.position[v]);
        p.normal.push_back(from.normal[v]);
    }
    p.index = std::move(index);
    return p;
}

// Numbered as triangles use them, so that both meshes below have the same receivers in one order.
Primitive ordered_by_use(const Primitive& from) {
    std::vector<std::uint32_t> vertices, index;
    std::vector<std::optional<std::uint32_t>> number(from.position.size());
    for (const std::uint32_t v : from.index) {
        if (!number[v]) {
            number[v] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(v);
        }
        index.push_back(*number[v]);
    }
    return take_vertices(from, vertices, std::move(index));
}

// A vertex of its own for each corner of each triangle.
Primitive unwelded(const Primitive& from) {
    std::vector<std::uint32_t> index(from.index.size());
    for (std::uint32_t i = 0; i < index.size(); ++i) {
        index[i] = i;
    }
    return take_vertices(from, from.index, std::move(index));
}

// A glossy floor, a ball and a block of wax, of which the block has sharp edges, a leaf that lets
// light through, a mirror; a lamp among them.
Scene make_mixed_scene() {
    Scene scene = tests::make_scene(
        {tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 7),
         tests::make_sphere(2, 0.8f, {-0.9f, 0.9f, 0}),
         tests::transformed(tests::make_cube(2, false), tests::some_rotation(), 0.5f, {1, 1, 0}),
         tests::make_quad({-1, 0.2f, 1.5f}, {2, 0.3f, 0}, {0, 1, 0.2f}, 3),
         tests::make_sphere(1, 0.4f, {0.2f, 2.2f, -0.4f})});
    scene.materials[0].gloss = {.roughness = 0.4f, .specular = 1};
    formats::Material wax{.name = "Wax"};
    wax.medium.emplace();
    wax.medium->sigma_s = {8, 6, 4};
    wax.medium->sigma_a = {0.1f, 0.2f, 0.4f};
    formats::Material leaf{.name = "Leaf"};
    leaf.sheet = formats::Sheet{.reflect = {0.5f, 0.5f, 0.5f}, .transmit = {0.2f, 0.3f, 0.1f}};
    formats::Material mirror{.name = "Mirror"};
    mirror.gloss = {.metallic = 1, .roughness = 0.2f};
    scene.materials.insert(scene.materials.end(), {wax, leaf, mirror});
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        scene.primitives[p] = ordered_by_use(scene.primitives[p]);
        scene.primitives[p].node = p;
        scene.primitives[p].material = std::array{0u, 1u, 1u, 2u, 3u}[p];
    }
    formats::Light lamp;
    lamp.name = "Lamp";
    lamp.intensity = {30, 20, 10};
    lamp.position = {0.3f, 3, 1.5f};
    scene.lights.push_back(lamp);
    return scene;
}

Scene unwelded(Scene scene) {
    for (Primitive& p : scene.primitives) {
        p = unwelded(p);
    }
    return scene;
}

BakeOptions few_walks(MultipleModel model) {
    BakeOptions options;
    options.quality = Quality::draft;
    options.threads = 2;
    options.set(kMultipleModel, static_cast<double>(model));
    options.set(kSamples, 1500);
    options.set(kWalks, 10000);
    options.set(kSites, 800);
    options.set(kEmitterParticles, 3000);
    return options;
}

void expect_same_rows(const formats::SparseRows& a, const formats::SparseRows& b) {
    EXPECT_EQ(a.row_offset, b.row_offset);
    EXPECT_EQ(a.average_scale, b.average_scale);
    EXPECT_EQ(a.detail_scale, b.detail_scale);
    EXPECT_EQ(a.average_code, b.average_code);
    EXPECT_EQ(a.index16, b.index16);
    EXPECT_EQ(a.code8, b.code8);
}

class SharedRowsBake : public testing::TestWithParam<MultipleModel> {};

TEST_P(SharedRowsBake, UnweldedMeshesHaveTheRowsOfWeldedOnesBitForBit) {
    const Scene scene = make_mixed_scene();
    const BakeResult welded = tests::bake_scene(scene, few_walks(GetParam()));
    const BakeResult apart = tests::bake_scene(unwelded(scene), few_walks(GetParam()));
    ASSERT_TRUE(welded.asset.slots.empty());
    ASSERT_FALSE(apart.asset.slots.empty());
    EXPECT_EQ(apart.asset.slots.vertex.size(), welded.asset.position.size());
    ASSERT_FALSE(welded.asset.emitters.value.empty());
    ASSERT_FALSE(welded.asset.openness.empty());
    ASSERT_TRUE(std::ranges::any_of(welded.asset.primitives, [](const auto& p) {
        return p.shading == formats::Shading::translucent;
    }));
    expect_same_rows(apart.asset.transport, welded.asset.transport);
    EXPECT_EQ(apart.asset.emitters.value, welded.asset.emitters.value);
    EXPECT_EQ(apart.error.rms_relative, welded.error.rms_relative);
    EXPECT_EQ(apart.error.between.rms_relative, welded.error.between.rms_relative);

    const formats::AssetView one = welded.asset.view(), other = apart.asset.view();
    for (const bool fresnel : {true, false}) {
        runtime::ShadeOptions options;
        options.eye = formats::Vec3{1, 2, 5};
        options.fresnel = fresnel;
        std::vector<Rgb> shown(one.receivers()), shown_apart(other.receivers());
        const auto light = tests::make_light("studio", one.cubemap_size);
        runtime::shade(one, light, shown, options);
        runtime::shade(other, light, shown_apart, options);
        for (std::size_t p = 0; p < one.primitives.size(); ++p) {
            const auto &a = one.primitives[p], &b = other.primitives[p];
            for (std::uint32_t i = 0; i < a.index_count; ++i) {
                const std::uint32_t v = a.first_vertex + one.index[a.first_index + i],
                                    u = b.first_vertex + other.index[b.first_index + i];
                ASSERT_EQ(shown_apart[u], shown[v]) << "primitive " << p << ", corner " << i;
                ASSERT_EQ(other.openness[u].fraction, one.openness[v].fraction);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, SharedRowsBake,
                         testing::Values(MultipleModel::dipole, MultipleModel::walks),
                         [](const auto& tested) {
                             return tested.param == MultipleModel::dipole ? "Dipole" : "Walks";
                         });

TEST(SharedRows, WhatIsPredictedIsThatOfSlots) {
    const Scene scene = tests::make_dented_ball();
    BakeOptions options;
    options.quality = Quality::draft;
    const BakeResult apart = tests::bake_scene(unwelded(scene), options);
    EXPECT_EQ(apart.facts.receivers, apart.asset.slots.vertex.size());
    EXPECT_GT(apart.asset.position.size(), 5 * apart.asset.slots.vertex.size());
}

TEST(SharedRows, ErrorsOfReceiversAreSaidOfEveryVertex) {
    const Scene scene = unwelded(tests::make_dented_ball());
    BakeOptions options;
    options.quality = Quality::draft;
    Context context;
    context.cache = tests::test_cache();
    const auto baked = run_bake(all_effects(), scene, *resolve_knobs(options), context,
                                BakeExtras{.receiver_errors = true});
    ASSERT_TRUE(baked);
    ASSERT_EQ(baked->receiver_errors.size(), baked->asset.position.size());
    const formats::Slots& slots = baked->asset.slots;
    for (std::size_t v = 0; v < slots.slot.size(); ++v) {
        ASSERT_EQ(baked->receiver_errors[v], baked->receiver_errors[slots.vertex[slots.slot[v]]]);
    }
}

TEST(SharedRows, OfMeshesWithoutCopiesThereAreNoneAndOffHasARowForEachVertex) {
    BakeOptions options;
    options.quality = Quality::draft;
    const Scene scene = tests::make_dented_ball();
    const BakeResult whole = tests::bake_scene(scene, options);
    EXPECT_TRUE(whole.asset.slots.empty());
    options.simplify = false;
    const BakeResult off = tests::bake_scene(scene, options);
    expect_same_rows(off.asset.transport, whole.asset.transport);
    EXPECT_EQ(off.asset.provenance, whole.asset.provenance);
    const BakeResult apart = tests::bake_scene(unwelded(scene), options);
    EXPECT_TRUE(apart.asset.slots.empty());
    EXPECT_EQ(apart.asset.transport.view().rows(), apart.asset.position.size());
}

// Colours, texture coordinates and signs of zero do not matter; another primitive does.
TEST(SharedRows, SlotsAreThoseOfOnePlaceAndOneNormalOfAPrimitive) {
    Primitive p = tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    for (std::size_t v = 0; v < 2; ++v) {
        p.position.push_back(p.position[v]);
        p.normal.push_back(v == 0 ? -1.0f * -p.normal[0] : glm::vec3(0, 0, 1));
    }
    p.position[4].x = -0.0f;
    p.color.resize(p.position.size());
    p.color[4] = {0.5f, 0.1f, 0};
    const formats::Slots slots = find_slots(tests::make_scene({p, p}));
    EXPECT_EQ(slots.slot, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 4, 5, 6, 7, 8, 5, 9}));
    EXPECT_EQ(slots.offset, (std::vector<std::uint32_t>{0, 5, 10}));
    EXPECT_EQ(slots.vertex, (std::vector<std::uint32_t>{0, 1, 2, 3, 5, 6, 7, 8, 9, 11}));
}

}  // namespace
}  // namespace opaline::bake
