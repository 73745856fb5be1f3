#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/dot.h"
#include "runtime/emitter_light.h"
#include "runtime/light_vector.h"
#include "runtime/volumes/sun_phase.h"

namespace opaline::runtime {

/// What volumes scatter under one light, toward any eye: source radiance
///
///     J(w_o) = sum_{k < terms} c_k Y_k(w_o) +
///              sum_{j < sun_terms} T^(power_j albedo) sum_{s < suns} e_js q_j(-l_s . w_o),
///
/// before max(0, .), T what of it reaches the eye, q_j the tables of the volume's SunPhase
/// (sun_phase.h). Node i of volume v has coefficients(v, i) = c_0 ..., with k = l (l + 1) + m
///
///     c_k = (-1)^l m_l <V, Y_k L'> [k < K_s] + <T_k, L> [k < K_m] + g E_k [k < K_e],
///
/// m_l the moments of the phase function p', V row 0 of the node and T_k row 1 + k. The light L is
/// split into suns in the directions l_s, which meet the phase function as it is, and the rest L'
/// (suns.h); where the moments say the same there are no suns, and L' = L. Where K_m = 1 its h_0 =
/// 1 is taken as Y_0 / Y_0, so that all of J but suns is in harmonics. E_k is what the node
/// scatters of the light that a volume sends out by itself, g the colour of that emitter.
///
/// Light of suns stands on a finer lattice: point p of brick b has sun_coefficients(v, b, p) =
/// e_00 ..., e_10 ..., with E_s what the sun sends and V_s how much of it is left there
/// (sun_light.h)
///
///     e_js = E_s V_s^(1 + power_j albedo),
///
/// a little less where V falls within the distance of points (sun_light.h).
struct VolumeLight {
    struct Part {
        std::uint32_t terms =
            0;  ///< K = max(K_s, K_m, K_e) of what is shown; 0: the volume scatters nothing
        std::uint32_t suns = 0;  ///< 0, or all of VolumeLight::sun
        /// Of the coefficients of the volume's nodes. Before them stand its suns' irradiance E_s,
        /// and before these the coefficients of suns of each brick: of brick 0 last, of its
        /// successor before them, and so on.
        std::size_t first = 0;
        std::uint32_t sun_terms = 1;                  ///< coefficients of each sun
        std::array<float, kMaxSunTerms> sun_power{};  ///< SunPhase::power
        std::uint32_t sun_boxes = 1;  ///< sun_boxes(record), boxes between points of its lattice

        /// Coefficients of suns of a brick.
        std::size_t sun_stride() const { return std::size_t{sun_terms} * suns; }
        std::size_t brick_stride() const {
            const std::size_t side = sun_boxes + 1;
            return side * side * side * sun_stride();
        }
        std::size_t first_of_brick(std::size_t brick) const {
            return first - suns - (brick + 1) * brick_stride();
        }
    };
    std::vector<Part> part;  ///< one for each volume
    /// One for each volume: the colour times which it shows its own light; 0: it does not.
    std::vector<formats::Rgb> glow;
    std::vector<SunPhase> sun_phase;        ///< one for each volume; without a table where suns = 0
    std::vector<formats::Vec3> sun;         ///< l_s, unit, toward the suns, world; kMaxSuns at most
    std::vector<formats::Rgb> coefficient;  ///< [W m^-2 sr^-1], finite; node after node

    /// E_s [W m^-2] of a sun that a volume meets, before it comes into any.
    formats::Rgb sun_light(std::size_t volume, std::size_t number) const {
        return coefficient[part[volume].first - part[volume].suns + number];
    }
    /// Of a node; `node` counts from the volume's first one.
    std::span<const formats::Rgb> coefficients(std::size_t volume, std::uint32_t node) const {
        const Part& p = part[volume];
        return std::span(coefficient).subspan(p.first + std::size_t{node} * p.terms, p.terms);
    }
    /// [W m^-2] Of a point of a brick, which counts from the volume's first one; `point`: of
    /// (sun_boxes + 1)^3, x fastest.
    std::span<const formats::Rgb> sun_coefficients(std::size_t volume, std::uint32_t brick,
                                                   std::size_t point) const {
        const Part& p = part[volume];
        return std::span(coefficient)
            .subspan(p.first_of_brick(brick) + point * p.sun_stride(), p.sun_stride());
    }
};

struct RelightVolumesOptions {
    /// Components to add up; only volume_single and volume_multiple matter. Every file can show
    /// them apart.
    formats::TermSet terms = formats::TermSet::all;
    /// Of the asset, or none: 1 each. Light of volumes is scattered in all of them whatever `terms`
    /// are; seen directly it is with `shows_own`.
    EmitterLight emitters = {};
    unsigned threads = 0;  ///< 0: all cores; the result has the same bits for any number
    DotPath path = best_dot_path();
};

/// Preconditions: light.n == volumes.rows.cubemap_size where there are volumes; the asset passed
/// read_opal's checks.
VolumeLight relight_volumes(const formats::VolumesView& volumes, const LightVector& light,
                            const RelightVolumesOptions& options = {});

}  // namespace opaline::runtime
