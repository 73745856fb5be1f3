#include <gmock/gmock.h>

#include <sstream>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const Json kMarble = {{"preset", "marble"}};

/// Two squares of "Chalk" and "Brick", and media files beside them.
class MediaOption : public ::testing::Test {
  protected:
    std::string media(const Json& materials) {
        const std::string path = small_.path("media.json");
        write_file(path, Json{{"materials", materials}}.dump());
        return path;
    }
    /// Subjects of `multiple` that are on, in the plan of the scene.
    std::vector<std::string> translucent(const Arguments& more, std::string* warnings = nullptr) {
        const Outcome plan =
            run_well(join({"plan", small_.scene(), "--json", "--effects", "auto"}, more));
        if (warnings != nullptr) {
            *warnings = plan.err;
        } else {
            // Squares are open, which is all there is to say about them.
            std::istringstream lines(plan.err);
            for (std::string line; std::getline(lines, line);) {
                EXPECT_THAT(line, HasSubstr("the surface of the medium is open"));
            }
        }
        std::vector<std::string> subjects;
        const Json parsed = Json::parse(plan.out);
        for (const Json& entry : parsed.at("plan")) {
            if (entry.at("effect") == "multiple" && entry.at("decision") == "on") {
                subjects.push_back(entry.at("subject"));
            }
        }
        return subjects;
    }
    /// Bakes with a media file that cannot be used: exit code 3, nothing written.
    std::string refuse(const std::string& path) {
        const auto before = list_folder(small_.folder());
        const Outcome bake = run_opaline({"bake", small_.scene(), "--media", path, "-o",
                                          small_.path("out.opal"), "--quality", "draft"});
        EXPECT_EQ(bake.exit_code, 3) << bake.err;
        EXPECT_THAT(bake.err, StartsWith("opaline: error: " + path));
        EXPECT_EQ(bake.out, "");
        EXPECT_EQ(list_folder(small_.folder()), before);
        return bake.err;
    }
    SmallScene small_;
};

TEST_F(MediaOption, MaterialsAreMatchedByNameAndStarIsEveryOther) {
    EXPECT_TRUE(translucent({}).empty());
    const std::vector<std::string> brick{"material 'Brick'"};
    EXPECT_EQ(translucent({"--media", media({{"Brick", kMarble}})}), brick);
    EXPECT_EQ(translucent({"--media", media({{"*", kMarble}})}).size(), 2u);
    EXPECT_EQ(translucent({"--media", media({{"*", kMarble}, {"Chalk", {{"opaque", true}}}})}),
              brick);
}

TEST_F(MediaOption, NameThatNoMaterialHasIsAWarningThatListsTheNames) {
    std::string warnings;
    EXPECT_TRUE(translucent({"--media", media({{"Jade", kMarble}})}, &warnings).empty());
    EXPECT_THAT(warnings,
                AllOf(StartsWith("opaline: warning: " + small_.path("media.json")),
                      HasSubstr("materials > Jade: the scene has no material of this name"),
                      HasSubstr("it has: 'Chalk', 'Brick'")));
    EXPECT_EQ(
        translucent({"--media", media({{"Jade", kMarble}, {"*", kMarble}})}, &warnings).size(), 2u);
    EXPECT_THAT(warnings, AllOf(HasSubstr("Jade"), Not(HasSubstr("> *"))));
}

TEST_F(MediaOption, BakeTellsWhichMediaFileItRead) {
    const std::string file = media({{"Brick", kMarble}}), out = small_.path("out.opal"),
                      depfile = small_.path("out.d"), report = small_.path("r.json");
    run_well({"bake", small_.scene(), "--media", file, "-o", out, "--depfile", depfile, "--report",
              report, "--quality", "draft", "--samples", "200"});
    EXPECT_THAT(read_text(depfile), HasSubstr(file));
    run_well({"verify", out});
    // The media belong to the input: the hash must change with them.
    run_well({"bake", small_.scene(), "-o", out, "--report", small_.path("plain.json"), "--quality",
              "draft"});
    EXPECT_NE(Json::parse(read_text(report)).at("scene").at("sha256"),
              Json::parse(read_text(small_.path("plain.json"))).at("scene").at("sha256"));
}

// Volumes lie in libraries.
TEST_F(MediaOption, AllowPathReadsFilesOfAnotherFolder) {
    const TemporaryFolder library;
    write_file(library / "table.csv", "-1 1\n1 1\n");
    const std::string file =
        media({{"Brick",
                {{"preset", "marble"},
                 {"phase", {{"type", "table"}, {"file", (library / "table.csv").string()}}}}}});
    EXPECT_THAT(refuse(file), HasSubstr("--allow-path DIR"));
    EXPECT_EQ(translucent({"--media", file, "--allow-path", small_.folder().string(),
                           "--allow-path", library.path().string()})
                  .size(),
              1u);
}

TEST_F(MediaOption, FaultyFilesAreRefusedWithTheElement) {
    EXPECT_THAT(
        refuse(media({{"Brick", {{"preset", "marble"}, {"colour", 1}}}})),
        AllOf(HasSubstr("materials > Brick > "), HasSubstr("colour: there is no such key")));
    EXPECT_THAT(refuse(media({{"Brick", {{"preset", "granite"}}}})),
                AllOf(HasSubstr("'granite'"), HasSubstr("marble")));
    EXPECT_THAT(refuse(media({{"Brick", {{"sigma_s", {1, 1, 1}}, {"sigma_a", {0, 0, -1}}}}})),
                HasSubstr("materials > Brick > sigma_a"));
    write_file(small_.path("broken.json"), std::string("{\"materials\": "));
    EXPECT_THAT(refuse(small_.path("broken.json")), HasSubstr("JSON"));
}

TEST_F(MediaOption, MediaMayStandInTheSceneItself) {
    AssetBuilder asset = two_squares();
    asset.json["extensions"]["OPALINE_media"] = {{"materials", {{"Chalk", kMarble}}}};
    write_file(small_.scene(), asset.glb());
    EXPECT_EQ(translucent({}), std::vector<std::string>{"material 'Chalk'"});
    // The command line has the last word, on the materials that it names.
    EXPECT_EQ(translucent({"--media", media({{"Brick", kMarble}, {"Chalk", {{"opaque", true}}}})}),
              std::vector<std::string>{"material 'Brick'"});

    asset.json["extensions"]["OPALINE_media"] = {{"materials", {{"Chalk", {{"color", 1}}}}}};
    write_file(small_.scene(), asset.glb());
    const Outcome plan = run_opaline({"plan", small_.scene()});
    EXPECT_EQ(plan.exit_code, 3);
    EXPECT_THAT(plan.err, AllOf(StartsWith("opaline: error: " + small_.scene()),
                                HasSubstr("extensions > OPALINE_media > materials > Chalk")));
}

}  // namespace
}  // namespace opaline::tests
