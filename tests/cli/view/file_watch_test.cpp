#include "bake/cli/view/file_watch.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace opaline::cli {
namespace {

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST(FileWatch, SaysOnceThatAFileChangedAndOnlyWhenItRests) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / "file";
    write_text(path, "a");
    FileWatch watch(path);
    EXPECT_FALSE(watch.look());
    EXPECT_FALSE(watch.look());
    write_text(path, "longer");
    EXPECT_FALSE(watch.look()) << "it may still be written";
    EXPECT_TRUE(watch.look());
    EXPECT_FALSE(watch.look());
}

TEST(FileWatch, SeesAFileThatTookThePlaceOfAnother) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / "file", next = folder / "next";
    write_text(path, "a");
    FileWatch watch(path);
    std::filesystem::remove(path);
    EXPECT_FALSE(watch.look());
    EXPECT_FALSE(watch.look()) << "a file that is gone has not changed";
    write_text(next, "b");
    std::filesystem::rename(next, path);
    EXPECT_FALSE(watch.look());
    EXPECT_TRUE(watch.look());
}

}  // namespace
}  // namespace opaline::cli
