// The inside of closed meshes as volumes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/media/fill_body.h"
#include "formats/media/load_volumes.h"
#include "tests/formats/media/media_text.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using formats::Volume;
using ::testing::AllOf;
using ::testing::HasSubstr;

formats::Medium milk() {
    formats::Medium medium;
    medium.sigma_s = {9, 6, 3};
    medium.sigma_a = {1, 2, 1};
    medium.phase.g = 0.7f;
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    return medium;
}

Scene milky(std::vector<Primitive> primitives) {
    Scene scene = make_scene(std::move(primitives));
    scene.materials[0].medium = milk();
    return scene;
}

formats::Result<Volume> fill(const Scene& scene, std::uint32_t voxels) {
    auto filled = formats::fill_body(scene, "Grey", voxels, "media.json", "volumes > 0");
    if (!filled) return std::move(filled).error();
    return std::move(filled->volume);
}

std::string fault_of(const Scene& scene) {
    const auto filled = fill(scene, 16);
    return filled ? "" : filled.error().diagnostics.front().fault;
}

// The sum over voxels [m^3].
double content(const Volume& volume) {
    double sum = 0;
    for (const float density : volume.density.value) {
        sum += static_cast<double>(density);
    }
    return sum * std::abs(glm::determinant(glm::dmat3(volume.density.to_scene)));
}

double mesh_content(const Primitive& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.index.size(); i += 3) {
        const glm::dvec3 a(p.position[p.index[i]]), b(p.position[p.index[i + 1]]),
            c(p.position[p.index[i + 2]]);
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return std::abs(sum);
}

TEST(FillBody, ABallHoldsWhatItsMeshEncloses) {
    for (const int voxels : {9, 32, 64}) {
        const Primitive ball = transformed(make_sphere(3), some_rotation(), 0.3f, {5, -2, 0.7f});
        const auto volume = fill(milky({ball}), static_cast<std::uint32_t>(voxels));
        ASSERT_TRUE(volume);
        EXPECT_NEAR(content(*volume) / mesh_content(ball), 1, 2e-3) << voxels;
        for (const float density : volume->density.value) {
            EXPECT_GE(density, 0);
            EXPECT_LE(density, 1);
        }
        const glm::dvec3 middle(glm::inverse(volume->density.to_scene) * glm::dvec4(5, -2, 0.7, 1));
        EXPECT_EQ(volume->density.sample(glm::vec3(middle)), 1);
    }
}

TEST(FillBody, VoxelsAtItsSurfaceHaveTheShareThatIsInside) {
    const auto volume = fill(milky({make_sphere(5)}), 32);
    ASSERT_TRUE(volume);
    const double voxel = volume->density.to_scene[0][0];
    double square = 0;
    int count = 0;
    for (int i = 0; i < 33 * 33 * 33; ++i) {
        const glm::ivec3 at(i % 33, i / 33 % 33, i / (33 * 33));
        const glm::dvec3 place(volume->density.to_scene * glm::dvec4(glm::dvec3(at), 1));
        const double beyond = (1 - glm::length(place)) / voxel;
        const auto found = static_cast<double>(volume->density.at(at));
        if (std::abs(beyond) > 0.87) {  // half a voxel's diagonal
            EXPECT_EQ(found, beyond > 0 ? 1 : 0);
        } else {
            square += std::pow(found - std::clamp(0.5 + beyond, 0.0, 1.0), 2);
            ++count;
        }
    }
    EXPECT_LT(std::sqrt(square / count), 0.08) << "of a plane through the voxel";
}

// Lines go exactly through edges of its triangles.
TEST(FillBody, ACubeOfWholeVoxelsIsFullAndNothingElseIs) {
    for (const bool inward : {false, true}) {
        const auto volume = fill(milky({make_cube(2, inward)}), 16);
        ASSERT_TRUE(volume);
        EXPECT_EQ(std::ranges::count(volume->density.value, 1.0f), 16 * 16 * 16);
        EXPECT_NEAR(content(*volume), 8, 1e-6);
    }
}

TEST(FillBody, WhereBodiesOverlapThereIsTheMediumOnce) {
    const Primitive a = make_sphere(4), b = make_sphere(4, 1, {0.8f, 0, 0});
    const auto volume = fill(milky({a, b}), 48);
    ASSERT_TRUE(volume);
    EXPECT_EQ(*std::ranges::max_element(volume->density.value), 1);
    // Two caps of height 0.6 are there twice.
    const double cap = std::numbers::pi * 0.36 * (3 - 0.6) / 3;
    EXPECT_NEAR(content(*volume), 2 * mesh_content(a) - 2 * cap, 0.02);
}

// Lines run along z: across it they miss a plate, or make it as thick as they are apart.
TEST(FillBody, PartsThinnerThanLinesAreApartAreNamed) {
    const auto warnings_with = [](glm::vec3 size) {
        glm::mat3 stretch(1);
        for (int a = 0; a < 3; ++a)
            stretch[a][a] = size[a];
        const Primitive part = transformed(make_cube(2, false), stretch, 1, {3, 0.01f, 0.02f});
        auto filled = formats::fill_body(milky({make_sphere(3), part}), "Grey", 32, "media.json",
                                         "volumes > 0");
        EXPECT_TRUE(filled);
        return std::move(filled->warnings);
    };
    EXPECT_TRUE(warnings_with({0.3f, 0.3f, 0.3f}).empty());
    EXPECT_TRUE(warnings_with({0.3f, 0.3f, 0.002f}).empty()) << "along lines it is exact";
    for (const glm::vec3 thin : {glm::vec3(0.002f, 0.3f, 0.3f), {0.3f, 0.002f, 0.3f}}) {
        const auto warnings = warnings_with(thin);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_THAT(warnings[0].fault, AllOf(HasSubstr("1 of the 2 parts"), HasSubstr("thinner")));
    }
}

