#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"
#include "tests/formats/opal/asset_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

TEST(Relight, TableHasARowForEveryVertexInTheOrderOfTheScene) {
    SmallScene small;
    const std::string out = small.path("out.csv");
    run_well({"relight", small.baked(), "--light", "white", "-o", out});
    std::istringstream table(read_text(out));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "primitive,vertex,r,g,b");
    for (const char* start : {"0,0,", "0,1,", "0,2,", "0,3,", "1,0,", "1,1,", "1,2,", "1,3,"}) {
        ASSERT_TRUE(std::getline(table, line));
        EXPECT_THAT(line, ::testing::StartsWith(start));
    }
    EXPECT_FALSE(std::getline(table, line));
    // The upper square is open to the whole white sky: its base colour.
    double r = 0, g = 0, b = 0;
    ASSERT_EQ(std::sscanf(read_text(out).c_str() + read_text(out).rfind("1,3,"), "1,3,%lf,%lf,%lf",
                          &r, &g, &b),
              3);
    EXPECT_NEAR(r, 0.7, 3e-3);
    EXPECT_NEAR(g, 0.2, 1e-3);
    EXPECT_NEAR(b, 0.1, 1e-3);
}

TEST(Relight, PointsAndPixelsHoldWhatTheTableHolds) {
    SmallScene small;
    for (const char* name : {"out.ply", "out.exr"}) {
        run_well({"relight", small.baked(), "--light", "studio", "-o", small.path(name)});
    }
    EXPECT_THAT(read_text(small.path("out.ply")), HasSubstr("element vertex 8\n"));
    EXPECT_TRUE(formats::read_exr(small.path("out.exr")));
}

TEST(Relight, TurningTheLightOnceAroundChangesNothing) {
    SmallScene small;
    const std::string a = small.path("a.csv"), b = small.path("b.csv"), c = small.path("c.csv");
    const auto relight = [&](const std::string& out, const std::string& degrees) {
        return run_opaline({"relight", small.baked(), "--light", "sun:40,30", "--rotate-light",
                            degrees, "-o", out})
            .exit_code;
    };
    ASSERT_EQ(relight(a, "0"), 0);
    ASSERT_EQ(relight(b, "360"), 0);
    ASSERT_EQ(relight(c, "180"), 0);
    run_well({"compare", a, b, "--max-rel", "1e-4"});
    EXPECT_EQ(run_opaline({"compare", a, c, "--max-rel", "1e-2"}).exit_code, 1);
}

/// A file with two diffuse squares and a translucent triangle, normals +Z, K = 9.
std::string write_translucent(const SmallScene& small) {
    formats::Asset asset = make_small_asset();
    add_translucent_triangle(asset, 9, 1.3f);
    return small.write(asset, "translucent.opal");
}

