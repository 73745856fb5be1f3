// Files that hold a cloud layer and no vertex, as users meet them.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/print_json.h"
#include "tests/cli/small_scene.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/cloud_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Of a picture by the CPU of 32 x 24 pixels.
double mean_of_drawn(const SmallScene& small, const std::string& file, const Arguments& more) {
    const std::string out = small.path("mean.exr");
    run_well(join(
        {"render", file, "--backend", "cpu", "--light", "sky:3,40", "--size", "32x24", "-o", out},
        more));
    return mean_of_picture(out);
}

TEST(LayerFiles, RelightOfALayerAloneIsATableWithoutRows) {
    SmallScene small;
    const std::string file = small.write(make_cloud_asset(), "layer.opal");
    const std::string out = small.path("o.csv");
    const Outcome outcome = run_well({"relight", file, "--light", "white", "-o", out});
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("cloud layer alone"), HasSubstr("opaline render")));
    EXPECT_EQ(read_text(out), "primitive,vertex,r,g,b\n");
}

TEST(LayerFiles, RenderShowsThemFromBelowAndFromAboveAndMovedByTheirWind) {
    SmallScene small;
    const std::string file = small.write(make_cloud_asset(), "layer.opal");
    const double below = mean_of_drawn(small, file, {});
    EXPECT_GT(below, 0);
    EXPECT_EQ(mean_of_drawn(small, file, {"--time", "0"}), below);
    EXPECT_NE(mean_of_drawn(small, file, {"--time", "60"}), below);
    EXPECT_NE(mean_of_drawn(small, file, {"--elevation", "30"}), below);
    for (const char* time : {"nan", "1e10", "noon"}) {
        expect_refused(
            {"render", file, "--light", "white", "--time", time, "-o", small.path("bad.png")}, 2,
            "--time");
    }
}

// The film stands still but for the clouds: each frame is what --time shows.
TEST(LayerFiles, FilmsShowTheLayerAtTheTimeOfEachFrame) {
    SmallScene small;
    const std::string file = small.write(make_cloud_asset(), "layer.opal");
    const Arguments common{"render",  file,        "--backend", "cpu",
                           "--light", "sun:30,40", "--size",    "16x12"};
    const auto draw = [&](const Arguments& more) { run_well(join(common, more)); };
    draw({"--frames", "3", "--time", "20", "--time-step", "30", "-o", small.path("film.png")});
    for (const auto& [frame, time] :
         {std::pair("film-0001.png", "20"), {"film-0002.png", "50"}, {"film-0003.png", "80"}}) {
        draw({"--time", time, "-o", small.path("one.png")});
        EXPECT_EQ(read_text(small.path(frame)), read_text(small.path("one.png"))) << time;
    }
    EXPECT_NE(read_text(small.path("film-0001.png")), read_text(small.path("film-0003.png")));
    draw({"--frames", "3", "--time", "20", "--time-step", "30", "--turn", "90", "-o",
          small.path("turn.png")});
    EXPECT_EQ(read_text(small.path("turn-0001.png")), read_text(small.path("film-0001.png")));
    EXPECT_NE(read_text(small.path("turn-0002.png")), read_text(small.path("film-0002.png")));

    const Arguments bad{"-o", small.path("bad.png")};
    expect_refused(join(join(common, {"--time-step", "3"}), bad), 2,
                   "--time-step: there is one frame only");
    expect_refused(join(join(common, {"--frames", "2", "--time-step", "nan"}), bad), 2,
                   "--time-step");
    expect_refused(join(join(common, {"--turn", "90"}), bad), 2, "--turn: there is one frame only");
    const std::string clear = small.write(make_small_asset(), "clear.opal");
    expect_refused({"render", clear, "--light", "white", "--frames", "2", "--time-step", "3", "-o",
                    small.path("bad.png")},
                   2, "no cloud layer");
}

// Sum of all numbers of a table of relight behind its vertices.
double sum_of_table(const std::string& text) {
    double sum = 0;
    std::istringstream lines(text.substr(text.find('\n') + 1));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line.substr(line.find(',', line.find(',') + 1) + 1));
        for (std::string cell; std::getline(cells, cell, ',');)
            sum += std::stod(cell);
    }
    return sum;
}

