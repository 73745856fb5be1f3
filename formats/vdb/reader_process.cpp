#include "formats/vdb/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace opaline::formats::vdb {
namespace {

// Closed with its scope. Above the numbers that the reader's descriptors get, so that giving it one
// does not overwrite the next.
class HighDescriptor {
  public:
    explicit HighDescriptor(int descriptor)
        : number_(::fcntl(descriptor, F_DUPFD_CLOEXEC, kReplyDescriptor + 1)) {}
    HighDescriptor(const HighDescriptor&) = delete;
    HighDescriptor& operator=(const HighDescriptor&) = delete;
    ~HighDescriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int number() const { return number_; }

  private:
    int number_;
};

// Descriptors, signals and process group of the reader. A group of its own keeps the terminal's
// interrupts away from it: whether to stop is decided here.
class SpawnSettings {
  public:
    SpawnSettings(int file, int reply) {
        ::posix_spawn_file_actions_init(&actions);
        for (const int standard : {0, 1, 2}) {
            ::posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
        }
        ::posix_spawn_file_actions_adddup2(&actions, file, kFileDescriptor);
        ::posix_spawn_file_actions_adddup2(&actions, reply, kReplyDescriptor);
        ::posix_spawn_file_actions_addclosefrom_np(&actions, kReplyDescriptor + 1);
        ::posix_spawnattr_init(&attributes);
        sigset_t all, none;
        sigfillset(&all);
        sigemptyset(&none);
        ::posix_spawnattr_setsigdefault(&attributes, &all);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setpgroup(&attributes, 0);
        ::posix_spawnattr_setflags(
            &attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
    ~SpawnSettings() {
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
    }

    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        result.push_back(text.data());
    }
    result.push_back(nullptr);
    return result;
}

Error start_error(const VdbReadOptions& options, const std::string& what) {
    return make_error(ErrorKind::resource, options.reader.string(), "",
                      "cannot start the process that reads OpenVDB files: " + what,
                      "free some memory, or raise the limits of processes and open files");
}

}  // namespace

ReaderProcess::ReaderProcess(const VdbReadOptions& options)
    : deadline_(std::chrono::steady_clock::now() + std::chrono::seconds(options.wall_seconds)),
      interrupted_(options.interrupted) {}

ReaderProcess::ReaderProcess(ReaderProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      deadline_(other.deadline_),
      interrupted_(other.interrupted_),
      is_late_(other.is_late_),
      is_interrupted_(other.is_interrupted_),
      buffer_(std::move(other.buffer_)),
      used_(std::exchange(other.used_, 0)) {}

ReaderProcess::~ReaderProcess() {
    finish();
}

Result<ReaderProcess> ReaderProcess::start(int file, std::span<const std::string> names,
                                           const VdbReadOptions& options) {
    if (std::getenv(kRequestVariable) != nullptr) {
        return start_error(options, "the program does not answer requests to read one");
    }
    std::vector<std::string> arguments{"opaline", kRequest, std::to_string(options.memory_bytes),
                                       std::to_string(options.cpu_seconds)};
    arguments.insert(arguments.end(), names.begin(), names.end());
    std::vector<std::string> variables{std::string(kRequestVariable) + "=1"};
    for (char** variable = environ; *variable != nullptr; ++variable) {
        variables.emplace_back(*variable);
    }
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return start_error(options, std::strerror(errno));
    ReaderProcess reader(options);
    reader.pipe_ = ends[0];
    int code = 0;
    {
        const HighDescriptor input(file), reply(ends[1]);
        ::close(ends[1]);
        if (input.number() < 0 || reply.number() < 0) {
            return start_error(options, std::strerror(EMFILE));
        }
        SpawnSettings settings(input.number(), reply.number());
        code = ::posix_spawn(&reader.process_, options.reader.c_str(), &settings.actions,
                             &settings.attributes, pointers(arguments).data(),
                             pointers(variables).data());
    }
    if (code != 0) {
        reader.process_ = -1;
        return start_error(options, std::strerror(code));
    }
    return reader;
}

// False when nothing more will be read.
bool ReaderProcess::wait_for_bytes() {
    using std::chrono::milliseconds;
    constexpr milliseconds kLookAround{100};  // whether the user has interrupted meanwhile
    while (true) {
        const auto left =
            std::chrono::duration_cast<milliseconds>(deadline_ - std::chrono::steady_clock::now());
        is_interrupted_ = interrupted_ != nullptr && interrupted_->load();
        is_late_ = left.count() <= 0;
        if (is_interrupted_ || is_late_) return false;
        pollfd wanted{pipe_, POLLIN, 0};
        const int ready =
            ::poll(&wanted, 1, static_cast<int>(std::min(left, kLookAround).count()) + 1);
        if (ready > 0) return true;
        if (ready < 0 && errno != EINTR) return false;
    }
}

// False at the end of the reply, or when nothing more will be read.
bool ReaderProcess::fill_buffer() {
    constexpr std::size_t kSize = 256u << 10;
    used_ = 0;
    buffer_.resize(kSize);
    ssize_t count = -1;
    while (count < 0 && wait_for_bytes()) {
        count = ::read(pipe_, buffer_.data(), buffer_.size());
        if (count < 0 && errno != EINTR && errno != EAGAIN) break;
    }
    buffer_.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return !buffer_.empty();
}

bool ReaderProcess::read(std::span<std::byte> out) {
    while (!out.empty()) {
        if (used_ == buffer_.size() && !fill_buffer()) return false;
        const std::size_t count = std::min(out.size(), buffer_.size() - used_);
        std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(used_), count, out.begin());
        used_ += count;
        out = out.subspan(count);
    }
    return true;
}

bool ReaderProcess::is_at_end() {
    return used_ == buffer_.size() && !fill_buffer() && !is_late_ && !is_interrupted_;
}

Ending ReaderProcess::finish() {
    if (pipe_ >= 0) {
        ::close(std::exchange(pipe_, -1));
    }
    if (process_ < 0) return Ending::failed;
    // The pipe is closed by a process that has begun to end: its exit code stays what it is.
    ::kill(process_, SIGKILL);
    int status = 0;
    pid_t waited = 0;
    do {
        waited = ::waitpid(process_, &status, 0);
    } while (waited < 0 && errno == EINTR);
    process_ = -1;
    if (is_interrupted_) return Ending::was_interrupted;
    if (is_late_) return Ending::out_of_time;
    // Where the program ignores SIGCHLD there is no status; a whole reply will do.
    if (waited < 0) return Ending::done;
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return Ending::out_of_cpu;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? Ending::done : Ending::failed;
}

}  // namespace opaline::formats::vdb
