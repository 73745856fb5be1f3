#include <gmock/gmock.h>

#include <algorithm>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Case {
    Arguments arguments;
    std::string message;  ///< its beginning, after "opaline: error: "
};

TEST(Messages, UsageErrorsSayWhatIsAccepted) {
    const std::string draft =
        "--quality: 'foo' is not one of draft, preview, production, reference";
    const std::vector<Case> cases = {
        {{}, "a command is missing (see `opaline --help`)"},
        {{"rendr"}, "there is no command 'rendr'; did you mean 'render'? (see `opaline --help`)"},
        {{"xyzzyxyzzy"}, "there is no command 'xyzzyxyzzy' (see"},
        {{"--versoin"}, "there is no option '--versoin'; did you mean '--version'?"},
        {{"bake"}, "SCENE and --output are missing (see `opaline bake --help`)"},
        {{"bake", "x"}, "--output is missing"},
        {{"bake", "", "-o", "y"}, "scene: the name is empty; give the path of a file"},
        {{"info", ""}, "file: the name is empty"},
        {{"verify", "x", ""}, "file: the name is empty"},
        {{"compare", "x", ""}, "b: the name is empty"},
        {{"bake", "x", "-o"}, "--output: its value is missing"},
        {{"bake", "x", "-o", "y", "-o", "z"}, "--output: is given more than once"},
        {{"bake", "x", "-o", "y", "z"}, "'z' is one argument too many"},
        {{"bake", "x", "-o", "y", "--qualty", "draft"},
         "there is no option '--qualty'; did you mean '--quality'?"},
        {{"bake", "x", "-o", "y", "--quality", "foo"}, draft},
        {{"bake", "x", "-o", "y", "--quality", "2"}, "--quality: '2' is not one of draft, "},
        {{"bake", "x", "-o", "y", "--progress", "1"},
         "--progress: '1' is not one of auto, json, none"},
        {{"bake", "x", "-o", "y", "--error", ".1", "--quality", "draft"},
         "--quality cannot be given with --error"},
        {{"bake", "x", "-o", "y", "--threads", "-1"},
         "--threads: '-1' is not a whole number from 0 to 1024"},
        {{"bake", "x", "-o", "y", "--cubemap", "0"},
         "--cubemap: '0' is not one of 8, 16, 32, 64, 128"},
        {{"bake", "x", "-o", "y", "--cubemap", "abc"},
         "--cubemap: 'abc' is not one of 8, 16, 32, 64, 128"},
        {{"bake", "x", "-o", "y", "--coefficients", "0"},
         "--coefficients: '0' is not a whole number from 7 to 98304, nor `all`"},
        {{"bake", "x", "-o", "y", "--phase-terms", "5"},
         "--phase-terms: '5' is not one of 1, 4, 9, 16, 25"},
        {{"bake", "x", "-o", "y", "--view-terms", "5"}, "--view-terms: '5' is not one of 1, 4, 9"},
        {{"bake", "x", "-o", "y", "--view-terms", "16"},
         "--view-terms: '16' is not one of 1, 4, 9"},
        {{"bake", "x", "-o", "y", "--epsilon", "nan"},
         "--epsilon: 'nan' is not a number from 0 to 1"},
        {{"bake", "x", "-o", "y", "--seed", "18446744073709551616"},
         "--seed: '18446744073709551616' is not a whole number from 0 to 18446744073709551615"},
        {{"bake", "x", "-o", "y", "--seed", std::string(309, '9')},
         "--seed: '" + std::string(40, '9') + "...' is not a whole number"},
        {{"bake", "x", "-o", "y", "--metres-per-unit", "1e30"},
         "--metres-per-unit: '1e30' is not a number from 1e-10 to 1e+16"},
        {{"reference", "x", "-o", "y.exr", "--light", "white", "--metres-per-unit", "1e30"},
         "--metres-per-unit: '1e30' is not a number"},
        {{"reference", "x", "-o", "y.exr", "--light", "white", "--seconds", "nan"},
         "--seconds: 'nan' is not a number"},
        {{"render", "x", "--light", "white", "-o", "y.png", "--exposure", "nan"},
         "--exposure: 'nan' is not a number from -64 to 64"},
        {{"render", "x", "--light", "white", "-o", "y.png", "--rotate-light", "nan"},
         "--rotate-light: 'nan' is not a number"},
        {{"render", "x", "--light", "white", "-o", "y.png", "--fov", "nan"},
         "--fov: 'nan' is not a number above 0"},
        {{"render", "x", "--light", "white", "-o", "y.png", "--backend", "vulkan"},
         "--backend: 'vulkan' is not one of gl, cpu"},
        {{"compare", "a", "b", "--max-rel", "nan"}, "--max-rel: 'nan' is not a number"},
        {{"phase", "--type", "3", "--g", "0.3"}, "--type: '3' is not one of hg, "},
    };
    for (const auto& [arguments, message] : cases) {
        const Outcome outcome = run_opaline(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << ::testing::PrintToString(arguments);
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + message));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

// What a newcomer does first, and what to do instead.
TEST(Messages, SlipsOfANewcomerSayWhatToDo) {
    SmallScene small;
    const std::string scene = small.scene(), file = small.baked(), none = small.path("none.opal");
    const std::vector<Case> cases = {
        {{"render", scene, "-o", small.path("a.png")},
         scene + ": is a scene, not an .opal file (bake it first: opaline bake scene.glb -o "
                 "scene.opal)"},
        {{"bake", file, "-o", small.path("b.opal")},
         file + ": is baked already (did you mean `opaline render scene.opal`?"},
        {{"bake", scene, "-o", small.path("y.glb")},
         small.path("y.glb") + ": --output: programs would take it for a scene by its ending (end "
                               "the name in .opal)"},
        {{"example", "stature"}, "there is no example 'stature' (did you mean 'statue'?"},
        {{"example"}, "example: a name is needed"},
        // Before the file is read, which here there is not.
        {{"render", none, "--light", "studoi", "-o", small.path("a.png")},
         "studoi: is neither a file nor a built-in light (did you mean 'studio'? "},
        {{"relight", none, "--light", "studoi", "-o", small.path("a.csv")},
         "studoi: is neither a file nor a built-in light (did you mean 'studio'? "},
    };
    for (const auto& [arguments, message] : cases) {
        const Outcome outcome = run_opaline(arguments);
        EXPECT_NE(outcome.exit_code, 0) << ::testing::PrintToString(arguments);
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + message));
    }
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

