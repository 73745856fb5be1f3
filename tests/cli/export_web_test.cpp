// The folder that `export-web` writes; tests/runtime/web looks at the page.
// The glTF file that `export-gltf` writes; tests/gltf_viewers.sh looks at it in viewers.
#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/cli/small_scene.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ExportWeb, FolderHasEachLightAndReplacesAnEarlierOne) {
    SmallScene small;
    const std::string page = small.path("page");
    const Arguments command = {"export-web", small.baked(), "-o", page};
    const Outcome before = run_well(join(command, {"--light", "studio", "--light", "white"}));
    EXPECT_THAT(before.err, HasSubstr("with 2 lights; open"));
    EXPECT_THAT(list_folder(page), Contains("light-1.js"));
    EXPECT_THAT(read_text(page + "/contents.js"),
                HasSubstr(R"(opaline.lights = ["studio","white"])"));
    EXPECT_THAT(read_text(page + "/contents.js"), HasSubstr(R"(opaline.title = "scene")"));
    run_well(join(command, {"--light", "sun:10,20"}));
    EXPECT_THAT(list_folder(page), Not(Contains("light-1.js")));
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"page", "scene.glb", "scene.opal"}));
}

TEST(ExportWeb, APageWithTheLightsByDefaultIsSmall) {
    SmallScene small;
    const std::string page = small.path("page");
    run_well({"export-web", small.baked(), "-o", page});
    std::uintmax_t bytes = 0;
    for (const std::string& name : list_folder(page)) {
        bytes += std::filesystem::file_size(page + "/" + name);
    }
    EXPECT_LT(bytes, 2'000'000u);
}

TEST(ExportWeb, FolderThatHoldsOtherThingsStaysAsItIs) {
    SmallScene small;
    const std::string folder = small.path("mine"), file = small.path("note");
    std::filesystem::create_directory(folder);
    std::ofstream(folder + "/letter.txt") << "dear";
    std::ofstream(file) << "note";
    for (const std::string& output : {folder, file}) {
        expect_refused({"export-web", small.baked(), "-o", output}, 2, "");
    }
    EXPECT_EQ(list_folder(folder), Arguments{"letter.txt"});
    EXPECT_EQ(read_text(file), "note");
}

