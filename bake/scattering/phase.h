#pragma once

namespace opaline::bake {

/// Henyey-Greenstein phase function [1/sr], translucency.md 3.8. `cosine` between propagation
/// directions, in [-1, 1]; |g| < 1.
double henyey_greenstein(double cosine, double g);

/// Relative RMS error, over all pairs of directions, of keeping the `terms` largest singular values
/// of a Henyey-Greenstein function: they are |g|^l with multiplicity 2 l + 1 (Funk-Hecke).
double henyey_greenstein_rms(double g, unsigned terms);

}  // namespace opaline::bake