TEST(Messages, AnExampleWithoutAFolderGetsOneOfItsName) {
    const TemporaryFolder folder;
    const auto write = [&](const char* name) {
        return run_any({"env", "-C", folder.path().string(), OPALINE_PROGRAM, "example", name});
    };
    EXPECT_EQ(write("glossy").out, "glossy/glossy.gltf\nglossy/glossy.bin\n");
    EXPECT_EQ(write("black").exit_code, 0);
    EXPECT_EQ(list_folder(folder.path()), (Arguments{"black.exr", "glossy"}));
}

TEST(Messages, SeedsOfSixtyFourBitsAreTaken) {
    SmallScene small;
    run_well({"plan", small.scene(), "--seed", "18446744073709551615"});
}

// What steers a terminal or reorders what it shows.
const std::string kHostile = "Bri\x1b[2Jck\xe2\x80\xae\xc2\x9b\x7f\r\"x";

void expect_harmless(const std::string& text, const std::string& from) {
    for (const char* bad : {"\x1b", "\xe2\x80\xae", "\xc2\x9b", "\x7f", "\r"}) {
        EXPECT_THAT(text, Not(HasSubstr(bad))) << from;
    }
}

TEST(Messages, NothingFromAFileReachesTheTerminalRaw) {
    SmallScene small;
    AssetBuilder asset = two_squares();
    asset.json["materials"][1]["name"] = kHostile;
    asset.json["meshes"][0]["name"] = kHostile;
    asset.json["nodes"][0]["name"] = kHostile;
    asset.json["materials"][1]["extensions"] = {{"EXT_" + kHostile, Json::object()}};
    write_file(small.scene(), asset.glb());
    const std::string out = small.path("a.opal");
    const Outcome bake =
        run_well({"bake", small.scene(), "-o", out, "--quality", "draft", "--progress", "json"});
    expect_harmless(bake.err, "bake");
    for (const Arguments& arguments : {Arguments{"plan", small.scene()},
                                       {"plan", small.scene(), "--json"},
                                       {"info", out},
                                       {"info", out, "--json"}}) {
        const Outcome outcome = run_well(arguments);
        EXPECT_THAT(outcome.out, HasSubstr("Bri")) << arguments[0];
        expect_harmless(outcome.out, arguments[0]);
        expect_harmless(outcome.err, arguments[0]);
    }
    const Json plan = Json::parse(run_opaline({"plan", small.scene(), "--json"}).out);
    EXPECT_EQ(plan.at("plan").back().at("subject"), "material '" + std::string(kHostile) + "'")
        << "machines read what is there";
    for (const char* line : {"\n", "{\"stage\""}) {
        EXPECT_THAT(bake.err, HasSubstr(line));
    }
}

