// The files that `opaline example` leaves behind.
// Parts of the example `lamp`.
// Parts of the example `playing-pieces`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bake/lab/example/example_scenes.h"
#include "bake/lab/example/scene_parts.h"
#include "formats/media/load_clouds.h"
#include "formats/media/read_media.h"
#include "tests/bake/example/facing.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

namespace fs = std::filesystem;

class ExampleFiles : public testing::Test {
  protected:
    const tests::TemporaryFolder scratch_;
    const fs::path folder_ = scratch_.path();
};

std::string contents(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<GltfObject> small_scene() {
    TriangleMesh mesh;
    mesh.position = {{0, 0, 0}, {1, 0, 0.25}, {0, 2, -1}};
    mesh.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    return {{"One", "Red", {0.5, 0.1, 0.1}, mesh}, {"Two", "Blue", {0.1, 0.1, 0.5}, mesh}};
}

TEST_F(ExampleFiles, AreAGltfAndItsBuffer) {
    const fs::path target = folder_ / "new" / "folder";
    const auto files = write_example("knot", target);
    ASSERT_TRUE(files);
    EXPECT_THAT(*files, testing::ElementsAre(target / "knot.gltf", target / "knot.bin"));
    const auto document = nlohmann::json::parse(contents(target / "knot.gltf"));
    EXPECT_EQ(document["asset"]["version"], "2.0");
    EXPECT_EQ(document["asset"]["generator"], "Opaline");
    EXPECT_EQ(document["buffers"][0]["uri"], "knot.bin");
    EXPECT_EQ(document["buffers"][0]["byteLength"], fs::file_size(target / "knot.bin"));
    EXPECT_EQ(document["nodes"][0]["name"], "Knot");
    EXPECT_EQ(document["nodes"][1]["name"], "Floor");
    EXPECT_EQ(document["materials"][0]["name"], "Knot");
    EXPECT_EQ(document["materials"][1]["name"], "Floor");
    EXPECT_EQ(std::distance(fs::directory_iterator(target), {}), 2) << "a temporary file is left";
}

TEST_F(ExampleFiles, HaveTheSameBytesOnEveryRunAndForAnyNumberOfThreads) {
    for (const ExampleInfo& info : list_examples()) {
        const auto first = write_example(info.name, folder_ / "a");
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const auto second = write_example(info.name, folder_ / "b");
        ASSERT_TRUE(first && second);
        for (std::size_t i = 0; i < first->size(); ++i) {
            EXPECT_TRUE(contents((*first)[i]) == contents((*second)[i])) << (*first)[i];
        }
    }
}

TEST_F(ExampleFiles, DescribeEveryByteOfTheBufferOnce) {
    const auto files = write_gltf(folder_, "small", small_scene());
    ASSERT_TRUE(files);
    const std::string bytes = contents(folder_ / "small.bin");
    const auto document = nlohmann::json::parse(contents(folder_ / "small.gltf"));
    std::size_t end = 0;
    for (const auto& accessor : document["accessors"]) {
        const auto& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const bool vectors = accessor["type"] == "VEC3";
        const std::size_t width = vectors ? 3 : 1;
        EXPECT_EQ(view["byteOffset"], end);
        EXPECT_EQ(end % 4, 0u);
        EXPECT_EQ(view["byteLength"], accessor["count"].get<std::size_t>() * width * 4);
        EXPECT_EQ(view["target"], vectors ? 34962 : 34963);
        EXPECT_EQ(accessor["componentType"], vectors ? 5126 : 5125);
        EXPECT_EQ(accessor["min"].size(), width);
        EXPECT_EQ(accessor["max"].size(), width);
        end += view["byteLength"].get<std::size_t>();
    }
    EXPECT_EQ(end, bytes.size());
}

TEST_F(ExampleFiles, NameTheImageOfAnObjectAndHoldItsTextureCoordinates) {
    std::vector<GltfObject> objects = small_scene();
    objects[1].image = "wood.png";
    objects[1].texcoord = {{0, 0}, {1, 0}, {0.5, 1}};
    ASSERT_TRUE(write_gltf(folder_, "small", objects));
    const auto document = nlohmann::json::parse(contents(folder_ / "small.gltf"));
    EXPECT_EQ(document["images"][0]["uri"], "wood.png");
    EXPECT_EQ(document["textures"][0]["source"], 0);
    EXPECT_FALSE(document["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
    EXPECT_EQ(document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    const auto& attributes = document["meshes"][1]["primitives"][0]["attributes"];
    const auto& accessor = document["accessors"][attributes["TEXCOORD_0"].get<std::size_t>()];
    EXPECT_EQ(accessor["type"], "VEC2");
    EXPECT_EQ(accessor["count"], 3);
}

TEST_F(ExampleFiles, SayOutrightWhatIsDiffuseAndWhatIsGlossy) {
    ASSERT_TRUE(write_example("knot", folder_));
    ASSERT_TRUE(write_example("glossy", folder_));
    const auto knot = nlohmann::json::parse(contents(folder_ / "knot.gltf"));
    for (const auto& material : knot["materials"]) {
        EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0.0);
        EXPECT_EQ(material["extensions"]["KHR_materials_specular"]["specularFactor"], 0.0);
    }
    const auto glossy = nlohmann::json::parse(contents(folder_ / "glossy.gltf"));
    EXPECT_THAT(glossy["extensionsUsed"], testing::ElementsAre("KHR_materials_specular"));
    ASSERT_EQ(glossy["materials"].size(), 4u);
    for (const auto& material : glossy["materials"]) {
        const bool is_metal = material["name"] == "Brass" || material["name"] == "Steel";
        EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], is_metal ? 1.0 : 0.0);
        EXPECT_LT(material["pbrMetallicRoughness"]["roughnessFactor"], 0.7);
        EXPECT_EQ(material["extensions"]["KHR_materials_specular"]["specularFactor"], 1.0);
    }
}

TEST_F(ExampleFiles, OfBricksShareOneNormalMap) {
    ASSERT_TRUE(write_example("bricks", folder_));
    const auto document = nlohmann::json::parse(contents(folder_ / "bricks.gltf"));
    EXPECT_EQ(document["images"].size(), 1u);
    EXPECT_EQ(document["images"][0]["uri"], "bricks.png");
    for (const auto& material : document["materials"]) {
        EXPECT_EQ(material["normalTexture"]["index"], 0);
        EXPECT_FALSE(material["pbrMetallicRoughness"].contains("baseColorTexture"));
    }
    EXPECT_TRUE(fs::exists(folder_ / "bricks.png"));
}

TEST_F(ExampleFiles, RefuseAnUnknownNameAndListTheKnownOnes) {
    const auto files = write_example("dragon", folder_ / "never");
    ASSERT_FALSE(files);
    EXPECT_EQ(files.error().kind, formats::ErrorKind::usage);
    const formats::Diagnostic& diagnostic = files.error().diagnostics.front();
    EXPECT_THAT(diagnostic.fault, testing::HasSubstr("'dragon'"));
    for (const ExampleInfo& info : list_examples()) {
        EXPECT_THAT(diagnostic.remedy, testing::HasSubstr(std::string(info.name)));
    }
    EXPECT_FALSE(fs::exists(folder_ / "never"));
}

TEST_F(ExampleFiles, SayWhyAFolderCannotBeMade) {
    // A file where the folder should go stops every user, root included.
    std::ofstream(folder_ / "file") << "in the way";
    for (const fs::path& target : {folder_ / "file", folder_ / "file" / "below"}) {
        const auto files = write_example("knot", target);
        ASSERT_FALSE(files) << target;
        EXPECT_EQ(files.error().kind, formats::ErrorKind::resource);
        EXPECT_THAT(files.error().diagnostics.front().file, testing::HasSubstr("file"));
    }
}

TEST_F(ExampleFiles, LeaveNoGltfWithoutItsBuffer) {
    fs::create_directories(folder_ / "small.bin");  // the buffer's place is taken
    const auto files = write_gltf(folder_, "small", small_scene());
    ASSERT_FALSE(files);
    EXPECT_EQ(files.error().kind, formats::ErrorKind::resource);
    EXPECT_FALSE(fs::exists(folder_ / "small.gltf"));
}

TEST(LampExample, SurfacesFaceOutward) {
    expect_facing_normals(make_shade({}));
    expect_facing_normals(make_thick_shade({}, 5));
    expect_facing_normals(make_lamp_foot());
    expect_facing_normals(make_panel({}));
    expect_facing_normals(make_wall());
}

TEST(LampExample, ThickShadeIsClosed) {
    const double volume = enclosed_volume(make_thick_shade({}, 5));
    // 2 pi times the mean radius times the area of the profile; 48 chords are a little shorter.
    EXPECT_NEAR(volume / (2 * 3.14159265 * 82.5 * 5 * 120), 0.997, 0.003);
}

TEST(PlayingPieces, SurfacesFaceOutward) {
    expect_facing_normals(make_board());
    for (const TriangleMesh& piece :
         {make_pawn(0, 0), make_draughtsman(0, 0), make_squashed_ball(0, 0), make_stand(0, 0)}) {
        EXPECT_GT(enclosed_volume(piece), 1000);
        expect_facing_normals(piece);
    }
}

TEST(PlayingPieces, StandInSquaresOfTheirOwn) {
    const auto objects = make_example("playing-pieces");
    ASSERT_TRUE(objects);
    std::vector<std::pair<double, double>> squares;
    for (const GltfObject& object : *objects) {
        if (object.name == "Board" || object.name == "Floor") continue;
        glm::dvec3 low(1), high(-1);
        for (const glm::dvec3& p : object.mesh.position) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        if (object.name == "Glass") {  // on its stand
            EXPECT_GT(low.y, 0.017);
            continue;
        }
        EXPECT_NEAR(low.y, -0.0004, 1e-9) << object.name;
        constexpr double kSquare = 1e-3 * kSquareSide;
        const std::pair square{std::floor(low.x / kSquare), std::floor(low.z / kSquare)};
        EXPECT_LT(high.x, (square.first + 1) * kSquare + 1e-3) << object.name;
        EXPECT_LT(high.z, (square.second + 1) * kSquare + 1e-3) << object.name;
        EXPECT_LE(std::abs(square.first + 0.5), 4);
        EXPECT_LE(std::abs(square.second + 0.5), 4);
        EXPECT_EQ(std::ranges::count(squares, square), 0);
        squares.push_back(square);
    }
    EXPECT_EQ(squares.size(), 7u);
}

TEST(Stratus, IsAMediaFileOfALayerOverItsGround) {
    const tests::TemporaryFolder folder;
    const auto files = write_example("stratus", folder.path());
    ASSERT_TRUE(files);
    EXPECT_THAT(*files, testing::ElementsAre(folder / "stratus.json", folder / "stratus.png"));
    EXPECT_TRUE(make_example("stratus")->empty()) << "no mesh";
    const auto media = formats::read_media(files->front());
    ASSERT_TRUE(media) << media.error().diagnostics.front().fault;
    EXPECT_EQ(media->inputs.size(), 2u);
    formats::Scene scene;
    ASSERT_TRUE(formats::load_clouds(*media, scene));
    ASSERT_EQ(scene.layers.size(), 1u);
    const formats::CloudLayer& layer = scene.layers[0];
    EXPECT_TRUE(layer.repeats);
    EXPECT_EQ(layer.ground_columns, 512u);
    EXPECT_EQ(layer.ground_rows, 512u);
    EXPECT_FLOAT_EQ(*std::max_element(layer.thickness.begin(), layer.thickness.end()), 240);
    EXPECT_GT(std::count(layer.thickness.begin(), layer.thickness.end(), 0.0f), 0);
}

}  // namespace

}  // namespace opaline::bake