TEST(FillBody, ItsMediumIsThatOfTheMaterial) {
    const auto volume = fill(milky({make_sphere(1)}), 8);
    ASSERT_TRUE(volume);
    EXPECT_EQ(volume->sigma_t, (Rgb{10, 8, 4}));
    EXPECT_EQ(volume->albedo, (Rgb{0.9f, 0.75f, 0.75f}));
    EXPECT_EQ(volume->phase.g, 0.7f);
}

TEST(FillBody, WhatIsNotClosedIsRefusedWithItsEdges) {
    Primitive open = make_sphere(2);
    open.index.resize(open.index.size() - 3);
    EXPECT_THAT(fault_of(milky({open})), AllOf(HasSubstr("not closed"), HasSubstr(" 3 edges")));
    Primitive flipped = make_sphere(2);
    std::swap(flipped.index[0], flipped.index[1]);
    EXPECT_THAT(fault_of(milky({flipped})), HasSubstr("faces the other way"));
    EXPECT_THAT(fault_of(milky({make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0})})),
                HasSubstr("not closed"));
}

TEST(FillBody, WhatHasNoMediumThatIsAlikeEverywhereIsRefused) {
    Scene scene = make_scene({make_sphere(1)});
    EXPECT_THAT(fault_of(scene), HasSubstr("no medium"));
    scene = milky({make_sphere(1)});
    scene.materials[0].medium->thickness = 0.1f;
    EXPECT_THAT(fault_of(scene), HasSubstr("no medium"));
    scene.materials[0].name = "Other";
    EXPECT_THAT(fault_of(scene), HasSubstr("no surface of material 'Grey'"));
    scene = milky({make_sphere(1)});
    scene.materials[0].medium->sigma_s = {1e9f, 1, 1};
    EXPECT_THAT(fault_of(scene), HasSubstr("million mean free paths"));
    // Two sheets in one place enclose nothing.
    Primitive flat = make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    flat.index.insert(flat.index.end(), flat.index.rbegin(), flat.index.rend());
    EXPECT_THAT(fault_of(milky({flat})), HasSubstr("no inside"));
    Primitive point = make_sphere(1, 0);
    EXPECT_THAT(fault_of(milky({point})), HasSubstr("no inside"));
}

TEST(FillBody, TooFarOrTooOftenOneAboveTheOtherIsRefused) {
    Scene scene = milky({make_sphere(1)});
    scene.origin = {0, 2e9, 0};
    EXPECT_THAT(fault_of(scene), HasSubstr("beyond 1e9 m"));
    std::vector<Primitive> cubes(2, make_cube(2, false));
    EXPECT_EQ(fault_of(milky(cubes)), "");
    cubes.resize(2000, cubes.front());
    EXPECT_THAT(fault_of(milky(cubes)), HasSubstr("one above the other"));
}

class LoadBody : public testing::Test {
  protected:
    static formats::MediaFile media(int entries) {
        formats::MediaFile file;
        for (int i = 0; i < entries; ++i) {
            formats::VolumeEntry entry;
            entry.where = "volumes > " + std::to_string(i);
            entry.material = "Grey";
            entry.voxels = 16;
            file.volumes.push_back(entry);
        }
        return file;
    }
};

TEST_F(LoadBody, TheSurfaceGoesAndOtherPrimitivesKeepTheirNumbers) {
    Scene scene = milky({make_sphere(2), make_quad({3, 0, 0}, {1, 0, 0}, {0, 1, 0})});
    scene.materials.push_back({.name = "Board"});
    scene.primitives[1].material = 1;
    scene.origin = {1000, 0, 0};
    ASSERT_TRUE(formats::load_volumes(media(1), 1, scene));
    EXPECT_TRUE(scene.primitives[0].index.empty());
    EXPECT_TRUE(scene.primitives[0].position.empty());
    EXPECT_EQ(scene.primitives[1].index.size(), 6u);
    EXPECT_FALSE(scene.materials[0].medium);
    ASSERT_EQ(scene.volumes.size(), 1u);
    const auto corners = scene.volumes[0].density.corners();
    EXPECT_NEAR((corners[0].x + corners[7].x) / 2, 0, 1e-9) << "in the scene's frame";
}

TEST_F(LoadBody, OneMaterialIsOneVolume) {
    Scene scene = milky({make_sphere(2)});
    const auto twice = formats::load_volumes(media(2), 1, scene);
    ASSERT_FALSE(twice);
    EXPECT_THAT(twice.error().diagnostics.front().fault, HasSubstr("same material as volumes > 0"));
    EXPECT_FALSE(scene.primitives[0].index.empty()) << "nothing has changed";
}

TEST(ReadBody, AMaterialStandsInPlaceOfAFile) {
    const auto read = read_text_as_media(R"({"volumes": [{"material": "Wax", "voxels": 96}]})");
    ASSERT_TRUE(read) << faults(read);
    EXPECT_EQ(read->volumes.at(0).material, "Wax");
    EXPECT_EQ(read->volumes[0].voxels, 96u);
    for (const char* entry :
         {R"({"material": ""})", R"({"material": 3})", R"({"material": "Wax", "voxels": 7})",
          R"({"material": "Wax", "voxels": 1000})", R"({"material": "Wax", "file": "a.vdb"})",
          R"({"material": "Wax", "sigma_t": [1, 1, 1]})", R"({"voxels": 64})"}) {
        EXPECT_FALSE(read_text_as_media(std::string(R"({"volumes": [)") + entry + "]}")) << entry;
    }
}

}  // namespace
}  // namespace opaline::tests