TEST(Messages, NothingFromTheCommandLineReachesTheTerminalRaw) {
    SmallScene small;
    for (const Arguments& arguments :
         {Arguments{kHostile},
          {"bake", kHostile, "-o", small.path("a.opal")},
          {"info", kHostile},
          {"bake", small.scene(), "-o", kHostile + "/" + kHostile},
          {"bake", small.scene(), "-o", "x", "--quality", kHostile},
          {"bake", small.scene(), "-o", "x", "--" + kHostile},
          {"example", kHostile, "-o", small.path("")},
          {"relight", small.baked(), "--light", kHostile, "-o", small.path("a.csv")},
          {"relight", small.baked(), "--light", "white", "-o", "a.csv", "--terms", kHostile}}) {
        const Outcome outcome = run_opaline(arguments);
        EXPECT_NE(outcome.exit_code, 0);
        expect_harmless(outcome.err, ::testing::PrintToString(arguments));
    }
}

TEST(Messages, PlainLettersOfEveryScriptStayReadable) {
    SmallScene small;
    const std::string name = "K\xc3\xb6nig \xe7\x8e\x8b";
    const Outcome outcome = run_opaline({"info", small.path(name)});
    EXPECT_THAT(outcome.err, HasSubstr(name));
}

TEST(Messages, JsonErrorsAreInPlainWords) {
    SmallScene small;
    write_file(small.path("m.json"), std::string("{\"materials\": {\"Brick\": }}"));
    const Outcome media = run_opaline({"plan", small.scene(), "--media", small.path("m.json")});
    EXPECT_EQ(media.exit_code, 3);
    EXPECT_THAT(media.err, Not(HasSubstr("json.exception")));
    EXPECT_THAT(media.err, HasSubstr("line 1, column 2"));
    write_file(small.path("s.gltf"), std::string("{\"asset\": {\"version\": 2.0]}"));
    const Outcome scene = run_opaline({"plan", small.path("s.gltf")});
    EXPECT_EQ(scene.exit_code, 3);
    EXPECT_THAT(scene.err, Not(HasSubstr("json.exception")));
    EXPECT_THAT(scene.err, HasSubstr("line 1, column 2"));
}

TEST(Messages, StrictMakesWarningsErrorsAndWritesNothing) {
    SmallScene small;
    write_file(small.path("m.json"),
               Json{{"materials", {{"Nobody", {{"preset", "marble"}}}}}}.dump());
    const Arguments bake = {"bake",    small.scene(),        "-o",        small.path("a.opal"),
                            "--media", small.path("m.json"), "--quality", "draft"};
    Arguments strict = bake;
    strict.push_back("--strict");
    expect_refused(strict, 3, "");
    EXPECT_FALSE(std::filesystem::exists(small.path("a.opal")));
    const Outcome warned = run_well(bake);
    EXPECT_THAT(warned.err, StartsWith("opaline: warning: "));
    Arguments quiet = bake;
    quiet.insert(quiet.begin(), "--quiet");  // before the command as well as after it
    const Outcome silent = run_well(quiet);
    EXPECT_EQ(silent.err, "");
}

