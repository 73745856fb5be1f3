#include <gmock/gmock.h>

#include <sstream>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

TEST(Relight, TableHasARowForEveryVertexInTheOrderOfTheScene) {
    SmallScene small;
    const std::string out = small.path("out.csv");
    ASSERT_EQ(run_opaline({"relight", small.baked(), "--light", "white", "-o", out}).exit_code, 0);
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
        const Outcome outcome =
            run_opaline({"relight", small.baked(), "--light", "studio", "-o", small.path(name)});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
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
    EXPECT_EQ(run_opaline({"compare", a, b, "--max-rel", "1e-4"}).exit_code, 0);
    EXPECT_EQ(run_opaline({"compare", a, c, "--max-rel", "1e-2"}).exit_code, 1);
}

TEST(Render, PicturesHaveTheSizeAskedForAndAgreeBetweenBackends) {
    SmallScene small;
    const std::string gl = small.path("gl.exr"), cpu = small.path("cpu.exr");
    for (const auto& [backend, out] : {std::pair{"gl", gl}, {"cpu", cpu}}) {
        const Outcome render = run_opaline({"render", small.baked(), "--light", "studio", "--size",
                                            "83x57", "--backend", backend, "-o", out});
        ASSERT_EQ(render.exit_code, 0) << render.err;
    }
    const auto image = formats::read_exr(gl);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 83u);
    EXPECT_EQ(image->height, 57u);
    const Outcome same = run_opaline({"compare", gl, cpu, "--max-rel", "2e-3"});
    EXPECT_EQ(same.exit_code, 0) << same.out;
}

TEST(Render, ExposureOfOneDoublesLinearRadiance) {
    SmallScene small;
    const std::string a = small.path("a.exr"), b = small.path("b.exr");
    const Arguments base = {"render",    small.baked(), "--light", "white",
                            "--backend", "cpu",         "--size",  "16x16"};
    Arguments plain = base, brighter = base;
    plain.insert(plain.end(), {"-o", a});
    brighter.insert(brighter.end(), {"-o", b, "--exposure", "1"});
    ASSERT_EQ(run_opaline(plain).exit_code, 0);
    ASSERT_EQ(run_opaline(brighter).exit_code, 0);
    const auto dim = formats::read_exr(a), bright = formats::read_exr(b);
    ASSERT_TRUE(dim && bright);
    for (std::size_t i = 0; i < dim->pixel.size(); ++i) {
        EXPECT_NEAR(bright->pixel[i].g, 2 * dim->pixel[i].g, 1e-5);
    }
}

TEST(Render, TurntableNumbersItsPictures) {
    SmallScene small;
    const Outcome render = run_opaline({"render", small.baked(), "--light", "white", "--size",
                                        "16x16", "--frames", "3", "-o", small.path("t.png")});
    ASSERT_EQ(render.exit_code, 0) << render.err;
    EXPECT_EQ(list_folder(small.folder()),
              (Arguments{"scene.glb", "scene.opal", "t-0001.png", "t-0002.png", "t-0003.png"}));
}

TEST(Render, StatisticsArePrintedOnRequest) {
    SmallScene small;
    const Outcome render = run_opaline({"render", small.baked(), "--light", "white", "--size",
                                        "16x16", "--stats", "-o", small.path("t.png")});
    ASSERT_EQ(render.exit_code, 0) << render.err;
    EXPECT_THAT(render.out + render.err, HasSubstr("ms"));
}

}  // namespace
}  // namespace opaline::tests
