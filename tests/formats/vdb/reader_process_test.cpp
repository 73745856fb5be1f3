#include "formats/vdb/reader_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using formats::VdbReadOptions;
using Clock = std::chrono::steady_clock;

std::size_t open_descriptors() {
    const std::filesystem::directory_iterator all("/proc/self/fd"), end;
    return static_cast<std::size_t>(std::distance(all, end));
}

bool has_child() {
    return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

/// A good file, and readers that are not what they should be.
class ReaderProcess : public ::testing::Test {
  protected:
    ReaderProcess() { write_file(good_, {{.voxels = box_of_voxels({0, 0, 0}, {9, 9, 9})}}); }
    ~ReaderProcess() override { EXPECT_FALSE(has_child()); }

    // Reading with a shell script for a reader.
    auto read_with(const std::string& script, VdbReadOptions options = with_program()) {
        const auto path = folder_ / ("reader" + std::to_string(++readers_));
        write_bytes(path, "#!/bin/sh\n" + script + "\n");
        ::chmod(path.c_str(), 0700);
        options.reader = path;
        return formats::read_vdb(good_, {}, options);
    }

    const TemporaryFolder folder_;
    const std::filesystem::path good_ = folder_ / "good.vdb";
    int readers_ = 0;
};

TEST_F(ReaderProcess, WhatIsNoReplyIsAnErrorOfTheFile) {
    for (const std::string script :
         {"exit 0", "exit 1", "kill -SEGV $$", "kill -KILL $$", "head -c 100000 /dev/urandom >&4",
          "cat /dev/zero >&4", "printf ODV >&4", "exec 4>&-; exec sleep 100"}) {
        const auto start = Clock::now();
        const auto result = read_with(script);
        ASSERT_FALSE(result.has_value()) << script;
        EXPECT_EQ(result.error().kind, ErrorKind::bad_input) << script;
        EXPECT_NE(message_of(result).find("damaged"), std::string::npos) << script;
        EXPECT_LT(Clock::now() - start, std::chrono::seconds(10)) << script;
        EXPECT_FALSE(has_child()) << script;
    }
}

TEST_F(ReaderProcess, BytesAfterTheReplyMakeItGarbage) {
    const std::string program = with_program().reader.string();
    EXPECT_TRUE(read_with("exec '" + program + "' \"$@\"").has_value());
    EXPECT_FALSE(read_with("'" + program + "' \"$@\"; printf x >&4").has_value());
    EXPECT_FALSE(read_with("'" + program + "' \"$@\"; exit 1").has_value());
}

TEST_F(ReaderProcess, ReaderThatDoesNotEndIsEnded) {
    VdbReadOptions options = with_program();
    options.wall_seconds = 1;
    const auto start = Clock::now();
    const auto result = read_with("exec sleep 100", options);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(5));
    EXPECT_NE(message_of(result).find("more than 1 s"), std::string::npos);
}

TEST_F(ReaderProcess, ReaderThatUsesUpItsCpuTimeIsToldSo) {
    const auto result = read_with("kill -XCPU $$");
    EXPECT_NE(message_of(result).find("60 s of computing"), std::string::npos);
}

TEST_F(ReaderProcess, InterruptStopsTheReading) {
    std::atomic<bool> interrupted = false;
    VdbReadOptions options = with_program();
    options.interrupted = &interrupted;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        interrupted = true;
    });
    const auto start = Clock::now();
    const auto result = read_with("exec sleep 100", options);
    user.join();
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::interrupted);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(5));
}

TEST_F(ReaderProcess, MissingReaderIsAnErrorOfTheMachine) {
    VdbReadOptions options = with_program();
    options.reader = folder_ / "none";
    const auto result = formats::read_vdb(good_, {}, options);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::resource);
}

TEST_F(ReaderProcess, NoDescriptorStaysOpen) {
    const std::size_t before = open_descriptors();
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(read(good_).has_value());
        EXPECT_FALSE(read_with("exit 1").has_value());
    }
    EXPECT_EQ(open_descriptors(), before);
}

TEST_F(ReaderProcess, ReaderHasNothingButTheFileAndThePipe) {
    // Without O_CLOEXEC: a program started carelessly would have it.
    const int other = ::open((folder_ / "secret").c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_GE(other, 0);
    const auto list = folder_ / "list";
    (void)read_with("ls -l /proc/$$/fd > '" + list.string() + "'; env >> '" + list.string() + "'");
    ::close(other);
    const std::string text = read_bytes(list);
    EXPECT_EQ(text.find("secret"), std::string::npos) << text;
    EXPECT_NE(text.find("good.vdb"), std::string::npos);
    EXPECT_NE(text.find("OPALINE_READS_VDB=1"), std::string::npos);
}

TEST_F(ReaderProcess, NothingIsPrinted) {
    std::string bytes = read_bytes(good_);
    bytes.resize(bytes.size() / 2);
    write_bytes(folder_ / "bad.vdb", bytes);
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    (void)read(good_);
    (void)read(folder_ / "bad.vdb");
    (void)read_with("echo noise; echo noise >&2; exit 1");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(ReaderProcess, ProgramThatDoesNotAnswerRequestsIsNotStartedOverAndOver) {
    ASSERT_EQ(::setenv(formats::vdb::kRequestVariable, "1", 1), 0);
    const auto result = read(good_);
    ASSERT_EQ(::unsetenv(formats::vdb::kRequestVariable), 0);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::resource);
}

TEST_F(ReaderProcess, UnusualSignalSettingsDoNotMatter) {
    // Children are not waited for where SIGCHLD is ignored, and what is blocked is inherited.
    std::signal(SIGCHLD, SIG_IGN);
    sigset_t all, before;
    sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before);
    EXPECT_TRUE(read(good_).has_value());
    EXPECT_FALSE(read_with("head -c 1000 /dev/urandom >&4").has_value());
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    std::signal(SIGCHLD, SIG_DFL);
}

TEST_F(ReaderProcess, SignalsDuringTheReadingDoNotStopIt) {
    struct sigaction action {};
    action.sa_handler = [](int) {};  // without SA_RESTART
    ::sigaction(SIGUSR1, &action, nullptr);
    std::atomic<bool> done = false;
    const pthread_t reading = ::pthread_self();
    std::thread user([&] {
        while (!done) {
            ::pthread_kill(reading, SIGUSR1);
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
    });
    for (int i = 0; i < 5; ++i) {
        const auto result = read(good_);
        EXPECT_TRUE(result.has_value()) << message_of(result);
    }
    done = true;
    user.join();
}

TEST_F(ReaderProcess, RequestTypedByAUserDoesNothing) {
    const std::string program = with_program().reader.string();
    const std::string command = "'" + program + "' --opaline-read-vdb 1 1 3>&- 4>&-";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
    EXPECT_EQ(WEXITSTATUS(std::system(("'" + program + "' --opaline-read-vdb").c_str())), 2);
}

}  // namespace
}  // namespace opaline::tests
