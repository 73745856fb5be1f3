#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

struct Row {
    unsigned primitive = 0, vertex = 0;
    double value[3] = {}, error[3] = {};
};

std::vector<Row> read_rows(const std::string& path) {
    std::istringstream table(read_text(path));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "primitive,vertex,r,g,b,se_r,se_g,se_b");
    std::vector<Row> rows;
    while (std::getline(table, line)) {
        Row row;
        EXPECT_EQ(std::sscanf(line.c_str(), "%u,%u,%lf,%lf,%lf,%lf,%lf,%lf", &row.primitive,
                              &row.vertex, &row.value[0], &row.value[1], &row.value[2],
                              &row.error[0], &row.error[1], &row.error[2]),
                  8)
            << line;
        rows.push_back(row);
    }
    return rows;
}

TEST(Reference, TableAgreesWithTheBakeWhereBothMeanTheSameLight) {
    SmallScene small;
    const std::string truth = small.path("truth.csv"), baked = small.path("baked.csv");
    const Outcome reference =
        run_well({"reference", small.scene(), "--light", "white", "--receivers", "5", "--terms",
                  "diffuse", "--spp", "20000", "-o", truth});
    EXPECT_THAT(reference.err, HasSubstr("20000 samples for each of 5 receivers"));
    run_well({"relight", small.baked(), "--light", "white", "-o", baked});
    const std::vector<Row> rows = read_rows(truth);
    ASSERT_EQ(rows.size(), 5u);
    for (const Row& row : rows) {
        EXPECT_GT(row.value[0], 0.1);
        EXPECT_LT(row.error[0], 0.01 * row.value[0]);
    }
    // Eight rows against five: those of the ground truth count.
    run_well({"compare", baked, truth, "--max-rel", "0.01"});
}

/// A slab 400 m wide, two mean free paths thick along z, and what it is made of: isotropic index,
/// g = .75, albedo .9. Under white light its radiance along the normal is the sum of total
/// reflectance and transmittance, .09739 + .66096 [vandeHulst1980].
constexpr double kSlabRadiance = 0.75835;

Arguments slab_arguments(SmallScene& folder) {
    const Primitive cube = make_cube(9, false);
    AssetBuilder asset;
    std::vector<float> position, normal;
    for (std::size_t v = 0; v < cube.position.size(); ++v) {
        const glm::vec3 p = cube.position[v] * glm::vec3(200, 200, 0.5f);
        position.insert(position.end(), {p.x, p.y, p.z});
        normal.insert(normal.end(), {cube.normal[v].x, cube.normal[v].y, cube.normal[v].z});
    }
    asset.json["materials"] = {{{"name", "Slab"}}};
    const std::size_t p = asset.add(position, "VEC3"), n = asset.add(normal, "VEC3");
    const std::size_t i = asset.add(cube.index, "SCALAR");
    asset.add_node(
        asset.add_mesh({{"POSITION", p}, {"NORMAL", n}}, {{"indices", i}, {"material", 0}}));
    write_file(folder.path("slab.glb"), asset.glb());
    const Json slab = {{"sigma_s", {1.8, 1.8, 1.8}},
                       {"sigma_a", {0.2, 0.2, 0.2}},
                       {"unit", "1/m"},
                       {"phase", {{"type", "hg"}, {"g", 0.75}}},
                       {"eta", 1.0}};
    write_file(folder.path("slab.json"), Json{{"materials", {{"Slab", slab}}}}.dump());
    return {"reference", folder.path("slab.glb"), "--media", folder.path("slab.json"), "--light",
            "white"};
}

/// Mean of z^2, z = (value - truth) / its own standard error, and the mean value.
struct Agreement {
    double squares = 0, mean = 0, variance = 0;
    int count = 0;

    void add(double value, double standard_error) {
        const double z = (value - kSlabRadiance) / standard_error;
        squares += z * z;
        mean += value;
        variance += standard_error * standard_error;
        ++count;
    }
    void expect() const {
        EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2.0 / count));
        EXPECT_NEAR(mean / count, kSlabRadiance, 3 * std::sqrt(variance) / count);
        EXPECT_LT(std::sqrt(variance) / count, 0.003);
    }
};

TEST(Reference, StandardErrorsOfTheTableAreHowFarItIsFromAPublishedSlab) {
    SmallScene folder;
    run_well(join(slab_arguments(folder),
                  {"--receivers", "600", "--spp", "400", "-o", folder.path("slab.csv")}));
    Agreement slab;
    for (const Row& row : read_rows(folder.path("slab.csv"))) {
        // The two large faces, ten by ten vertices each, without their edges.
        const unsigned i = row.vertex % 10, j = row.vertex / 10 % 10;
        if (row.vertex >= 400 && i % 9 != 0 && j % 9 != 0) {
            slab.add(row.value[0], row.error[0]);
        }
    }
    EXPECT_EQ(slab.count, 128);
    slab.expect();
}