TEST(Json, VerifyTellsOfEveryFile) {
    SmallScene small;
    const std::string sound = small.baked(), damaged = small.path("damaged.opal");
    std::string bytes = read_text(sound);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file(damaged, bytes);
    const Outcome text = run_opaline({"verify", sound, damaged, sound});
    EXPECT_EQ(text.exit_code, 1) << text.err;
    EXPECT_EQ(text.out, sound + ": sound\n" + sound + ": sound\n");
    EXPECT_THAT(text.err, HasSubstr(damaged));
    const Outcome outcome = run_opaline({"verify", "--json", sound, damaged});
    EXPECT_EQ(outcome.exit_code, 1);
    const Json files = Json::parse(outcome.out).at("files");
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files.at(0).at("file"), sound);
    EXPECT_TRUE(files.at(0).at("sound").get<bool>());
    EXPECT_FALSE(files.at(1).at("sound").get<bool>());
    EXPECT_FALSE(files.at(1).at("errors").empty());
    EXPECT_EQ(run_opaline({"verify", sound, damaged, small.path("none")}).exit_code, 3);
}

TEST(Json, RelightAndCompareTellTheirResults) {
    SmallScene small;
    const std::string a = small.path("a.csv"), b = small.path("b.csv");
    const Outcome relight =
        run_well({"relight", small.baked(), "--light", "white", "-o", a, "--json"});
    const Json told = Json::parse(relight.out);
    EXPECT_EQ(told.at("receivers"), 8);
    EXPECT_EQ(told.at("primitives"), 2);
    EXPECT_GT(told.at("maximum").get<double>(), told.at("mean").at(0).get<double>());
    run_well({"relight", small.baked(), "--light", "studio", "-o", b});
    const Outcome same = run_well({"compare", a, a, "--json", "--max-rel", "0"});
    EXPECT_EQ(Json::parse(same.out).at("rmse"), 0);
    EXPECT_TRUE(Json::parse(same.out).at("within").get<bool>());
    const Outcome other = run_opaline({"compare", a, b, "--json", "--max-rel", "0.001"});
    EXPECT_EQ(other.exit_code, 1) << other.err;
    EXPECT_EQ(Json::parse(other.out).at("elements"), 8);
    EXPECT_FALSE(Json::parse(other.out).at("within").get<bool>());
}

TEST(Pictures, ReferenceWritesPngToo) {
    SmallScene small;
    const std::string out = small.path("a.PNG");
    run_well({"reference", small.scene(), "--light", "white", "--size", "16x16", "--spp", "4", "-o",
              out});
    EXPECT_THAT(read_text(out), StartsWith("\x89PNG"));
    EXPECT_TRUE(std::filesystem::exists(small.path("a.var.exr")));
}

// Without a driver: EGL's loader is sent to a folder that has none.
TEST(Pictures, WithoutOpenGlTheProcessorDraws) {
    SmallScene small;
    const std::string out = small.path("a.png"), cpu = small.path("b.png");
    const Arguments draw = {"render", small.baked(), "--light", "white", "--size", "32x32", "-o"};
    Arguments first = {"env", "__EGL_VENDOR_LIBRARY_DIRS=/nowhere", OPALINE_PROGRAM};
    first.insert(first.end(), draw.begin(), draw.end());
    Arguments explicit_gl = first;
    first.push_back(out);
    explicit_gl.insert(explicit_gl.end(), {out, "--backend", "gl"});
    const Outcome fallen = run_any(first);
    ASSERT_EQ(fallen.exit_code, 0) << fallen.err;
    EXPECT_THAT(fallen.err, HasSubstr("drawing on the CPU"));
    run_well(join(draw, {cpu, "--backend", "cpu"}));
    EXPECT_EQ(read_text(out), read_text(cpu));
    const Outcome refused = run_any(explicit_gl);
    EXPECT_EQ(refused.exit_code, 4) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("use --backend cpu"));
}

TEST(Completion, CommandsAndOptionsComeFromHelp) {
    const auto complete = [](const std::string& words) {
        return run_any({"bash", "-c",
                        "source " OPALINE_COMPLETION "; COMP_WORDS=(" OPALINE_PROGRAM " " + words +
                            "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _opaline; "
                            "echo ${COMPREPLY[@]}"})
            .out;
    };
    EXPECT_EQ(complete("re"), "render relight reference\n");
    EXPECT_EQ(complete("compare --max"), "--max-rel\n");
    EXPECT_EQ(complete("info /proc/meminf"), "/proc/meminfo\n");
}

}  // namespace
}  // namespace opaline::tests
