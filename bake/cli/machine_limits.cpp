#include "bake/cli/machine_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number in a file of one number; unlimited where there is none.
std::uint64_t read_number(const char* path) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    return file >> value ? value : kUnlimited;
}

// What `ulimit -v` leaves beyond the address space already taken and what is only reserved: heaps
// of the libraries, and a stack for each thread.
std::uint64_t address_space_left(unsigned threads) {
    constexpr std::uint64_t kHeaps = 64u << 20, kStack = 16u << 20;
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    const std::uint64_t pages = read_number("/proc/self/statm");  // its first number: all of them
    const std::uint64_t used =
        (pages == kUnlimited ? 0 : pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE))) +
        kHeaps + kStack * threads;
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

}  // namespace

std::uint64_t available_memory(unsigned threads) {
    const std::uint64_t machine = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                  static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return std::min({machine, read_number("/sys/fs/cgroup/memory.max"),
                     read_number("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
                     address_space_left(threads)});
}

formats::Status check_memory(const std::string& file, const bake::MemoryPrediction& prediction,
                             std::uint64_t limit) {
    const auto most = static_cast<double>(limit);
    if (prediction.bytes() <= most) return formats::ok_status();
    const auto& largest = prediction.largest();
    return make_error(
        ErrorKind::resource, file, "",
        fmt::format("the bake needs about {}, {} of it for {}, and may take {}",
                    format_bytes(prediction.bytes()), format_bytes(largest.bytes), largest.name,
                    format_bytes(most)),
        "lower --quality or --coefficients, split the scene, or raise --memory-limit");
}

formats::Status check_threads(unsigned threads) {
    const unsigned count =
        threads != 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
    std::mutex mutex;
    std::condition_variable done;
    bool is_done = false;
    std::vector<std::thread> started;
    std::string fault;
    try {
        while (started.size() + 1 < count) {
            started.emplace_back([&] {
                std::unique_lock lock(mutex);
                done.wait(lock, [&] { return is_done; });
            });
        }
    } catch (const std::system_error& error) {
        fault = error.what();
    }
    {
        const std::lock_guard lock(mutex);
        is_done = true;
    }
    done.notify_all();
    for (std::thread& thread : started) {
        thread.join();
    }
    if (fault.empty()) {
        // TBB warns on the standard error, at every stage, of more threads than cores.
        static std::optional<tbb::global_control> allowed;
        allowed.emplace(tbb::global_control::max_allowed_parallelism,
                        std::max(count, std::thread::hardware_concurrency()));
        return formats::ok_status();
    }
    return make_error(ErrorKind::resource, "", "--threads",
                      fmt::format("{} threads cannot be started: {}", count, fault),
                      "lower --threads, or raise the limits of memory and of processes");
}

}  // namespace opaline::cli
