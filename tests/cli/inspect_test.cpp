#include <gmock/gmock.h>

#include "tests/cli/small_scene.h"
#include "tests/formats/opal/asset_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Info, TellsKnobsPlanErrorAndSections) {
    SmallScene small;
    const Outcome text = run_well({"info", small.baked()});
    for (const char* word :
         {"cube map 16", "measured error", "% RMS (95 %: ", "direct", "Brick", "TRAN", "MESH"}) {
        EXPECT_THAT(text.out, HasSubstr(word));
    }
    const Outcome json = run_well({"info", small.baked(), "--json"});
    EXPECT_TRUE(Json::parse(json.out).is_object());
}

// Review 1, fault 22: nothing is computed from PROV, so a file without it conforms.
TEST(Verify, AFileWithoutProvenanceIsSound) {
    SmallScene small;
    formats::Asset asset = make_small_asset();
    asset.provenance.clear();
    const std::string path = small.write(asset, "bare.opal");
    EXPECT_EQ(read_text(path).find("PROV"), std::string::npos);
    run_well({"verify", path});
}

TEST(Verify, EveryFlippedByteIsFoundOutAndNamed) {
    SmallScene small;
    const std::string whole = read_text(small.baked()), file = small.path("damaged.opal");
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 40) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        write_file(file, damaged);
        const Outcome verify = run_opaline({"verify", file});
        // Padding between sections is the only place that means nothing.
        if (verify.exit_code == 0) {
            EXPECT_EQ(whole[at], 0) << at;
            continue;
        }
        EXPECT_EQ(verify.exit_code, 1) << at << verify.err;
        EXPECT_THAT(verify.err, StartsWith("opaline: error: " + file)) << at;
    }
}

TEST(Verify, TruncatedFileIsDamagedAndOthersAreNoOpalFiles) {
    SmallScene small;
    const std::string whole = read_text(small.baked()), file = small.path("damaged.opal");
    write_file(file, whole.substr(0, whole.size() / 2));
    EXPECT_EQ(run_opaline({"verify", file}).exit_code, 1);
    EXPECT_EQ(run_opaline({"verify", small.path("nowhere")}).exit_code, 3);
    for (const char* command : {"info", "render", "relight"}) {
        Arguments arguments = {command, file};
        if (command != std::string("info")) {
            arguments.insert(arguments.end(), {"--light", "white", "-o", small.path("x.exr")});
        }
        const Outcome outcome = run_opaline(arguments);
        EXPECT_EQ(outcome.exit_code, 3) << command << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + file));
        EXPECT_FALSE(std::filesystem::exists(small.path("x.exr")));
    }
}

TEST(Compare, TableEqualsItselfAndTellsADifference) {
    const TemporaryFolder folder;
    const std::string a = folder / "a.csv", b = folder / "b.csv";
    write_file(a, std::string("primitive,vertex,r,g,b\n0,0,1,1,1\n0,1,2,2,2\n"));
    write_file(b, std::string("primitive,vertex,r,g,b\n0,0,1,1,1\n0,1,2.2,2.2,2.2\n"));
    run_well({"compare", a, a, "--max-rel", "0"});
    const Outcome differs = run_opaline({"compare", b, a, "--max-rel", "0.01"});
    EXPECT_EQ(differs.exit_code, 1);
    // RMS of the difference over RMS of the reference: sqrt(0.04 / 5).
    EXPECT_THAT(differs.out, HasSubstr("0.0894"));
    run_well({"compare", b, a, "--max-rel", "0.1"});
}

TEST(Compare, ThingsThatCannotBeComparedAreRefused) {
    const TemporaryFolder folder;
    const std::string a = folder / "a.csv", b = folder / "b.csv";
    write_file(a, std::string("primitive,vertex,r,g,b\n0,0,1,1,1\n"));
    for (const char* text :
         {"", "hello\n", "primitive,vertex,r,g,b\n", "primitive,vertex,r,g,b\n0,1,1,1,1\n",
          "primitive,vertex,r,g,b\n0,0,1,x,1\n", "primitive,vertex,r,g,b\n0,0,1,nan,1\n"}) {
        write_file(b, std::string(text));
        expect_refused({"compare", a, b}, 3, "");
    }
}

}  // namespace
}  // namespace opaline::tests