// Beneath the layer of the fixture, whose base is 800 m high, a mesh gets less of a sun's light.
TEST(LayerFiles, LayerTakesLightFromTheMeshesOfItsFile) {
    SmallScene small;
    formats::Asset asset = make_small_asset();
    const std::string clear = small.write(asset, "clear.opal");
    add_layer(asset);
    asset.clouds.thickness.assign(asset.clouds.thickness.size(), 65535);
    const std::string cloudy = small.write(asset, "cloudy.opal");
    const auto light_of = [&](const std::string& file, const char* time) {
        const std::string out = small.path("r.csv");
        const Outcome outcome =
            run_well({"relight", file, "--light", "sun:0,50", "--time", time, "-o", out});
        EXPECT_THAT(outcome.err, Not(HasSubstr("alone")));
        return sum_of_table(read_text(out));
    };
    const double day = light_of(clear, "0"), dull = light_of(cloudy, "0");
    EXPECT_GT(day, 0);
    EXPECT_LT(dull, 0.9 * day);
    EXPECT_NE(light_of(cloudy, "150"), dull);  // another part of it is overhead
    EXPECT_EQ(light_of(clear, "150"), day);
}

// Lines of a table of relight that are of one primitive.
std::string table_of(const std::string& text, const std::string& primitive) {
    std::istringstream lines(text);
    std::string found = "\n";
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(primitive + ",")) found += line + "\n";
    }
    return found;
}

// One of two nodes moves away: it gets the light of its new place, the other one keeps its own.
TEST(LayerFiles, NodesThatStandFarApartHaveTheLightOfTheirPlaces) {
    SmallScene small;
    formats::Asset asset = make_small_asset();
    add_layer(asset);
    asset.primitives[1].node = 1;
    const std::string near = small.write(asset, "near.opal");
    for (std::uint32_t v = 0; v < asset.primitives[1].vertex_count; ++v) {
        asset.position[asset.primitives[1].first_vertex + v].x += 1500;
    }
    const std::string apart = small.write(asset, "apart.opal");
    const auto light_of = [&](const std::string& file, const char* primitive) {
        const std::string out = small.path("r.csv");
        run_well({"relight", file, "--light", "sun:0,50", "-o", out});
        return sum_of_table(table_of(read_text(out), primitive));
    };
    const double stays = light_of(near, "0"), goes = light_of(near, "1");
    EXPECT_GT(stays, 0);
    EXPECT_NEAR(light_of(apart, "0"), stays, 0.01 * stays);
    EXPECT_GT(std::abs(light_of(apart, "1") - goes), 0.05 * goes);
    for (const auto& [file, points] :
         {std::pair(near, "points     1\n"), {apart, "points     2\n"}}) {
        const Outcome drawn =
            run_opaline({"render", file, "--light", "sun:0,50", "--backend", "cpu", "--size",
                         "16x12", "--stats", "-o", small.path("o.png")});
        EXPECT_THAT(drawn.out, HasSubstr(points)) << drawn.err;
    }
}

TEST(LayerFiles, SingleTermsAreShownWithoutTheLayer) {
    SmallScene small;
    formats::Asset asset = make_small_asset();
    const std::string clear = small.write(asset, "clear.opal");
    add_layer(asset);
    const std::string cloudy = small.write(asset, "cloudy.opal");
    const Arguments away{"--eye", "0,500,0", "--target", "0,900,300"};
    Arguments diffuse = away;
    diffuse.insert(diffuse.end(), {"--terms", "diffuse"});
    EXPECT_GT(mean_of_drawn(small, cloudy, away), 0);
    EXPECT_NE(mean_of_drawn(small, cloudy, away), mean_of_drawn(small, clear, away));
    EXPECT_EQ(mean_of_drawn(small, cloudy, diffuse), 0);
}

TEST(LayerFiles, ReferenceRefusesALayerAloneAndSaysWhatItLeavesOut) {
    SmallScene small;
    const std::string media = small.path("layer.json"), out = small.path("o.exr");
    write_file(media, std::string(R"({"clouds": [{"thickness": 100}]})"));
    expect_refused({"reference", media, "--light", "white", "-o", out}, 3, "cloud layer alone");
    const Outcome beside = run_well({"reference", small.scene(), "--media", media, "--light",
                                     "white", "--size", "8x6", "--spp", "1", "-o", out});
    EXPECT_THAT(beside.err, HasSubstr("cloud layer is left out"));
}

