#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "bake/base/context.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A phase function, ready to be sampled.
struct PhaseTable {
    formats::PhaseFunction::Type type = formats::PhaseFunction::Type::isotropic;
    double g = 0;  ///< of Henyey-Greenstein
    /// Others: cosines at equal steps of the cumulative distribution, from 1 to -1.
    std::vector<float> cosine;
};

/// Precondition: the phase function is within the bounds of formats/scene.h.
PhaseTable make_phase_table(const formats::PhaseFunction& phase);

double mean_cosine(const PhaseTable& table);

/// Cosine between the propagation directions before and after a scattering event, distributed as
/// 2 pi p(cosine); `u` uniform in [0, 1). Exact for isotropic and Henyey-Greenstein functions;
/// others are resolved in 4096 steps of equal probability.
float sample_cosine(const PhaseTable& table, float u);

/// The direction after a scattering event, unit; `u` and `v` uniform in [0, 1).
glm::vec3 scatter(const PhaseTable& table, glm::vec3 direction, float u, float v);

/// What became of a walk between the middle of a ball and its surface. Lengths are in mean free
/// paths.
struct BallJump {
    glm::vec3 way{0};        ///< from the middle to the exit
    glm::vec3 direction{0};  ///< unit, of the flight that goes on there
    float length = 0;        ///< of the walk inside
    float scatterings = 0;   ///< inside: whole
};

struct BallBankOptions;

/// How walks leave balls inside a medium (README.md, "Balls"): for each of several radii, records
/// of walks that start in the middle along a given direction, drawn once, event by event. A walk
/// that draws one of them jumps to the surface of its ball. Records hold no absorption, but the
/// number of scatterings and the length from which it follows.
class BallBank {
  public:
    static constexpr std::size_t kRecords = 16384;  ///< of a radius

    /// Radii [mean free paths]; infinity where there are none.
    float least() const {
        return radius_.empty() ? std::numeric_limits<float>::infinity() : radius_.front();
    }
    float largest() const {
        return radius_.empty() ? std::numeric_limits<float>::infinity() : radius_.back();
    }
    std::size_t radii() const { return radius_.size(); }
    std::size_t bytes() const { return record_.size() * sizeof(Record); }

    /// A record of the largest ball within `clearance` [mean free paths] >= least(), turned around
    /// `direction`, unit. `u` and `v` uniform in [0, 1).
    BallJump draw(float clearance, glm::vec3 direction, float u, float v) const;

  private:
    friend BallBank make_ball_bank(const PhaseTable& phase, const BallBankOptions& options,
                                   const Context& context);

    // In the frame of the first direction, z, with the exit where y = 0.
    struct Record {
        glm::vec3 direction{0};
        float along = 0;  // cosine of the exit's place to the first direction
        float length = 0, scatterings = 0;
    };

    std::vector<float> radius_;
    std::vector<Record> record_;  // kRecords of each radius
};

struct BallBankOptions {
    double largest = 0;  ///< radius [mean free paths], at most
    double events = 0;   ///< of the walks that make the records event by event, about, at most
    double jumps = 0;    ///< the same of those for larger radii, that jump through smaller ones
    std::uint64_t seed = 0;
    std::uint32_t number = 0;  ///< of the bank, below 256: its random numbers
};

/// As many radii as the options allow, from 1.5 mean free paths in steps of 2^(1/3); none: empty.
/// The same bits for any number of threads; empty if the context is cancelled.
BallBank make_ball_bank(const PhaseTable& phase, const BallBankOptions& options,
                        const Context& context);

}  // namespace opaline::bake
