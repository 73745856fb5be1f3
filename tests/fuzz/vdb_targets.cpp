#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "formats/vdb/decode_vdb.h"
#include "formats/vdb/limits.h"
#include "formats/vdb/reply.h"
#include "tests/formats/vdb/vdb_files.h"
#include "tests/fuzz/targets.h"

// Of a program that libFuzzer runs: how often each edge was passed.
extern "C" {
extern std::uint8_t __start___sancov_cntrs __attribute__((weak));
extern std::uint8_t __stop___sancov_cntrs __attribute__((weak));
// What a sanitizer calls before it ends a process: libFuzzer's writes the input down as a finding.
void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));
}

namespace opaline::fuzz {
namespace {

namespace vdb = formats::vdb;

constexpr int kMilliseconds = 4000;

void expect_sound_reply(const std::optional<vdb::Reply>& reply) {
    if (!reply) return;
    hold(reply->unread.size() <= vdb::kMaxGrids, "names of grids that were not read are few");
    hold(!reply->fault || reply->grids.empty(), "there are grids or a fault");
    for (const formats::VdbGrid& grid : reply->grids) {
        hold(tests::is_sound(grid), "a grid is all that VdbGrid promises");
    }
}

std::optional<vdb::Reply> parse_whole(std::span<const std::byte> bytes) {
    return vdb::parse_reply([&bytes](std::span<std::byte> out) {
        if (out.size() > bytes.size()) return false;
        std::copy_n(bytes.begin(), out.size(), out.begin());
        bytes = bytes.subspan(out.size());
        return true;
    });
}

// Lets a child process count edges for this one.
void share_counters() {
    std::uint8_t* const begin = &__start___sancov_cntrs;
    std::uint8_t* const end = &__stop___sancov_cntrs;
    if (begin == nullptr) return;
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
    const auto last = reinterpret_cast<std::uintptr_t>(end) / page * page;
    if (first >= last) return;
    auto* const at = reinterpret_cast<std::uint8_t*>(first);
    const std::vector<std::uint8_t> counts(at, at + (last - first));
    if (::mmap(at, counts.size(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED,
               -1, 0) == MAP_FAILED) {
        hold(false, "counters can be shared");
    }
    std::memcpy(at, counts.data(), counts.size());
}

// As answer_vdb_request does, but for the limit of address space, which a sanitizer exceeds.
[[noreturn]] void answer(const std::string& path, int reply_pipe) {
    const rlimit processor{1, 2}, core{0, 0};
    ::setrlimit(RLIMIT_CPU, &processor);
    ::setrlimit(RLIMIT_CORE, &core);
    // A crash here is what the process is for.
    ::close(STDERR_FILENO);
    for (const int signal : {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXCPU}) {
        std::signal(signal, SIG_DFL);
    }
    if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(nullptr);
    try {
        vdb::ReplyWriter reply(reply_pipe);
        const std::optional<vdb::Fault> fault = vdb::decode_vdb(path, {}, reply);
        if (fault) reply.write_fault(*fault);
    } catch (const std::bad_alloc&) {
        ::_exit(1);
    }
    ::_exit(0);
}

// All that a child writes until it ends, or until its time is over.
std::vector<std::byte> collect(int pipe) {
    std::vector<std::byte> bytes, piece(std::size_t{1} << 16);
    pollfd waiting{pipe, POLLIN, 0};
    while (::poll(&waiting, 1, kMilliseconds) > 0 && bytes.size() < std::size_t{64} << 20) {
        const ssize_t count = ::read(pipe, piece.data(), piece.size());
        if (count <= 0) break;
        bytes.insert(bytes.end(), piece.begin(), piece.begin() + count);
    }
    return bytes;
}

}  // namespace

void run_vdb_reply(std::span<const std::byte> bytes) {
    expect_sound_reply(parse_whole(bytes));
}

void run_vdb(std::span<const std::byte> bytes) {
    static const bool are_shared = (share_counters(), true);
    static const int file = ::memfd_create("input.vdb", MFD_CLOEXEC);
    int ends[2];
    hold(are_shared && file >= 0 && ::ftruncate(file, 0) == 0 &&
             ::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()) &&
             ::pipe(ends) == 0,
         "the input can be written");
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        answer("/proc/self/fd/" + std::to_string(file), ends[1]);
    }
    ::close(ends[1]);
    const std::vector<std::byte> reply = collect(ends[0]);
    ::close(ends[0]);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    expect_sound_reply(parse_whole(reply));
}

}  // namespace opaline::fuzz
