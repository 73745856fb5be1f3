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
    const Outcome help = run_opaline({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    for (const std::string& command : kCommands) {
        EXPECT_THAT(help.out, HasSubstr("\n  " + command + " "));
    }
    EXPECT_THAT(help.out, HasSubstr("130 interrupted"));
}

TEST(Usage, EveryCommandExplainsItselfWithAnExample) {
    for (const std::string& command : kCommands) {
        const Outcome help = run_opaline({command, "--help"});
        EXPECT_EQ(help.exit_code, 0) << command;
        EXPECT_THAT(help.out, HasSubstr("Example:\n  opaline " + command + " ")) << command;
    }
}

TEST(Usage, HelpExplainsACommandByNameAndVIsTheVersion) {
    EXPECT_EQ(run_opaline({"help"}).out, run_opaline({"--help"}).out);
    EXPECT_EQ(run_opaline({"help", "bake"}).out, run_opaline({"bake", "--help"}).out);
    EXPECT_EQ(run_opaline({"-v"}).out, run_opaline({"--version"}).out);
    const Outcome unknown = run_opaline({"help", "rendr"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("there is no command 'rendr'; did you mean 'render'?"));
}

TEST(Usage, WhatAFirstBakeNeedsStandsFirstInItsHelp) {
    const std::string help = run_opaline({"bake", "--help"}).out;
    const std::size_t others = help.find("\nKnobs, which --quality and --error set:\n");
    ASSERT_NE(others, std::string::npos);
    for (const char* option :
         {"--output", "--media", "--quality", "--error", "--metres-per-unit"}) {
        EXPECT_LT(help.find(option), others) << option;
    }
    for (const char* option : {"--threads", "--volume-walks", "--emitter-rays", "--report"}) {
        EXPECT_GT(help.find(std::string("\n  ") + option), others) << option;
    }
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
    const Outcome version = run_opaline({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, ::testing::ContainsRegex("^opaline [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("\n.opal files   version [0-9]+\n"));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("Embree [0-9.]+, isa="));
    EXPECT_THAT(version.out, ::testing::ContainsRegex("\nbuild         [A-Za-z]+, "));
}

TEST(Usage, BadCommandLinesExitWithTwoAndSayWhereHelpIs) {
    SmallScene small;
    const std::string scene = small.scene(), out = small.path("x.opal");
    const std::vector<Arguments> bad = {
        {},
        {"bakee"},
        {"bake", scene},  // no output
        {"bake", scene, "-o", out, "--unknown"},
        {"bake", scene, "-o", out, "--quality", "best"},
        {"bake", scene, "-o", out, "--error", "0"},
        {"bake", scene, "-o", out, "--error", "1"},
        {"bake", scene, "-o", out, "--error", "nan"},
        {"bake", scene, "-o", out, "--error", "0.02", "--quality", "draft"},
        {"bake", scene, "-o", out, "--cubemap", "33"},
        {"bake", scene, "-o", out, "--cubemap", "-8"},
        {"bake", scene, "-o", out, "--coefficients", "3"},
        {"bake", scene, "-o", out, "--coefficients", "many"},
        {"bake", scene, "-o", out, "--effects", "sparkle"},
        {"bake", scene, "-o", out, "--effects", "filtering"},
        {"bake", scene, "-o", out, "--effects", "volume-single"},
        {"bake", scene, "-o", out, "--effects", "all,direct"},
        {"bake", scene, "-o", out, "--effects", "single"},  // no medium
        {"plan", scene, "--effects", "multiple,specular"},
        {"bake", scene, "-o", out, "--threads", "-1"},
        {"bake", scene, "-o", out, "--threads", "x"},
        {"bake", scene, "-o", out, "--seed", "-1"},
        {"bake", scene, "-o", out, "--metres-per-unit", "0"},
        {"bake", scene, "-o", out, "--metres-per-unit", "-1"},
        {"bake", scene, "-o", out, "--metres-per-unit", "nan"},
        {"bake", scene, "-o", out, "--metres-per-unit", "1e999"},
        {"bake", scene, "-o", out, "--progress", "loud"},
        {"bake", scene, "-o", scene},  // would overwrite its input
        {"plan"},
        {"info"},
        {"verify"},
        {"relight", out},
        {"render", out, "--light", "white"},
        {"compare", "a.exr"},
        {"phase"},  // hg without g
        {"phase", "--g", "1"},
        {"phase", "--g", "nan"},
        {"phase", "--g", "x"},
        {"phase", "--type", "mie"},
        {"phase", "--type", "rayleigh", "--g", "0.5"},
        {"phase", "--type", "gaussian"},
        {"phase", "--type", "gaussian", "--rms-angle", "0"},
        {"phase", "--type", "gaussian", "--rms-angle", "2"},
        {"phase", "--type", "table"},
        {"phase", "--g", "0.5", "--table", "file.csv"},
        {"phase", "--g", "0.5", "--samples", "1"},
        {"phase", "--g", "0.5", "--format", "xml"},
        {"example", "no-such-scene", "-o", small.path("")},
    };
    for (const Arguments& arguments : bad) {
        const Outcome outcome = run_opaline(arguments);
        const std::string line = ::testing::PrintToString(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << line << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: ")) << line;
        EXPECT_EQ(outcome.out, "") << line;
    }
    EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
}

TEST(Usage, BadRenderOptionsExitWithTwo) {
    SmallScene small;
    const std::string file = small.baked(), out = small.path("x.png");
    const std::vector<Arguments> bad = {
        {"--size", "0x10"},       {"--size", "10"},         {"--size", "-5x5"},
        {"--size", "99999x9"},    {"--eye", "1,2"},         {"--eye", "1,2,nan"},
        {"--target", "a,b,c"},    {"--fov", "0"},           {"--fov", "180"},
        {"--frames", "0"},        {"--frames", "-3"},       {"--backend", "vulkan"},
        {"--exposure", "bright"}, {"--rotate-light", "inf"}};
    for (const Arguments& options : bad) {
        Arguments arguments = {"render", file, "--light", "white", "-o", out};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run_opaline(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << ::testing::PrintToString(options) << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: "));
    }
    for (const std::string name : {"x.gif", "x"}) {
        const Outcome outcome =
            run_opaline({"render", file, "--light", "white", "-o", small.path(name)});
        EXPECT_EQ(outcome.exit_code, 2) << name;
        EXPECT_THAT(outcome.err, HasSubstr(".png or .exr"));
    }
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

TEST(Usage, EyeInsideItsTargetIsRefused) {
    SmallScene small;
    const Outcome outcome =
        run_opaline({"render", small.baked(), "--light", "white", "-o", small.path("x.png"),
                     "--eye", "1,2,3", "--target", "1,2,3"});
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
}

}  // namespace
}  // namespace opaline::tests
