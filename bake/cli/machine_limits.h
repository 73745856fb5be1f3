#pragma once

#include <cstdint>
#include <string>

#include "bake/pipeline/predict_memory.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// What this process may use [bytes]: the machine's memory, or what its control group allows, or
/// what `ulimit -v` leaves to a program of that many threads.
std::uint64_t available_memory(unsigned threads);

/// Refuses what is predicted to need more than `limit`. Errors: resource, naming `file`.
formats::Status check_memory(const std::string& file, const bake::MemoryPrediction& prediction,
                             std::uint64_t limit);

/// Whether that many threads (0: one per core) can be started. Asked first because TBB, which all
/// stages run on, waits for ever for a thread that could not be. Errors: resource.
formats::Status check_threads(unsigned threads);

}  // namespace opaline::cli
