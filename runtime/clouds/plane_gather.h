#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// Two parallel planes, both cut into the same cells; x fastest.
struct PlaneGrid {
    std::uint32_t columns = 1, rows = 1;  ///< > 0
    float cell_x = 1, cell_z = 1;         ///< widths of a cell [m], > 0
    float distance = 1;                   ///< between the planes [m], > 0
    bool wraps = false;                   ///< goes on beyond its edges, over and over
};

/// How to convolve with the form factor of parallel planes, K(q) = h^2 / (pi (h^2 + q^2)^2) for the
/// distance h; its integral over the plane is 1. With s = h^2 / (2 sigma^2) it is the integral of
/// exp(-s) times the Gaussian of standard deviation sigma over s, which a sum over powers of two
/// replaces. Each Gaussian is separable, and is applied on a grid as coarse as it allows.
struct GatherPlan {
    /// Weights of the cells first, first + 1, ... from a cell's own place.
    struct Taps {
        std::int32_t first = 0;
        std::vector<float> weight;
    };
    struct Gaussian {
        Taps x, z;  ///< z contains the Gaussian's share
    };
    /// One cell as a sum of cells of the next grid.
    struct Mix {
        std::int32_t first = 0;
        std::uint32_t count = 0;
        std::array<float, 6> weight{};
    };
    struct Level {
        std::uint32_t columns = 0, rows = 0;
        std::vector<Gaussian> gaussian;
        std::vector<Mix> reduce_x, reduce_z;  ///< of the level before; none at the first
        std::vector<Mix> spread_x, spread_z;  ///< to the level before; none at the first
    };
    static constexpr std::uint32_t kGhosts = 2;  ///< cells around each level, on all sides

    bool wraps = false;
    std::vector<Level> level;  ///< finest first
};

/// Precondition: a valid grid.
GatherPlan make_gather_plan(const PlaneGrid& grid);

/// Irradiance [W/m^2] at the centres of the cells of one plane from the other, whose cells are
/// Lambertian with this radiosity [W/m^2] and, without wrapping, `outside` beyond the grid. Each
/// value is a mean of the radiosities with weights >= 0: even radiosity comes back as it is to
/// 1e-6. The weights differ from K by less than 0.5 % in L1. `threads`: 0: all cores; the result
/// has the same bits for any number. Precondition: one value a cell, finite and >= 0.
std::vector<formats::Rgb> gather(const GatherPlan& plan, std::span<const formats::Rgb> radiosity,
                                 formats::Rgb outside, unsigned threads = 0);

}  // namespace opaline::runtime
