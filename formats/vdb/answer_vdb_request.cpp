#include "formats/vdb/answer_vdb_request.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "formats/vdb/decode_vdb.h"
#include "formats/vdb/reader_process.h"
#include "formats/vdb/reply.h"

namespace opaline::formats {
namespace {

using namespace vdb;

constexpr int kBadRequest = 2;

// Sanitizers take terabytes of address space for themselves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif
#else
constexpr bool kIsSanitized = false;
#endif

std::optional<std::uint64_t> parse_number(const char* text) {
    const char* const end = text + std::strlen(text);
    std::uint64_t number = 0;
    const auto [last, error] = std::from_chars(text, end, number);
    if (error != std::errc() || last != end) {
        return {};
    }
    return number;
}

void limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
    rlimit now{};
    if (::getrlimit(resource, &now) != 0) {
        ::_exit(kBadRequest);
    }
    // What the user allows is not exceeded.
    const rlimit wanted{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
    if (::setrlimit(resource, &wanted) != 0) {
        ::_exit(kBadRequest);
    }
}

void confine(std::uint64_t memory_bytes, std::uint64_t cpu_seconds) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    // Should the machine run out of memory all the same, this process goes first.
    const int score = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (score >= 0) {
        [[maybe_unused]] const ssize_t written = ::write(score, "1000", 4);
        ::close(score);
    }
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, 0, 0);
    limit(RLIMIT_CPU, cpu_seconds, cpu_seconds + 1);
    if (!kIsSanitized) {
        limit(RLIMIT_AS, memory_bytes, memory_bytes);
    }
}

}  // namespace

bool is_vdb_request(int argc, const char* const* argv) {
    return argc >= 2 && std::strcmp(argv[1], kRequest) == 0;
}

void answer_vdb_request(int argc, const char* const* argv) {
    const std::optional<std::uint64_t> memory = argc >= 4 ? parse_number(argv[2]) : std::nullopt;
    const std::optional<std::uint64_t> seconds = argc >= 4 ? parse_number(argv[3]) : std::nullopt;
    // A user who types the request has opened no descriptor for the reply.
    if (!memory || !seconds || ::fcntl(kReplyDescriptor, F_GETFD) < 0 ||
        ::fcntl(kFileDescriptor, F_GETFD) < 0) {
        ::_exit(kBadRequest);
    }
    confine(*memory, *seconds);
    const std::vector<std::string> names(argv + 4, argv + argc);
    ReplyWriter reply(kReplyDescriptor);
    std::optional<Fault> fault;
    try {
        fault = decode_vdb("/proc/self/fd/" + std::to_string(kFileDescriptor), names, reply);
    } catch (const std::bad_alloc&) {
        fault = Fault{"",
                      "takes more than " + std::to_string(*memory >> 20) +
                          " MiB of memory to read, or is damaged",
                      "write fewer or coarser grids"};
    }
    if (fault) {
        reply.write_fault(*fault);
    }
    // Without destructors: they would free what the kernel frees at once.
    ::_exit(0);
}

}  // namespace opaline::formats