TEST(ExportWeb, NothingIsWrittenOfWhatCannotBeShown) {
    SmallScene small;
    const std::string page = small.path("page");
    expect_refused({"export-web", small.path("none.opal"), "-o", page}, 3, "");
    expect_refused({"export-web", small.baked(), "-o", page, "--light", "sky:99,10"}, 2, "");
    expect_refused({"export-web", small.scene(), "-o", page}, 3, "");
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

// COLOR_0 of a file and the radiance of `relight`, both of two primitives of four vertices, agree
// up to a factor of each primitive.
void expect_colors(const formats::Scene& scene, const std::string& table,
                   const std::array<double, 2>& factor) {
    std::istringstream lines(table);
    std::string line;
    std::getline(lines, line);
    double sum = 0;
    for (std::size_t p = 0; p < 2; ++p) {
        for (std::size_t v = 0; v < 4; ++v) {
            std::getline(lines, line);
            double r = 0, g = 0, b = 0;
            ASSERT_EQ(std::sscanf(line.c_str(), "%*u,%*u,%lf,%lf,%lf", &r, &g, &b), 3);
            const formats::Rgb color = scene.primitives[p].color[v];
            EXPECT_NEAR(color.r, r * factor[p], 1e-6 * r);
            EXPECT_NEAR(color.g, g * factor[p], 1e-6 * g);
            EXPECT_NEAR(color.b, b * factor[p], 1e-6 * b);
            sum += r;
        }
    }
    EXPECT_GT(sum, 0.1);
}

TEST(ExportGltf, ColoursAreTheRadianceThatRelightStatesTimesTheExposure) {
    SmallScene small;
    const Arguments light = {"--light", "sun:40,30", "--rotate-light", "20"};
    run_well(join({"relight", small.baked(), "-o", small.path("a.csv")}, light));
    const Outcome outcome = run_well(
        join({"export-gltf", small.baked(), "--exposure", "-2", "-o", small.path("a.glb")}, light));
    EXPECT_THAT(outcome.err, HasSubstr("a.glb: 8 vertices"));
    EXPECT_THAT(outcome.err, Not(HasSubstr("clipped")));
    const auto imported = formats::import_gltf(small.path("a.glb"));
    ASSERT_TRUE(imported);
    expect_colors(imported->scene, read_text(small.path("a.csv")), {0.25, 0.25});
    EXPECT_EQ(imported->scene.materials[imported->scene.primitives[1].material].name, "Brick");
}

// The image of the second primitive repeats, and its mean is a half: so it is in all four corners.
TEST(ExportGltf, ColoursOfASurfaceWithAnImageAreWithoutIt) {
    SmallScene small;
    const std::string file = small.write(make_small_asset(), "image.opal");
    run_well({"relight", file, "--light", "studio", "-o", small.path("a.csv")});
    run_well(
        {"export-gltf", file, "--light", "studio", "--exposure", "-8", "-o", small.path("a.glb")});
    const auto imported = formats::import_gltf(small.path("a.glb"));
    ASSERT_TRUE(imported);
    expect_colors(imported->scene, read_text(small.path("a.csv")), {1.0 / 256, 2.0 / 256});
}

TEST(ExportGltf, ExposureIsChosenAsForAPictureAndClippingIsSaid) {
    SmallScene small;
    std::ofstream(small.path("bright.hdr"), std::ios::binary)
        << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
        << "\x80\x80\x80\x88\x80\x80\x80\x88";  // radiance 128
    const Arguments light = {"--light", small.path("bright.hdr")};
    const Outcome picture =
        run_well(join({"render", small.baked(), "-o", small.path("a.png")}, light));
    const Outcome chosen =
        run_well(join({"export-gltf", small.baked(), "-o", small.path("a.glb")}, light));
    const std::string note = picture.err.substr(picture.err.find("exposure -"), 17);
    EXPECT_THAT(chosen.err, HasSubstr(note));
    const Outcome given = run_well(
        join({"export-gltf", small.baked(), "--exposure", "0", "-o", small.path("b.glb")}, light));
    // The lower square has .8 of 128 = 2^6.68 at most, in the mean of what it sees.
    EXPECT_THAT(given.err, HasSubstr("100 % of the vertices are brighter than 1"));
    EXPECT_THAT(given.err, Not(HasSubstr("EV; --exposure sets it")));
    const std::string keeps =
        given.err.substr(given.err.find("--exposure -") + std::string("--exposure ").size(), 5);
    const Outcome kept = run_well(join(
        {"export-gltf", small.baked(), "--exposure", keeps, "-o", small.path("c.glb")}, light));
    EXPECT_THAT(kept.err, Not(HasSubstr("brighter"))) << keeps;
}

TEST(ExportGltf, NothingIsWrittenOfWhatAGltfFileCannotHold) {
    SmallScene small;
    const std::string volume = small.write(make_volume_asset(), "smoke.opal");
    small.baked();
    const Arguments before = list_folder(small.folder());
    expect_refused({"export-gltf", volume, "-o", small.path("a.glb")}, 3, "has no mesh");
    expect_refused({"export-gltf", small.baked(), "-o", small.path("a.gltf")}, 2, ".glb");
    expect_refused({"export-gltf", small.scene(), "-o", small.path("a.glb")}, 3, "bake it first");
    expect_refused({"export-gltf", small.baked(), "-o", small.path("a.glb"), "--light", "sky:99,1"},
                   2, "");
    std::filesystem::copy(small.baked(), small.path("input.glb"));
    expect_refused({"export-gltf", small.path("input.glb"), "-o", small.path("input.glb")}, 2,
                   "is an input");
    std::filesystem::remove(small.path("input.glb"));
    EXPECT_EQ(list_folder(small.folder()), before);
}

}  // namespace

}  // namespace opaline::tests
