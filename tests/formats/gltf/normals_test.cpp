#include <limits>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

/// The cube [-1,1]^3 as 12 triangles with 36 corners of their own, nothing shared.
std::vector<float> cube_soup() {
    std::vector<float> out;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            const float corner[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
            for (int i = 0; i < 6; ++i) {
                const auto& c = corner[side > 0 ? i : 5 - i];
                float p[3];
                p[axis] = side;
                p[(axis + 1) % 3] = c[0];
                p[(axis + 2) % 3] = c[1];
                out.insert(out.end(), p, p + 3);
            }
        }
    }
    return out;
}

glm::vec3 normal_of_face(const formats::Primitive& p, std::size_t corner) {
    const std::size_t t = corner / 3 * 3;
    const glm::vec3 a = p.position[p.index[t]];
    return glm::normalize(
        glm::cross(p.position[p.index[t + 1]] - a, p.position[p.index[t + 2]] - a));
}

/// The same cube of eight vertices.
AssetBuilder welded_cube(Json more = Json::object()) {
    std::vector<float> position;
    for (int v = 0; v < 8; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            position.push_back((v >> axis & 1) != 0 ? 1.0f : -1.0f);
        }
    }
    const std::vector<float> soup = cube_soup();
    std::vector<std::uint8_t> index;
    for (std::size_t i = 0; i < soup.size(); i += 3) {
        index.push_back(static_cast<std::uint8_t>(
            (soup[i] > 0 ? 1 : 0) + (soup[i + 1] > 0 ? 2 : 0) + (soup[i + 2] > 0 ? 4 : 0)));
    }
    AssetBuilder asset;
    more["indices"] = asset.add<std::uint8_t>(index, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", asset.add<float>(position, "VEC3")}}, more));
    return asset;
}

TEST(GltfNormals, WithoutNormalACubeHasFlatFaces) {
    AssetBuilder soup;
    soup.add_node(soup.add_mesh({{"POSITION", soup.add<float>(cube_soup(), "VEC3")}}));
    for (const AssetBuilder& asset : {soup, welded_cube()}) {
        const auto imported = must_import(asset);
        const auto& p = imported.scene.primitives.at(0);
        ASSERT_EQ(p.index.size(), 36u);
        for (std::size_t c = 0; c < 36; ++c) {
            EXPECT_LT(glm::length(p.normal[p.index[c]] - normal_of_face(p, c)), 1e-6f) << c;
        }
        EXPECT_THAT(imported.notes,
                    ::testing::ElementsAre(
                        HasSubstr("NORMAL is missing in 1 primitives and is computed: flat")));
        EXPECT_EQ(lines(imported.warnings), "");
    }
}

// A game uploads rows beside the vertices that it has: those keep their numbers.
TEST(GltfNormals, CopiesForFlatFacesFollowTheVerticesOfTheFile) {
    AssetBuilder asset = welded_cube();
    std::vector<float> texcoord, color;
    for (int v = 0; v < 8; ++v) {
        texcoord.insert(texcoord.end(), {0.125f * static_cast<float>(v), 1});
        color.insert(color.end(), {0.125f * static_cast<float>(v), 0, 0, 1});
    }
    Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = asset.add<float>(texcoord, "VEC2");
    attributes["COLOR_0"] = asset.add<float>(color, "VEC4");
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    ASSERT_EQ(p.position.size(), 24u);  // a corner of a cube has three normals
    for (int v = 0; v < 8; ++v) {
        EXPECT_EQ(p.position[v].x, (v & 1) != 0 ? 1.0f : -1.0f);
        EXPECT_EQ(p.texcoord[v].x, 0.125f * static_cast<float>(v));
    }
    for (std::size_t c = 0; c < 36; ++c) {
        const glm::vec3 at = p.position[p.index[c]];
        const float v = (at.x > 0 ? 1.0f : 0) + (at.y > 0 ? 2.0f : 0) + (at.z > 0 ? 4.0f : 0);
        EXPECT_EQ(p.texcoord[p.index[c]].x, 0.125f * v);
        EXPECT_EQ(p.color[p.index[c]].r, 0.125f * v);
    }
    EXPECT_THAT(imported.notes.at(0), HasSubstr("16 vertices are added where faces differ"));
}

TEST(GltfNormals, FacesInOnePlaneShareTheirVertices) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const auto index = asset.add<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}),
                   {{"rotation", {0.1, 0.2, 0.3, 0.9}}});
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).position.size(), 4u);
    EXPECT_THAT(imported.notes.at(0), ::testing::Not(HasSubstr("are added")));
}

