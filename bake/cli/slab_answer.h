#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/opal/result.h"

namespace opaline::cli {

enum class SlabMethod { adding, monte_carlo, model, table };

/// What `opaline slab` is asked, checked.
struct SlabQuestion {
    double optical_depth = 0, albedo = 1, g = 0, cosine = 1, eta = 1;
    std::string phase;  ///< a file instead of g; empty: none
    SlabMethod method = SlabMethod::adding;
    unsigned orders = 8, streams = 48, threads = 0, views = 0;
    std::uint64_t photons = 1000000, seed = 0;
};

/// Shares of the light, all together and in by_order; `views` (slab_views.h) if asked for. Errors:
/// what reading the phase function finds, too many threads, `interrupted`.
nlohmann::ordered_json answer_slab(const SlabQuestion& question);

}  // namespace opaline::cli
