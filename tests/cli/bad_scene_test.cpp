#include <gmock/gmock.h>

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

}  // namespace
}  // namespace opaline::tests