TEST(CloudFiles, InfoListsTheLayer) {
    SmallScene small;
    const formats::Asset asset = make_cloud_asset();
    const std::string file = small.write(asset, "clouds.opal");
    const Outcome text = run_well({"info", file});
    EXPECT_THAT(text.out,
                AllOf(HasSubstr("cloud layers\n    0  base at 800 m over ground at -20 m, "
                                "4000 x 3000 m, up to "),
                      HasSubstr("orders: 0, 1, and 2 or more"), HasSubstr("CLOU"),
                      Not(HasSubstr("primitives"))));
    const nlohmann::json info = print_json("info", {file, "--json"});
    ASSERT_EQ(info["layers"].size(), 1u);
    const nlohmann::json& layer = info["layers"][0];
    EXPECT_EQ(layer["base"], 800);
    EXPECT_EQ(layer["ground"], -20);
    EXPECT_EQ(layer["size"], nlohmann::json({4000, 3000}));
    EXPECT_EQ(layer["wind"], nlohmann::json({5, -2.5}));
    EXPECT_GT(layer["largest_thickness"], 125);
    EXPECT_LE(layer["largest_thickness"], 250);
    EXPECT_EQ(layer["kappa"][2], 0.046f);
    EXPECT_EQ(layer["multiple_scattering"], true);
    EXPECT_EQ(layer["repeats"], false);
    EXPECT_EQ(layer["fidelity"], "physical");
    EXPECT_THAT(text.out, Not(HasSubstr("fidelity")));
    EXPECT_EQ(layer["tables"]["flux"], nlohmann::json({4, 3}));
    EXPECT_EQ(layer["tables"]["radiance"], nlohmann::json({2, 3, 2}));
    EXPECT_EQ(layer["bytes"],
              176 + 2 * asset.clouds.thickness.size() + 4 * 6 + 4 * asset.clouds.value.size());
    EXPECT_TRUE(info["volumes"].empty() && info["primitives"].empty());

    formats::Asset paper = asset;
    paper.clouds.records[0].flags |= formats::LayerRecord::kPaper;
    EXPECT_THAT(run_opaline({"info", small.write(paper, "clouds.opal")}).out,
                HasSubstr("; fidelity paper\n"));

    const formats::Asset single = make_cloud_asset({.has_radiance = false});
    EXPECT_THAT(run_opaline({"info", small.write(single, "clouds.opal")}).out,
                HasSubstr("orders: 0 and 1;"));
}

TEST(CloudFiles, VerifyAcceptsSoundOnesAndNamesFaults) {
    SmallScene small;
    formats::Asset asset = make_cloud_asset();
    run_well({"verify", small.write(asset, "clouds.opal")});
    asset.clouds.value.back() = 1e30f;
    expect_refused({"verify", small.write(asset, "clouds.opal")}, 1,
                   "section CLOU, layer 0: band 2: a value of its tables of radiance");
}

// A media file of a layer alone, of droplets so small that its bake takes a second.
std::string write_layer_scene(const SmallScene& small, const std::string& more) {
    const std::string path = small.path("layer.json");
    write_file(path,
               std::string(R"({"clouds": [{"r_e": 2e-6, "size": [4000, 4000], )" + more + "}]}"));
    return path;
}

nlohmann::json plan_of(const std::string& scene, const std::string& effect) {
    const nlohmann::json plan = print_json("plan", {scene, "--json"});
    for (const nlohmann::json& entry : plan["plan"]) {
        if (entry["effect"] == effect) return entry;
    }
    ADD_FAILURE() << "no " << effect << " in the plan of " << scene;
    return {};
}

TEST(LayerBake, IsPlannedBakedAndStatedFromAMediaFileAlone) {
    SmallScene small;
    const std::string scene = write_layer_scene(small, R"("thickness": 300)");
    EXPECT_EQ(plan_of(scene, "cloud")["decision"], "on");
    EXPECT_EQ(plan_of(scene, "cloud.multiple")["decision"], "on");
    EXPECT_EQ(plan_of(scene, "radiosity")["decision"], "on");
    const std::string file = small.path("layer.opal"), report = small.path("report.json");
    const Outcome bake =
        run_well({"bake", scene, "-o", file, "--quality", "draft", "--report", report});
    EXPECT_THAT(bake.err, HasSubstr("cloud layer errs by"));
    const nlohmann::json error = nlohmann::json::parse(read_text(report))["error"];
    const double stated = error["by_effect"]["cloud"];
    EXPECT_GT(stated, 0);
    EXPECT_LT(stated, 0.1);
    EXPECT_EQ(error["rms_relative"], stated);
    EXPECT_THAT(run_opaline({"info", file}).out,
                AllOf(HasSubstr("layer errs"), HasSubstr("base at 1000 m over ground at 0 m"),
                      Not(HasSubstr("measured error"))));
    run_well({"verify", file});
}

}  // namespace

}  // namespace opaline::tests
