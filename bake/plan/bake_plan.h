#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Accuracy presets: each names a set of knobs.
enum class Quality { draft, preview, production, reference };

inline constexpr std::uint32_t kAllCoefficients = 0xffffffffu;

/// What the user asked for. A zero means: as the quality says.
struct BakeOptions {
    Quality quality = Quality::preview;
    std::uint32_t cubemap_size = 0;  ///< N: power of two in [8, 128]
    std::uint32_t coefficients = 0;  ///< M per receiver, the six face averages included; >= 7, or
                                     ///< kAllCoefficients
    std::uint32_t samples = 0;       ///< at most this many on the surface of each medium
    double tolerance = -1;           ///< of the hierarchical gather, >= 0; negative: as the quality
                                     ///< says
    std::vector<std::string>
        effects;             ///< the only ones to simulate; empty: what the scene calls for
    std::uint64_t seed = 0;  ///< of everything random
    unsigned threads = 0;    ///< 0: one per core; never changes the result
};

/// What is going to be done: every knob has its value.
struct Knobs {
    std::uint32_t cubemap_size = 32;
    std::uint32_t coefficients = 128;
    std::uint32_t code_bits = 8;     ///< of the stored detail coefficients
    std::uint32_t samples = 100000;  ///< at most, on the surface of each medium
    double tolerance = 1e-3;         ///< GatherOptions::tolerance
    std::vector<std::string> effects;
    std::uint64_t seed = 0;
};

/// Fills in the quality's values; refuses impossible ones (usage error).
formats::Result<Knobs> resolve_knobs(const BakeOptions& options);

std::string_view quality_name(Quality quality);

/// One decision: an effect for a subject (a material).
struct PlanEntry {
    std::string effect;   ///< design 3, "Effect names"
    std::string subject;  ///< "material 'Floor'"
    bool on = false;
    std::string reason;  ///< the rule in words
    double bound = 0;    ///< largest radiance it can contribute under `white`
    double predicted_seconds = 0;
    std::uint64_t predicted_bytes = 0;
};

/// How a plan names a material: "material 'Floor'".
std::string material_subject(const formats::Material& material);

/// Decides what to simulate, from the scene alone: traces nothing.
std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const Knobs& knobs, unsigned threads);

/// Whether an effect is on for a subject.
bool is_planned(const std::vector<PlanEntry>& plan, std::string_view effect,
                std::string_view subject);

}  // namespace opaline::bake