TEST(GltfNormals, EdgesBelowTheGivenAngleAreSmooth) {
    // Three right angles meet at each corner whichever way the faces are cut, so that weights by
    // angle give exactly the diagonal; weights by face or by area would not.
    for (const double angle : {89.0, 91.0, 180.0}) {
        const auto imported = must_import(welded_cube(), {.smooth_angle = angle});
        const auto& p = imported.scene.primitives.at(0);
        for (std::size_t c = 0; c < 36; ++c) {
            const glm::vec3 expected =
                angle < 90 ? normal_of_face(p, c) : glm::normalize(p.position[p.index[c]]);
            EXPECT_LT(glm::length(p.normal[p.index[c]] - expected), 1e-6f) << angle;
        }
        EXPECT_EQ(p.position.size(), angle < 90 ? 24u : 8u);
    }
    EXPECT_FALSE(import_asset(welded_cube(), {.smooth_angle = 181}).has_value());
}

TEST(GltfNormals, ComputedNormalsOfAMirroredCubePointOutwards) {
    AssetBuilder asset = welded_cube();
    asset.json["nodes"][0]["scale"] = {1, -2, 1};
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    for (const std::uint32_t v : p.index) {
        EXPECT_GT(glm::dot(p.normal[v], p.position[v]), 0.9f);
    }
}

TEST(GltfNormals, DuplicatedVerticesAndSplitPrimitivesShowNoSeam) {
    // A fold along x = 0, its two sides in primitives of their own.
    AssetBuilder asset;
    const auto left = asset.add<float>({0, 0, 0, 0, 1, 0, -1, 0, -1}, "VEC3");
    const auto right = asset.add<float>({0, 1, 0, 0, 0, 0, 1, 0, -1}, "VEC3");
    const auto mesh = asset.add_mesh({{"POSITION", left}});
    asset.json["meshes"][mesh]["primitives"].push_back({{"attributes", {{"POSITION", right}}}});
    asset.add_node(mesh);
    const auto imported = must_import(asset, {.smooth_angle = 120});
    const auto& a = imported.scene.primitives.at(0).normal;
    const auto& b = imported.scene.primitives.at(1).normal;
    EXPECT_EQ(a[0], b[1]);
    EXPECT_EQ(a[1], b[0]);
    EXPECT_NEAR(a[0].x, 0.0f, 1e-6f);  // by symmetry, up to rounding
    EXPECT_GT(a[0].z, 0.9f);
}

TEST(GltfNormals, BothSidesOfASheetKeepTheirOwnNormals) {
    AssetBuilder asset;
    const auto position =
        asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}}));
    const auto imported = must_import(asset);
    const auto& normal = imported.scene.primitives.at(0).normal;
    for (int v = 0; v < 3; ++v) {
        EXPECT_EQ(normal[v], glm::vec3(0, 0, 1));
        EXPECT_EQ(normal[v + 3], glm::vec3(0, 0, -1));
    }
}

TEST(GltfNormals, NonManifoldFacesStillCount) {
    // Three walls on one edge, which no manifold has.
    AssetBuilder asset;
    const auto position =
        asset.add<float>({0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 1, -1, 0, -1}, "VEC3");
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 1, 3, 0, 1, 4}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    ::testing::internal::CaptureStderr();
    const auto imported = must_import(asset, {.smooth_angle = 180});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");  // libraries never print
    const auto& p = imported.scene.primitives.at(0);
    for (const auto& normal : p.normal) {
        EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
    }
    EXPECT_EQ(p.position.size(), 5u) << "all three are smooth across the edge";
}

TEST(GltfNormals, NormalsWithoutDirectionAreRepairedAndCounted) {
    AssetBuilder asset = triangle_asset();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 0, nan, 0, 1, 0, 0, 2}, "VEC3");
    const auto imported = must_import(asset);
    EXPECT_THAT(imported.scene.primitives.at(0).normal, Each(glm::vec3(0, 0, 1)));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("2 values of NORMAL had no direction"));
}

TEST(GltfNormals, LooseVerticesGetNoNormalAndAreCounted) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9}, "VEC3");
    const auto index = asset.add<std::uint32_t>({0, 1, 2}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    EXPECT_EQ(p.position.size(), 4u);
    EXPECT_EQ(p.normal[3], glm::vec3(0));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("1 vertices have neither a normal nor a face"));
}

TEST(GltfNormals, ZeroAreaTrianglesStayAndDoNotSpoilNormals) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 0, 1, 2, 2, 2}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).index.size(), 9u);
    EXPECT_THAT(imported.scene.primitives.at(0).normal, Each(glm::vec3(0, 0, 1)));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("2 of 3 triangles have no area"));
}

}  // namespace
}  // namespace opaline::tests
