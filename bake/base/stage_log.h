#pragma once

#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace opaline::bake {

/// One stage of a bake as it ran.
struct StageReport {
    std::string name;
    std::string group;  ///< what it was for: stages of one group add up in comparisons
    double seconds = 0;
    double cpu_seconds = 0;  ///< of all threads of the process meanwhile
    std::uint64_t rays = 0;
    std::uint64_t peak_rss_bytes = 0;  ///< of the process so far
};
using StageLog = std::vector<StageReport>;

/// Group of stages that belong to no effect.
inline constexpr const char* kPreparationGroup = "preparation";

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the process took so far.
inline rusage process_usage() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage;
}

/// Of all its threads [s].
inline double cpu_seconds(const rusage& usage = process_usage()) {
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Times one stage, `stage(rays)` with a count of rays that it may raise, and notes it in the log
/// when it ends.
template <class Stage>
auto run_stage(StageLog& log, std::string name, std::string group, Stage&& stage) {
    const Clock::time_point start = Clock::now();
    const double cpu_before = cpu_seconds();
    std::uint64_t rays = 0;
    auto value = stage(rays);
    const rusage usage = process_usage();
    log.push_back({std::move(name), std::move(group), seconds_since(start),
                   cpu_seconds(usage) - cpu_before, rays,
                   static_cast<std::uint64_t>(usage.ru_maxrss) * 1024});
    return value;
}
template <class Stage>
auto run_stage(StageLog& log, std::string name, Stage&& stage) {
    return run_stage(log, std::move(name), kPreparationGroup, std::forward<Stage>(stage));
}

}  // namespace opaline::bake
