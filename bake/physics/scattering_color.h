#pragma once

namespace opaline::bake {

/// The share of even light that a half space of the medium, index 1, reflects, after the fit of
/// [Kulla2017] with the similarity relation for the mean cosine g:
///     s^2 = (1 - albedo) / (1 - g albedo),   colour = (1 - s) (1 - 0.139 s) / (1 + 1.17 s).
/// Precondition: albedo in [0, 1], |g| < 1. Result in [0, 1].
double scattering_color(double albedo, double g);

/// Its inverse: the single-scattering albedo. Constants as above, not rounded to powers of the
/// colour as glTF's drafts print them (formats/gltf/map_medium.h), which differ by some 1e-5.
/// Precondition: colour in [0, 1], |g| < 1. Result in [0, 1]; 0 for 0 and 1 for 1.
double albedo_of_color(double color, double g);

}  // namespace opaline::bake
