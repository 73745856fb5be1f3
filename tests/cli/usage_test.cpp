#include <gmock/gmock.h>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const Arguments kCommands = {"bake",   "plan",    "info",  "verify",  "relight",
                             "render", "compare", "phase", "example", "reference",
                             "mie",    "slab",    "help"};

TEST(Usage, HelpListsEveryCommandAndTheExitCodes) {
    const Outcome help = run_well({"--help"});
    EXPECT_EQ(help.err, "");
    for (const std::string& command : kCommands) {
        EXPECT_THAT(help.out, HasSubstr("\n  " + command + " "));
    }
    EXPECT_THAT(help.out, HasSubstr("130 interrupted"));
}

TEST(Usage, EveryCommandExplainsItselfWithAnExample) {
    for (const std::string& command : kCommands) {
        const Outcome help = run_well({command, "--help"});
        EXPECT_THAT(help.out, HasSubstr("Example:\n  opaline " + command + " ")) << command;
    }
}

TEST(Usage, HelpExplainsACommandByNameAndVIsTheVersion) {
    EXPECT_EQ(run_opaline({"help"}).out, run_opaline({"--help"}).out);
    EXPECT_EQ(run_opaline({"help", "bake"}).out, run_opaline({"bake", "--help"}).out);
    EXPECT_EQ(run_opaline({"-v"}).out, run_opaline({"--version"}).out);
    expect_refused({"help", "rendr"}, 2, "there is no command 'rendr'; did you mean 'render'?");
}

TEST(Usage, TheManualPageHoldsTheHelpOfEveryCommand) {
    std::string page = read_text(OPALINE_MAN_PAGE);
    EXPECT_THAT(page, StartsWith(".TH OPALINE 1\n.SH NAME\nopaline \\- "));
    for (std::size_t at = 0; (at = page.find("\\-", at)) != std::string::npos; ++at) {
        page.erase(at, 1);  // a minus sign of troff
    }
    for (const std::string& command : kCommands) {
        EXPECT_THAT(page, HasSubstr(run_opaline({command, "--help"}).out)) << command;
    }
}

TEST(Usage, VersionSaysWhatTheProgramIsMadeOf) {
    const Outcome version = run_well({"--version"});
    EXPECT_THAT(version.out, ::testing::ContainsRegex("^opaline [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("\n.opal files   version [0-9]+\n"));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("Embree [0-9.]+, isa="));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("\nbuild         [A-Za-z]+, "));
}

TEST(Usage, BadCommandLinesExitWithTwoAndSayWhereHelpIs) {
    SmallScene small;
    const std::string scene = small.scene(), out = small.path("x.opal");
    const std::vector<Arguments> bad = {
        {"bake", scene, "-o", out, "--error", "0"},
        {"bake", scene, "-o", out, "--error", "1"},
        {"bake", scene, "-o", out, "--error", "nan"},
        {"bake", scene, "-o", out, "--cubemap", "33"},
        {"bake", scene, "-o", out, "--coefficients", "many"},
        {"bake", scene, "-o", out, "--effects", "sparkle"},
        {"bake", scene, "-o", out, "--effects", "filtering"},
        {"bake", scene, "-o", out, "--effects", "volume-single"},
        {"plan", scene, "--effects", "multiple,specular"},
        {"bake", scene, "-o", out, "--threads", "x"},
        {"bake", scene, "-o", out, "--seed", "-1"},
        {"bake", scene, "-o", out, "--metres-per-unit", "0"},
        {"bake", scene, "-o", out, "--metres-per-unit", "nan"},
        {"bake", scene, "-o", out, "--metres-per-unit", "1e999"},
        {"plan"},
        {"info"},
        {"verify"},
        {"relight", out},
        {"render", out, "--light", "white"},
        {"compare", "a.exr"},
        {"phase"},  // hg without g
        {"phase", "--g", "1"},
        {"phase", "--g", "x"},
        {"phase", "--type", "rayleigh", "--g", "0.5"},
        {"phase", "--type", "gaussian"},
        {"phase", "--type", "gaussian", "--rms-angle", "0"},
        {"phase", "--type", "gaussian", "--rms-angle", "2"},
        {"phase", "--type", "table"},
        {"phase", "--g", "0.5", "--table", "file.csv"},
        {"phase", "--g", "0.5", "--samples", "1"},
        {"phase", "--g", "0.5", "--format", "xml"},
    };
    for (const Arguments& arguments : bad) {
        expect_refused(arguments, 2, "");
    }
    EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
}

TEST(Usage, BadRenderOptionsExitWithTwo) {
    SmallScene small;
    const std::string file = small.baked(), out = small.path("x.png");
    const Arguments render = {"render", file, "--light", "white", "-o"};
    const std::vector<Arguments> bad = {{"--size", "0x10"},
                                        {"--size", "10"},
                                        {"--size", "-5x5"},
                                        {"--eye", "1,2"},
                                        {"--eye", "1,2,nan"},
                                        {"--target", "a,b,c"},
                                        {"--fov", "0"},
                                        {"--fov", "180"},
                                        {"--frames", "0"},
                                        {"--frames", "-3"},
                                        {"--exposure", "bright"},
                                        {"--rotate-light", "inf"},
                                        {"--eye", "1,2,3", "--target", "1,2,3"}};
    for (const Arguments& options : bad) {
        expect_refused(join(join(render, {out}), options), 2, "");
    }
    expect_refused(join(render, {out, "--size", "100000x100000"}), 2,
                   "--size: '100000x100000' is not WIDTHxHEIGHT in pixels, each from 1 to 16384");
    for (const std::string name : {"x.gif", "x"}) {
        expect_refused(join(render, {small.path(name)}), 2, ".png or .exr");
    }
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

}  // namespace
}  // namespace opaline::tests
