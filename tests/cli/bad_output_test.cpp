#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(BadOutput, MissingFolderIsNamedBeforeAnyWork) {
    SmallScene small;
    const std::string nowhere = small.path("no/such/out");
    for (const std::string option : {"-o", "--report", "--depfile"}) {
        Arguments arguments = {"bake", small.scene(), option, nowhere};
        if (option != "-o") {
            arguments.insert(arguments.end(), {"-o", small.path("out.opal")});
        }
        const Outcome bake = run_opaline(arguments);
        EXPECT_EQ(bake.exit_code, 4) << bake.err;
        EXPECT_THAT(bake.err, StartsWith("opaline: error: " + nowhere));
        EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
    }
}

TEST(BadOutput, PathThroughAFileIsNamed) {
    SmallScene small;
    expect_refused({"bake", small.scene(), "-o", small.scene() + "/out.opal"}, 4, "out.opal");
}

TEST(BadOutput, FolderInPlaceOfTheOutputIsLeftAlone) {
    SmallScene small;
    std::filesystem::create_directory(small.path("out.opal"));
    expect_refused({"bake", small.scene(), "-o", small.path("out.opal")}, 4, "");
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"out.opal", "scene.glb"}));
}

TEST(BadOutput, DeviceThatIsFullIsAnError) {
    SmallScene small;
    expect_refused({"bake", small.scene(), "-o", "/dev/full"}, 4, "No space left on device");
}

TEST(BadOutput, DataThatStandardOutputCannotTakeIsAnError) {
    SmallScene small;
    for (const std::string& command :
         {"info '" + small.baked() + "'", "plan '" + small.scene() + "'",
          std::string("example --list"), std::string("--help"), std::string("--version")}) {
        const Outcome outcome =
            run_any({"sh", "-c", OPALINE_PROGRAM " " + command + " >/dev/full"});
        EXPECT_EQ(outcome.exit_code, 4) << command << outcome.err;
    }
}

// The next file that is opened takes the number of a descriptor that is closed: what is printed
// would stand in it.
TEST(BadOutput, MessagesThatNobodyCanReadStandInNoFileAndStopNoBake) {
    SmallScene small;
    run_well({"bake", small.scene(), "--quality", "draft", "-o", small.path("a.opal")});
    const std::string sound = read_text(small.path("a.opal"));
    for (const std::string streams : {"2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2>/dev/full"}) {
        const std::string out = small.path("b.opal");
        const Outcome bake =
            run_any({"sh", "-c",
                     OPALINE_PROGRAM " bake '" + small.scene() +
                         "' --quality draft --progress json -o '" + out + "' " + streams});
        EXPECT_TRUE(bake.exit_code == 0 || bake.exit_code == 4) << streams << bake.exit_code;
        EXPECT_EQ(read_text(out) == sound, bake.exit_code == 0) << streams;
        std::filesystem::remove(out);
    }
}

/// Runs a shell line on a file system of 64 kB mounted on $1, seen by that shell alone.
Outcome run_on_small_disk(const std::string& folder, const std::string& line) {
    return run_any({"unshare", "--map-root-user", "--mount", "sh", "-c",
                    "mount -t tmpfs -o size=64k none \"$1\" || exit 99; " + line, "sh", folder});
}

TEST(BadOutput, FullDiskLeavesTheFormerFileAndNothingElse) {
    SmallScene small;
    write_file(small.path("sheet.glb"), wavy_sheet(64).glb());
    const TemporaryFolder disk;
    const std::string out = disk / "out.opal";
    if (run_on_small_disk(disk.path(), "true").exit_code != 0) {
        GTEST_SKIP() << "no right to mount a small disk here";
    }
    const Outcome outcome = run_on_small_disk(
        disk.path(), "echo former > '" + out + "'; " OPALINE_PROGRAM " bake '" +
                         small.path("sheet.glb") + "' --quality draft -o '" + out +
                         "'; code=$?; cat \"$1\"/*; ls -A \"$1\"; exit $code");
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + out));
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
    EXPECT_EQ(outcome.out, "former\nout.opal\n");
}

TEST(BadOutput, PastTheLimitOfFileSizesLeavesTheFormerFileAndNothingElse) {
    SmallScene small;
    const std::string file = small.baked(), out = small.path("a.exr");
    write_file(out, "former");
    const Outcome outcome = run_any({"sh", "-c",
                                     "ulimit -f 20; exec " OPALINE_PROGRAM " render '" + file +
                                         "' --light studio --backend cpu -o '" + out + "'"});
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + out));
    EXPECT_THAT(outcome.err, HasSubstr("File too large (raise the limit of file sizes"));
    EXPECT_EQ(read_text(out), "former");
}

}  // namespace
}  // namespace opaline::tests
