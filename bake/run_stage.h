#pragma once

#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "bake/pipeline.h"

namespace opaline::bake {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Times one stage, `stage(rays)` with a count of rays that it may raise, and notes it in the
/// report when it ends.
template <class Stage>
auto run_stage(BakeResult& result, std::string name, Stage&& stage) {
    const Clock::time_point start = Clock::now();
    std::uint64_t rays = 0;
    auto value = stage(rays);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    result.stages.push_back({std::move(name), seconds_since(start), rays,
                             static_cast<std::uint64_t>(usage.ru_maxrss) * 1024});
    return value;
}

}  // namespace opaline::bake