TEST(Reference, VarianceOfThePictureIsHowFarItIsFromAPublishedSlab) {
    SmallScene folder;
    run_well(join(slab_arguments(folder),
                  {"--eye", "7,31,50", "--target", "7,31,0", "--fov", "1", "--size", "24x24",
                   "--spp", "256", "-o", folder.path("slab.exr")}));
    const auto mean = formats::read_exr(folder.path("slab.exr")),
               variance = formats::read_exr(folder.path("slab.var.exr"));
    ASSERT_TRUE(mean && variance);
    Agreement slab;
    for (std::size_t i = 0; i < mean->pixel.size(); ++i) {
        slab.add(mean->pixel[i].g, std::sqrt(variance->pixel[i].g));
    }
    EXPECT_EQ(slab.count, 24 * 24);
    slab.expect();
}

TEST(Reference, PictureAgreesWithRender) {
    SmallScene small;
    const std::string truth = small.path("truth.exr"), baked = small.path("baked.exr");
    // The upper square fills the picture: nothing shadows it.
    for (const auto& [command, file, out] :
         {std::tuple{"reference", small.scene(), truth}, {"render", small.baked(), baked}}) {
        Arguments arguments = {command, file,    "--light",  "white",    "--size",
                               "32x24", "--eye", "0,3,0.01", "--target", "0,0.5,0",
                               "--fov", "8",     "-o",       out};
        const Arguments more = std::string(command) == "reference"
                                   ? Arguments{"--spp", "2000", "--max-depth", "1"}
                                   : Arguments{"--backend", "cpu"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        run_well(arguments);
    }
    run_well({"compare", baked, truth, "--max-rel", "0.01"});
}

TEST(Reference, StopsInTime) {
    SmallScene small;
    run_well({"reference", small.scene(), "--light", "white", "--receivers", "3", "--seconds",
              "0.2", "-o", small.path("out.csv")});
    EXPECT_EQ(read_rows(small.path("out.csv")).size(), 3u);
}

TEST(Reference, OpenBodiesAreNamedInAWarning) {
    SmallScene small;
    const std::string media = small.path("media.json");
    write_file(
        media,
        Json{{"materials",
              {{"Brick", {{"sigma_s", {1, 1, 1}}, {"sigma_a", {0, 0, 0}}, {"unit", "1/m"}}}}}}
            .dump());
    const Outcome outcome =
        run_well({"reference", small.scene(), "--light", "white", "--receivers", "8", "--spp", "16",
                  "--media", media, "-o", small.path("out.csv")});
    EXPECT_THAT(outcome.err, HasSubstr("a body that is not closed"));
}

TEST(Reference, BadArgumentsAreRefusedBeforeAnyWork) {
    SmallScene small;
    const std::string scene = small.scene(), csv = small.path("out.csv"),
                      exr = small.path("out.exr");
    const auto before = list_folder(small.folder());
    const std::vector<Arguments> bad = {
        {scene, "-o", exr},                                           // no light
        {scene, "--light", "white"},                                  // no output
        {scene, "--light", "white", "-o", csv},                       // no receivers
        {scene, "--light", "white", "-o", exr, "--receivers", "5"},   // not a table
        {scene, "--light", "white", "-o", small.path("out.jpg")},     // no such format
        {scene, "--light", "white", "-o", csv, "--receivers", "0"},   //
        {scene, "--light", "white", "-o", csv, "--receivers", "-3"},  //
        {scene, "--light", "white", "-o", exr, "--spp", "0"},         //
        {scene, "--light", "white", "-o", exr, "--seconds", "-1"},    //
        {scene, "--light", "white", "-o", exr, "--max-depth", "0"},   //
        {scene, "--light", "white", "-o", exr, "--terms", "glow"},    //
        {scene, "--light", "white", "-o", exr, "--texture-filter", "blurred"},
        {scene, "--light", "white", "-o", csv, "--receivers", "5", "--texture-filter", "footprint"},
        {scene, "--light", "white", "-o", exr, "--seconds", "1", "--texture-filter", "footprint"},
        {scene, "--light", "white", "-o", exr, "--terms", "single,"},  //
        {scene, "--light", "white", "-o", exr, "--eye", "1,2"},        //
        {scene, "--light", "white", "-o", exr, "--size", "0x4"},       //
        {scene, "--light", "dark", "-o", exr, "--size", "4x4", "--spp", "1", "--seed", "-1"},
        {scene, "--light", "sun:x", "-o", exr},
    };
    for (const Arguments& arguments : bad) {
        expect_refused(join({"reference"}, arguments), 2, "");
        EXPECT_EQ(list_folder(small.folder()), before);
    }
    EXPECT_EQ(
        run_opaline({"reference", small.path("none.glb"), "--light", "white", "-o", exr}).exit_code,
        3);
    EXPECT_EQ(
        run_opaline({"reference", scene, "--light", "white", "-o", small.path("nowhere/out.exr")})
            .exit_code,
        4);
}

using ::testing::AllOf;

TEST(Reference, VolumesBesideMeshesAndAlone) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string();
    for (const char* name : {"smoke", "cumulus"}) {
        run_well({"example", name, "-o", folder.path().string()});
    }
    const auto look = [&](const char* scene, const char* terms) {
        run_well({"reference", (folder / scene).string(), "--light", "white", "--size", "24x24",
                  "--spp", "32", "--terms", terms, "-o", out});
        return mean_of_picture(out);
    };
    // Under even light a cloud that absorbs nothing is as bright as the sky: here, a share of the
    // picture.
    const double cloud = look("cumulus.json", "volume-single,volume-multiple");
    EXPECT_GT(cloud, 0.02);
    EXPECT_LT(cloud, 0.5);
    EXPECT_NEAR(look("cumulus.json", "all"), 1, 0.02);
    // Without the media file it is a denser cloud of another colour.
    EXPECT_GT(look("cumulus.vdb", "volume-multiple"), 0.02);
    EXPECT_GT(look("smoke.gltf", "volume-single"), 1e-4);
    EXPECT_GT(look("smoke.gltf", "diffuse"), 0.02);
}

