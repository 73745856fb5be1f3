#pragma once

namespace opaline::runtime {

// Light of irradiance E, on a plane facing it, that a slab scatters once toward an eye: radiance E
// p(cos) [1/sr] times these factors (bake/slab/README.md, "Once and twice"). They are divided by 1
// - exp(-depth / view), the share of the view that the slab takes, so that they are those of a
// source: bounded by 1, finite for every depth in [0, inf] and for cosines in [1e-3, 1].

/// mu_l / (mu_l + mu_v) (1 - e^-(X_l + X_v)) / (1 - e^-X_v), on the side of the light.
float reflected_source(float depth, float light, float view);

/// X_v e^-min(X_l, X_v) phi(|X_l - X_v|) / (1 - e^-X_v), phi(d) = (1 - e^-d) / d; on the other.
float transmitted_source(float depth, float light, float view);

/// 1 - e^-depth, the share that a path of that depth takes; depth in [0, inf].
float taken_share(float depth);

}  // namespace opaline::runtime
