#include <gmock/gmock.h>

#include <cmath>
#include <sstream>
#include <string>

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

}  // namespace
}  // namespace opaline::tests
