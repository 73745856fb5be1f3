#include "formats/opal/atomic_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.h"

namespace opaline::formats {
namespace {

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, AppearsWithItsWholeContentOnCommit) {
    const tests::TemporaryFolder folder;
    ASSERT_TRUE(write_file_atomically(folder / "out", "whole"));
    EXPECT_EQ(contents(folder / "out"), "whole");
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(AtomicFile, LeavesTheOldFileAndNothingElseWithoutCommit) {
    const tests::TemporaryFolder folder;
    ASSERT_TRUE(write_file_atomically(folder / "out", "old"));
    {
        auto file = AtomicFile::create(folder / "out");
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->write("new, but never finished"));
        EXPECT_EQ(contents(folder / "out"), "old");
        EXPECT_EQ(files_in(folder.path()), 2u);
    }
    EXPECT_EQ(contents(folder / "out"), "old");
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(AtomicFile, SaysWhatIsWrongWithAnImpossibleTarget) {
    const tests::TemporaryFolder folder;
    const auto missing = AtomicFile::create(folder / "no" / "such" / "file");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, ErrorKind::resource);
    EXPECT_FALSE(missing.error().diagnostics.front().remedy.empty());
    const auto is_folder = AtomicFile::create(folder.path());
    ASSERT_FALSE(is_folder);
    EXPECT_EQ(is_folder.error().diagnostics.front().fault, "is a folder");
}

TEST(AtomicFile, WritesToDevicesDirectly) {
    EXPECT_TRUE(write_file_atomically("/dev/null", "gone"));
    EXPECT_FALSE(write_file_atomically("/dev/full", "no room"));
}

}  // namespace
}  // namespace opaline::formats
