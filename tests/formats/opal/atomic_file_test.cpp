#include "formats/opal/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
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

TEST(AtomicFile, NamedTemporaryIsReplacedByTheFile) {
    const tests::TemporaryFolder folder;
    for (const char* text : {"first", "second"}) {
        auto file = AtomicFile::create(folder / "out", Temporary::named);
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->write(text));
        EXPECT_EQ(file->bytes_written(), std::string(text).size());
        ASSERT_TRUE(file->commit());
        EXPECT_EQ(contents(folder / "out"), text);
        EXPECT_EQ(files_in(folder.path()), 1u);
    }
}

// A process that ends without a word, as by SIGKILL.
void leave_temporary_file(const std::filesystem::path& target, Temporary temporary) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto file = AtomicFile::create(target, temporary);
        ::_exit(file ? 0 : 1);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
}

void make_old(const std::filesystem::path& folder) {
    const auto past = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::filesystem::last_write_time(entry.path(), past);
    }
}

TEST(AtomicFile, UnnamedTemporaryOfAKilledProcessIsGone) {
    if (!tests::has_unnamed_files()) GTEST_SKIP() << "the file system has no O_TMPFILE";
    const tests::TemporaryFolder folder;
    leave_temporary_file(folder / "out", Temporary::unnamed);
    EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(AtomicFile, NamedTemporaryOfAKilledProcessIsRemovedByTheNextAndOneInUseIsKept) {
    const tests::TemporaryFolder folder;
    std::ofstream(folder / ".opaline-backups") << "of somebody else";
    leave_temporary_file(folder / "out", Temporary::named);
    ASSERT_EQ(files_in(folder.path()), 2u);
    auto in_use = AtomicFile::create(folder / "other", Temporary::named);
    ASSERT_TRUE(in_use && in_use->write("kept"));
    EXPECT_EQ(files_in(folder.path()), 3u) << "too young to be taken for abandoned";
    make_old(folder.path());
    ASSERT_TRUE(AtomicFile::create(folder / "out", Temporary::named));
    EXPECT_EQ(files_in(folder.path()), 2u);
    EXPECT_TRUE(in_use->commit());
    EXPECT_EQ(contents(folder / "other"), "kept");
    EXPECT_TRUE(std::filesystem::exists(folder / ".opaline-backups"));
}

TEST(AtomicFile, FollowsLinksAndKeepsPermissions) {
    const tests::TemporaryFolder folder;
    std::filesystem::create_symlink("real", folder / "link");
    EXPECT_EQ(resolve_links(folder / "link"), resolve_links(folder / "real"));
    ASSERT_TRUE(write_file_atomically(folder / "link", "one"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(contents(folder / "real"), "one");
    std::filesystem::permissions(folder / "real", std::filesystem::perms(0640));
    ASSERT_TRUE(write_file_atomically(folder / "link", "two"));
    EXPECT_EQ(contents(folder / "real"), "two");
    EXPECT_EQ(std::filesystem::status(folder / "real").permissions(), std::filesystem::perms(0640));
}

TEST(AtomicFile, NameTooLongIsFoundOutBeforeTheWork) {
    const tests::TemporaryFolder folder;
    EXPECT_FALSE(AtomicFile::create(folder / std::string(300, 'x')));
}

}  // namespace
}  // namespace opaline::formats