/// The picture by OpenGL, which differs from that of the CPU by at most `most` (relative RMSE).
formats::Image draw_on_both(const SmallScene& small, const std::string& file,
                            const Arguments& options, const char* most = "2e-3") {
    const std::string gl = small.path("gl.exr"), cpu = small.path("cpu.exr");
    for (const auto& [backend, out] : {std::pair{"gl", gl}, {"cpu", cpu}}) {
        run_well(join({"render", file, "--backend", backend, "-o", out}, options));
    }
    run_well({"compare", gl, cpu, "--max-rel", most});
    return std::move(*formats::read_exr(gl));
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

TEST(Relight, TheEyeChangesTranslucentReceiversAlone) {
    SmallScene small;
    const std::string file = write_translucent(small);
    run_well({"verify", file});
    int run = 0;
    const auto table = [&](const Arguments& eye) {
        const std::string out = small.path("table" + std::to_string(run++) + ".csv");
        run_well(join({"relight", file, "--light", "sky:3,40", "-o", out}, eye));
        return lines_of(read_text(out));
    };
    const auto own = table({}), aside = table({"--eye", "5,1,2"}),
               behind = table({"--eye", "0,0,-4"});
    ASSERT_EQ(own.size(), 12u);  // head, 8 diffuse, 3 translucent
    for (std::size_t i = 1; i < 9; ++i) {
        EXPECT_EQ(own[i], aside[i]);
        EXPECT_EQ(own[i], behind[i]);
    }
    std::size_t lit = 0;
    for (std::size_t i = 9; i < 12; ++i) {
        EXPECT_THAT(behind[i], ::testing::EndsWith(",0,0,0"));
        lit += own[i].ends_with(",0,0,0") ? 0u : 1u;
        if (!own[i].ends_with(",0,0,0")) {
            EXPECT_NE(own[i], aside[i]);
        }
    }
    EXPECT_GT(lit, 0u);
    // From far away along the normal: as without an eye, up to the angle of a metre in 1e6.
    const std::string a = small.path("own.csv"), b = small.path("far.csv");
    run_well({"relight", file, "--light", "white", "-o", a});
    run_well({"relight", file, "--light", "white", "--eye", "0,0,1e6", "-o", b});
    run_well({"compare", a, b, "--max-rel", "1e-4"});
    expect_refused({"relight", file, "--light", "white", "--eye", "1,2", "-o", a}, 2, "");
}

/// The same with gloss, and with multiple scattering apart if asked for.
std::string write_glossy(const SmallScene& small, bool is_separate) {
    formats::Asset asset = make_small_asset();
    add_translucent_triangle(asset, is_separate ? 10 : 9, 1.3f, is_separate);
    add_gloss(asset);
    return small.write(asset, is_separate ? "separate.opal" : "merged.opal");
}

TEST(Terms, UnknownNamesAreRefusedWithTheList) {
    SmallScene small;
    const std::string file = write_glossy(small, true);
    for (const char* command : {"relight", "render"}) {
        const std::string out = small.path(command == std::string("relight") ? "o.csv" : "o.png");
        for (const char* terms : {"sparkle", "multiple,", ",single", "diffuse;single", "Diffuse"}) {
            expect_refused({command, file, "--light", "white", "--terms", terms, "-o", out}, 2,
                           "multiple,single,specular,diffuse");
            EXPECT_FALSE(std::filesystem::exists(out));
        }
    }
}

// Help says "[all]": the word must work, also for rows that hold multiple and single together.
TEST(Terms, AllIsTheDefault) {
    SmallScene small;
    const std::string file = write_glossy(small, false);
    const std::string plain = small.path("plain.csv"), all = small.path("all.csv");
    run_well({"relight", file, "--light", "studio", "-o", plain});
    run_well({"relight", file, "--light", "studio", "--terms", "all", "-o", all});
    EXPECT_EQ(read_text(plain), read_text(all));
}

TEST(Terms, MergedFilesSayWhatToDoForOneOfTheirTerms) {
    SmallScene small;
    const std::string merged = write_glossy(small, false), out = small.path("o.png");
    for (const char* terms : {"multiple", "single,specular,diffuse"}) {
        const Outcome bad =
            run_opaline({"render", merged, "--light", "white", "--terms", terms, "-o", out});
        EXPECT_EQ(bad.exit_code, 3) << terms;
        EXPECT_THAT(bad.err, HasSubstr("merged.opal: primitive 2: "));
        EXPECT_THAT(bad.err, HasSubstr("(bake with --separate-terms"));
    }
    for (const char* terms : {"multiple,single", "specular", "diffuse,specular"}) {
        run_well(
            {"render", merged, "--light", "white", "--terms", terms, "--size", "16x16", "-o", out});
    }
}

// Seen from above and from below.
TEST(Render, BackendsAgreeOnBothSidesOfThinWalledSurfaces) {
    SmallScene small;
    std::ofstream(small.path("leaf.json"))
        << R"({"materials": {"*": {"thin_walled": {"reflect": [0.2, 0.2, 0.2],
                                                   "transmit": [0.6, 0.5, 0.4]}}}})";
    const std::string file = small.path("leaf.opal");
    // Without the light that surfaces send to each other, which has no such ratio.
    run_well({"bake", small.scene(), "--media", small.path("leaf.json"), "--effects", "sheet,gloss",
              "--cubemap", "8", "-o", file});
    EXPECT_THAT(run_opaline({"info", file}).out, HasSubstr("2 term(s), RGB, thin-walled"));
    for (const char* elevation : {"60", "-60"}) {
        draw_on_both(small, file,
                     {"--light", "sun:40,60", "--size", "61x43", "--elevation", elevation}, "1e-2");
    }
    // A sun 60 degrees high, from below: the transmitted share, in the ratio of its bands.
    const auto relit = [&](const char* eye) {
        const std::string table = small.path("t.csv");
        run_well({"relight", file, "--light", "sun:40,60", "--eye", eye, "-o", table});
        double r = 0, g = 0, b = 0;
        const std::string text = read_text(table);
        EXPECT_EQ(std::sscanf(text.c_str() + text.rfind("1,3,"), "1,3,%lf,%lf,%lf", &r, &g, &b), 3);
        return std::array{r, g, b};
    };
    const auto above = relit("0,9,0"), below = relit("0,-9,0");
    EXPECT_NEAR(below[0] / above[0], 3, 0.15);
    EXPECT_NEAR(below[2] / below[0], 4.0 / 6, 0.03);
}

TEST(Render, PicturesHaveTheSizeAskedForAndAgreeBetweenBackends) {
    SmallScene small;
    const formats::Image image =
        draw_on_both(small, small.baked(), {"--light", "studio", "--size", "83x57"});
    EXPECT_EQ(image.width, 83u);
    EXPECT_EQ(image.height, 57u);
}

TEST(Render, ExposureOfOneDoublesLinearRadiance) {
    SmallScene small;
    const std::string a = small.path("a.exr"), b = small.path("b.exr");
    const Arguments base = {"render",    small.baked(), "--light", "white",
                            "--backend", "cpu",         "--size",  "16x16"};
    run_well(join(base, {"-o", a}));
    run_well(join(base, {"-o", b, "--exposure", "1"}));
    const auto dim = formats::read_exr(a), bright = formats::read_exr(b);
    ASSERT_TRUE(dim && bright);
    for (std::size_t i = 0; i < dim->pixel.size(); ++i) {
        EXPECT_NEAR(bright->pixel[i].g, 2 * dim->pixel[i].g, 1e-5);
    }
}

TEST(Render, TurntableNumbersItsPictures) {
    SmallScene small;
    run_well({"render", small.baked(), "--light", "white", "--size", "16x16", "--frames", "3", "-o",
              small.path("t.png")});
    EXPECT_EQ(list_folder(small.folder()),
              (Arguments{"scene.glb", "scene.opal", "t-0001.png", "t-0002.png", "t-0003.png"}));
}

TEST(Render, StatisticsArePrintedOnRequest) {
    SmallScene small;
    const Outcome render = run_well({"render", small.baked(), "--light", "white", "--size", "16x16",
                                     "--stats", "-o", small.path("t.png")});
    EXPECT_THAT(render.out + render.err, HasSubstr("ms"));
}

}  // namespace
}  // namespace opaline::tests
