#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/effect.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How much farther light spreads beneath a boundary of index `eta` in [1/3, 3] than beneath one of
/// 1.5, of which most that half_space_error has measured is: ratio of the depths 1 + 4 A / 3, A =
/// (1 + F_dr) / (1 - F_dr), of the dipole's negative source in transport mean free paths
/// [Jensen2001]; at least 1.
double boundary_reach(double eta);

/// Transport mean free path 1 / (sigma_s' + sigma_a) [m] of each band, times boundary_reach. 0: the
/// band returns less than a tenth of the light of the brightest band, so that its error is
/// invisible.
std::array<double, 3> transport_lengths(const formats::Medium& medium,
                                        const MediumProfile& profile);

/// Error of the half-space profile in a body whose mean chord is `chord` transport mean free paths:
/// relative RMS of multiple scattering against the total light, measured by random walks in scans
/// and models at albedo .99, under white, a studio and suns; interpolated, at most 2. The sign
/// varies: balls are too dark, sheets too bright. Light from behind errs by up to four times as
/// much.
double half_space_error(double chord);

/// The same of a body with the mean chord 4 V / S [m], in the worst band of `lengths`.
double closed_body_error(const std::array<double, 3>& lengths, double mean_chord);

/// The same for an open body, by the mean length of cosine-distributed rays into it, which is the
/// mean chord of a closed body. Multiplied by the share of rays that do not leave through a hole.
double open_body_error(const std::array<double, 3>& lengths, const RayScene& rays,
                       std::span<const BodyPoint> points);

/// Receivers of the material with a normal, `count` of them spread over all, or all.
std::vector<BodyPoint> draw_body_points(const EffectInputs& inputs, std::size_t count);

/// closed_body_error where the body has a volume and an area, else open_body_error.
double body_error(const EffectInputs& inputs, const MediumProfile& profile);

/// Warns of a body that light crosses, where a half space's profile errs by a tenth or more.
void warn_of_thin_parts(const EffectInputs& inputs, const MediumProfile& profile,
                        std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
