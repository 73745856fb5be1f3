#include "formats/opal/file_bytes.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace opaline::formats {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const FileBytes& file) {
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

TEST(FileBytes, HoldsTheWholeFileAligned) {
    const tests::TemporaryFolder folder;
    const std::string text(100000, 'x');
    write(folder / "a", text);
    const auto file = FileBytes::open(folder / "a");
    ASSERT_TRUE(file);
    EXPECT_EQ(text_of(*file), text);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file->bytes().data()) % 64, 0u);
}

TEST(FileBytes, OfAPipeAreRefusedAtOnceThoughNobodyWritesToIt) {
    const tests::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const std::filesystem::path& path :
         {folder / "pipe", std::filesystem::path("/dev/zero")}) {
        const auto file = FileBytes::open(path);
        ASSERT_FALSE(file);
        EXPECT_EQ(file.error().diagnostics.front().fault, "is not a regular file");
    }
}

// A mapped file would end the program here.
TEST(FileBytes, StaysWholeWhenTheFileIsShortened) {
    const tests::TemporaryFolder folder;
    const std::string text(100000, 'x');
    write(folder / "a", text);
    const auto file = FileBytes::open(folder / "a");
    ASSERT_TRUE(file);
    std::filesystem::resize_file(folder / "a", 0);
    EXPECT_EQ(text_of(*file), text);
}

TEST(FileBytes, EmptyFilesAreEmptyAndFoldersRefused) {
    const tests::TemporaryFolder folder;
    write(folder / "a", "");
    const auto file = FileBytes::open(folder / "a");
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->bytes().empty());
    for (const char* name : {"", "missing"}) {
        const auto refused = FileBytes::open(folder / name);
        ASSERT_FALSE(refused) << name;
        EXPECT_EQ(refused.error().kind, ErrorKind::bad_input);
    }
}

}  // namespace
}  // namespace opaline::formats
