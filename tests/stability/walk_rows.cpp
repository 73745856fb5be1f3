#include <cmath>

#include "bake/effects/multiple/walks/band_weights.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/trace/cross_bodies.h"
#include "tests/stability/stability_row.h"

// Random walks. Most of their hard cases are means over walks, and tests of their own.

namespace opaline::tests {
namespace {

// What a walk that flies as the first band weighs in the last one, after a flight of 1 m that does
// not collide; or collides.
double shared_weight(float first, float last, bool collides) {
    bake::WalkSpace space;
    space.media = {{}};
    for (const std::size_t b : {0u, 1u}) {
        bake::WalkBands bands{b == 0 ? first : last, {1, 1, 1}, {}};
        bands.member[b] = true;
        space.bands.push_back(bands);
        space.media[0].sigma_t[b] = bands.sigma_t;
    }
    space.bands[1].member[2] = true;
    space.media[0].albedo = {1, 1, 1};
    bake::BandWeights weights(space, {0, {1, 1, 1}});
    weights.fly(1, collides);
    return weights.left(2);
}

float textbook_weight(float first, float last) {
    return std::exp(-last) / std::exp(-first);
}

float textbook_pass(float cosine, float ratio) {
    const float inside = std::sqrt(1 - (1 - cosine * cosine) / (ratio * ratio));
    const float s = (cosine - ratio * inside) / (cosine + ratio * inside);
    const float p = (ratio * cosine - inside) / (ratio * cosine + inside);
    return 1 - (s * s + p * p) / 2;
}

}  // namespace

StabilityField walk_rows() {
    return {
        "Random walks",
        {
            {"bands of extinctions far apart", "weight after 1 m; flown at 1000 1/m, band of .001",
             "e^−σ_b / e^−σ", static_cast<double>(textbook_weight(1000, 1e-3f)),
             shared_weight(1000, 1e-3f, false), "2", 1e-6, 1},
            {"η = 1/3, 3", "share that passes from inside; cos .3, η 3, floats", "√(1 − η² sin²)",
             static_cast<double>(textbook_pass(0.3f, 1.0f / 3)),
             static_cast<double>(bake::boundary_transmittance(0.3f, 1.0f / 3)), "0", 0, 1},
        }};
}

}  // namespace opaline::tests
