#include <unistd.h>

#include <gmock/gmock.h>

#include <limits>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Bakes a file that cannot be baked: exit code 3, the file named, nothing written.
class BadScene : public ::testing::Test {
  protected:
    std::string refuse(const std::string& name) {
        const auto before = list_folder(folder_.path());
        const std::string scene = folder_ / name;
        const Outcome bake =
            run_opaline({"bake", scene, "-o", folder_ / "out.opal", "--report", folder_ / "r.json",
                         "--depfile", folder_ / "out.d", "--quality", "draft"});
        EXPECT_EQ(bake.exit_code, 3) << name << bake.err;
        EXPECT_THAT(bake.err, StartsWith("opaline: error: " + scene));
        EXPECT_EQ(bake.out, "");
        EXPECT_EQ(list_folder(folder_.path()), before);
        return bake.err;
    }
    std::string refuse_asset(const AssetBuilder& asset) {
        write_file(folder_ / "scene.glb", asset.glb());
        return refuse("scene.glb");
    }
    TemporaryFolder folder_;
};

// tests/formats/gltf has every fault of a file; here, one of each kind.
TEST_F(BadScene, IsNamedAndNothingIsWritten) {
    const Blob whole = two_squares().glb();
    write_file(folder_ / "empty.glb", std::string());
    write_file(folder_ / "cut.glb", Blob(whole.begin(), whole.begin() + long(whole.size() / 2)));
    write_file(folder_ / "text.gltf", std::string("hello"));
    write_file(folder_ / "model.obj", std::string("v 0 0 0\n"));
    write_file(folder_ / "smoke.vdb", std::string("vdb"));
    write_file(folder_ / "bufferless.gltf", two_squares().text_with_external_buffer());
    std::filesystem::create_directory(folder_ / "folder.glb");
    for (const auto& [name, says] : {std::pair{"nowhere.glb", "nowhere.glb"},
                                     {"empty.glb", ""},
                                     {"cut.glb", ""},
                                     {"text.gltf", ""},
                                     {"model.obj", ""},
                                     {"smoke.vdb", "OpenVDB"},
                                     {"bufferless.gltf", "buffer.bin"},
                                     {"folder.glb", ""}}) {
        EXPECT_THAT(refuse(name), HasSubstr(says));
    }
    AssetBuilder asset = two_squares();
    asset.json["accessors"][0]["count"] = 5000;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("accessor 0"));
}

TEST_F(BadScene, FlippedBitsNeverCrashABake) {
    const Blob whole = two_squares().glb();
    const std::string scene = folder_ / "flipped.glb", out = folder_ / "out.opal";
    int refused = 0;
    for (std::size_t bit = 3; bit < whole.size() * 8; bit += whole.size() * 8 / 60) {
        Blob damaged = whole;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        write_file(scene, damaged);
        const Outcome bake = run_opaline({"bake", scene, "-o", out, "--quality", "draft"});
        ASSERT_TRUE(bake.exit_code == 0 || bake.exit_code == 3) << bit << bake.err;
        EXPECT_EQ(std::filesystem::exists(out), bake.exit_code == 0) << bit;
        if (bake.exit_code == 0) {
            run_well({"verify", out});
            std::filesystem::remove(out);
        } else {
            EXPECT_THAT(bake.err, StartsWith("opaline: error: " + scene)) << bit;
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

using formats::Rgb;

class BadLight : public ::testing::Test {
  protected:
    Outcome relight(const std::string& light) {
        return run_opaline({"relight", small_.baked(), "--light", light, "-o", out()});
    }
    std::string refuse(const std::string& light, int exit_code = 3) {
        const Outcome outcome = relight(light);
        EXPECT_EQ(outcome.exit_code, exit_code) << light << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: "));
        EXPECT_FALSE(std::filesystem::exists(out()));
        return outcome.err;
    }
    std::string out() const { return small_.path("out.csv"); }
    /// A map of 8 x 4 texels of radiance 1, but for the texel in the middle of the sky.
    std::string write_map(Rgb odd) {
        formats::Image image{8, 4, std::vector<Rgb>(32, Rgb{1, 1, 1})};
        image.pixel[4] = odd;
        const std::string path = small_.path("map.exr");
        EXPECT_TRUE(formats::write_exr(path, image));
        return path;
    }
    SmallScene small_;
};

TEST_F(BadLight, FileThatIsNoExrIsRefusedWhateverItsName) {
    write_file(small_.path("fake.exr"), std::string("PNG? no. EXR? no."));
    EXPECT_THAT(refuse(small_.path("fake.exr")), HasSubstr("fake.exr"));
    write_file(small_.path("empty.exr"), std::string());
    refuse(small_.path("empty.exr"));
    refuse(small_.path("nowhere.exr"));
}

TEST_F(BadLight, TexelsThatAreNoNumbersOrNegativeBecomeBlackWithAWarning) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    ASSERT_EQ(relight(write_map({0, 0, 0})).exit_code, 0);
    const std::string black = read_text(out());
    for (const Rgb& odd : {Rgb{nan, nan, nan}, Rgb{-3, -3, -3}}) {
        const Outcome outcome = relight(write_map(odd));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: warning: "));
        EXPECT_EQ(read_text(out()), black);
    }
    EXPECT_EQ(relight(write_map({inf, inf, inf})).exit_code, 0);
    EXPECT_THAT(read_text(out()), ::testing::Not(::testing::ContainsRegex("inf|nan")));
}

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
