#include "tests/cli/run_program.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "bake/cli/program.h"
#include "formats/vdb/answer_vdb_request.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

Arguments join(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

namespace {

std::vector<char*> pointers(const Arguments& command) {
    std::vector<char*> argv;
    for (const std::string& argument : command) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    return argv;
}

// Sends one of this process's streams into a file, until the end of its scope.
class Redirection {
  public:
    Redirection(std::FILE* stream, const std::string& path)
        : stream_(stream), kept_(::dup(::fileno(stream))) {
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        std::fflush(stream_);
        ::dup2(file, ::fileno(stream_));
        ::close(file);
    }
    Redirection(const Redirection&) = delete;
    Redirection& operator=(const Redirection&) = delete;
    ~Redirection() {
        std::fflush(stream_);
        ::dup2(kept_, ::fileno(stream_));
        ::close(kept_);
    }

  private:
    std::FILE* stream_;
    int kept_;
};

}  // namespace

Outcome run_any(const Arguments& command, const std::function<void(int)>& when_started) {
    const TemporaryFolder folder;
    const std::string out = folder / "out", err = folder / "err";
    std::vector<char*> argv = pointers(command);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
    ::posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    // Signals act as on a terminal, also where the tests run in the background.
    posix_spawnattr_t attributes;
    sigset_t defaults;
    ::sigemptyset(&defaults);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        ::sigaddset(&defaults, number);
    }
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setsigdefault(&attributes, &defaults);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t process = 0;
    const int fault =
        ::posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (fault != 0) {
        throw std::runtime_error("cannot run " + command[0]);
    }
    if (when_started) {
        when_started(process);
    }
    int status = 0;
    ::waitpid(process, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, read_text(out), read_text(err)};
}

Outcome start_opaline(Arguments arguments, const std::function<void(int)>& when_started) {
    arguments.insert(arguments.begin(), OPALINE_PROGRAM);
    return run_any(arguments, when_started);
}

Outcome run_opaline(Arguments arguments) {
    arguments.insert(arguments.begin(), "opaline");
    const TemporaryFolder folder;
    const std::string out = folder / "out", err = folder / "err";
    const std::vector<char*> argv = pointers(arguments);
    int code = 0;
    {
        const Redirection to_out(stdout, out), to_err(stderr, err);
        code = cli::run_program(static_cast<int>(arguments.size()), argv.data());
    }
    return {code, read_text(out), read_text(err)};
}

Outcome run_with_cache(const std::filesystem::path& cache, const Arguments& arguments) {
    ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    Outcome outcome = run_opaline(arguments);
    ::setenv("XDG_CACHE_HOME", OPALINE_TEST_CACHE, 1);
    return outcome;
}

Outcome run_well(Arguments arguments) {
    const std::string line = ::testing::PrintToString(arguments);
    Outcome outcome = run_opaline(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, 0) << line << outcome.err;
    return outcome;
}

void expect_refused(const Arguments& arguments, int exit_code, const std::string& part) {
    const Outcome outcome = run_opaline(arguments);
    const std::string line = ::testing::PrintToString(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << line << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::StartsWith("opaline: error: ")) << line;
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(part)) << line;
    EXPECT_EQ(outcome.out, "") << line;
}

std::vector<std::string> list_folder(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t count_lines(const std::filesystem::path& path) {
    const std::string text = read_text(path);
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace opaline::tests

// As main of the program does: the process that reads OpenVDB files is this one, started again.
int main(int argc, char** argv) {
    if (opaline::formats::is_vdb_request(argc, argv)) {
        opaline::formats::answer_vdb_request(argc, argv);
    }
    // What bakes teach and their test lights are not put into the user's cache.
    ::setenv("XDG_CACHE_HOME", OPALINE_TEST_CACHE, 1);
    ::testing::InitGoogleMock(&argc, argv);
    return RUN_ALL_TESTS();
}
