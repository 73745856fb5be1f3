#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Cosines by which random walks turn in place of a phase function: a Gauss rule, a few cosines
/// with positive chances that have its moments of degrees 0 to 2 n - 1. Light in harmonics of these
/// degrees is scattered as by the function itself, and no walk carries a sign or a weight.
struct TurnRule {
    static constexpr std::size_t kMost = 3;

    std::size_t count = 0;              ///< n, 1 to kMost; 0: no rule
    std::array<float, kMost> cosine{};  ///< ascending, in [-1, 1]
    std::array<float, kMost> below{};   ///< chance of a cosine up to this one; the last is 1
};

/// `lambda`: moments lambda_0 = 1, ..., lambda_5 of a function of the cosine that may be negative
/// somewhere, |lambda_1| <= 1. The most cosines that positive chances allow: of a function that is
/// not one of chances the moments of high degree may be those of none.
TurnRule make_turn_rule(std::span<const double, 2 * TurnRule::kMost> lambda);

/// Densities rho' and densities times albedo rho' alpha' of each voxel.
struct ScaledGrids {
    formats::SparseGrid<float> density;
    formats::SparseGrid<glm::vec3> scattering;
};

/// A volume whose forward peak f counts as not scattered: c' = c - f b, and as much is absorbed as
/// before.
struct ScaledMedium {
    std::array<float, 3> sigma_t{};  ///< c' [1/m] where the density is 1, by band
    std::array<float, 3> albedo{};   ///< of c', by band; the largest where it varies
    /// Replaces the volume's own grids; null where these are unchanged.
    std::shared_ptr<const ScaledGrids> grids = nullptr;
};

/// Where the albedo varies, so does the extinction that the peak removes: with the mean albedo A of
/// a band and r = mean over bands of (1 - f alpha) / (1 - f A) at a voxel,
///
///     sigma_t' = sigma_t (1 - f A),   rho' = rho r,   1 - alpha' = (1 - alpha) / ((1 - f A) r)
///
/// which is exact where all bands have one albedo, or one at all voxels. Else bands scatter too
/// much or too little, by their distance from r (README.md, "Albedo that varies").
ScaledMedium scale_medium(const formats::Volume& volume, double peak);

/// A phase function as volumes are baked with: a forward peak, which counts as light that was not
/// scattered, and the rest as a polynomial of the cosine (README.md, "Phase functions").
struct ScaledPhase {
    static constexpr unsigned kHighestDegree = 4;

    double peak = 0;                                   ///< share f of the peak, in [0, 1)
    unsigned degree = 0;                               ///< N of the rest, at most kHighestDegree
    std::array<double, kHighestDegree + 1> lambda{};   ///< its moments lambda'_l, 0 beyond N
    std::array<float, kHighestDegree + 1> monomial{};  ///< p'(c) = sum_i monomial[i] c^i [1/sr];
                                                       ///< may be negative somewhere
    TurnRule rule;                  ///< where p' is negative somewhere: how walks turn
    std::vector<float> cumulative;  ///< elsewhere of p' in even steps of the cosine, up to 1

    /// lambda'_0 to lambda'_N.
    std::span<const double> moments() const { return std::span(lambda).first(degree + 1); }
    std::uint32_t harmonics() const { return (degree + 1) * (degree + 1); }
};

/// Moments above this one matter: a phase function is kept up to the last degree that exceeds it.
inline constexpr double kLeastMoment = 0.01;

/// The rest has the smallest degree N <= 4 with |lambda_l| <= kLeastMoment for all l > N; if there
/// is none, N = 4 and the peak takes lambda_5 where that is positive [Wiscombe1977].
ScaledPhase scale_phase(const formats::PhaseFunction& phase);

/// p'(cosine) [1/sr].
inline float eval_scaled(const ScaledPhase& phase, float cosine) {
    float value = 0;
    for (std::size_t i = phase.monomial.size(); i-- > 0;) {
        value = value * cosine + phase.monomial[i];
    }
    return value;
}

/// A cosine between propagation directions, drawn by p' or by its rule, and p' over its density.
struct SampledCosine {
    float cosine = 0;
    float weight = 1;  ///< 1 but for the steps of the table
};

/// `u` in [0, 1).
SampledCosine sample_scaled(const ScaledPhase& phase, float u);

}  // namespace opaline::bake