TEST(Reference, WhatNeedsSurfacesSaysSoOfVolumes) {
    const TemporaryFolder folder;
    run_well({"example", "cumulus", "-o", folder.path().string()});
    const std::string scene = (folder / "cumulus.json").string();
    const auto before = list_folder(folder.path());
    expect_refused({"reference", scene, "--light", "white", "--receivers", "5", "-o",
                    (folder / "out.csv").string()},
                   2, "no vertices");
    expect_refused({"reference", scene, "--media", scene, "--light", "white", "-o",
                    (folder / "out.exr").string()},
                   2, "");
    EXPECT_EQ(list_folder(folder.path()), before);
}

TEST(Reference, PathIntegrationDrawsVolumesWithoutNoise) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string(), again = (folder / "again.exr").string();
    run_well({"example", "milk", "-o", folder.path().string()});
    const auto draw = [&](const std::string& file, const char* threads) {
        const Outcome outcome =
            run_well({"reference", (folder / "milk.json").string(), "--light", "sun:60,35",
                      "--method", "path-integration", "--renormalise", "off", "--size", "16x12",
                      "--threads", threads, "-o", file});
        EXPECT_THAT(outcome.err, HasSubstr("path integration, 4 rays for each of 192 pixels"));
    };
    draw(out, "1");
    draw(again, "2");
    EXPECT_EQ(read_text(out), read_text(again));
    EXPECT_GT(mean_of_picture(out), 0.01);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.var.exr"));
}

TEST(Reference, PaperFidelityIsForPicturesByPathIntegrationAlone) {
    const TemporaryFolder folder;
    run_well({"example", "milk", "-o", folder.path().string()});
    const std::string paper = (folder / "paper.json").string();
    std::ofstream(paper) << R"({"volumes": [{"file": "milk.vdb", "sigma_t": [7, 12, 19],
                                               "fidelity": "paper"}]})";
    const Arguments picture = {"reference", paper,   "--light",  "sun:60,35",
                               "--size",    "16x12", "--method", "path-integration"};
    const auto draw = [&](const Arguments& more) {
        Arguments arguments = picture;
        arguments.insert(arguments.end(), {"-o", (folder / "out.exr").string()});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_opaline(arguments);
    };
    EXPECT_EQ(draw({"--renormalise", "on"}).exit_code, 2);
    const Outcome drawn = draw({});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.err, AllOf(HasSubstr("as printed"), HasSubstr("with fidelity paper")));
    EXPECT_GT(mean_of_picture((folder / "out.exr").string()), 0.01);
    for (const char* command : {"bake", "plan"}) {
        Arguments arguments = {command, paper};
        if (command == std::string_view("bake")) {
            arguments.insert(arguments.end(), {"-o", (folder / "out.opal").string()});
        }
        expect_refused(arguments, 3, "reference --method path-integration");
    }
}

TEST(Reference, PathIntegrationRefusesWhatItCannotDo) {
    const TemporaryFolder folder;
    run_well({"example", "milk", "-o", folder.path().string()});
    const std::string milk = (folder / "milk.json").string();
    SmallScene small;
    const struct {
        std::string scene;
        Arguments more;
        int exit_code;
        const char* says;
    } cases[] = {{milk, {"--seconds", "3"}, 2, "--seconds"},
                 {milk, {"--max-depth", "2"}, 2, "--max-depth"},
                 {milk, {"--texture-filter", "limited"}, 2, "--texture-filter"},
                 {milk, {"--seed", "5"}, 2, "--seed"},
                 {milk, {"--terms", "interreflection"}, 2, "volume-single"},
                 {small.scene(), {}, 3, "leave out --method"}};
    const Arguments output = {"--light", "white", "-o", (folder / "out.exr").string()};
    for (const auto& [scene, more, exit_code, says] : cases) {
        expect_refused(
            join(join({"reference", scene, "--method", "path-integration"}, output), more),
            exit_code, says);
    }
    expect_refused(join({"reference", milk, "--renormalise", "on"}, output), 2, "--renormalise");
    expect_refused(join({"reference", milk, "--method", "guess"}, output), 2, "--method");
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace

}  // namespace opaline::tests
