#pragma once

#include <cstdint>
#include <vector>

namespace opaline::formats {

/// Noise and domes on lattices of unit squares that repeat: what height fields are summed of.

struct LatticePoint {
    double x = 0, y = 0;
};

/// A lattice that is repeated, `x` and `y` squares wide, at one time of an evolution.
struct Lattice {
    int x = 1, y = 1;
    int finest = 1;  ///< with more squares than this on a side it is finer than texels can show
    bool evolves = false;
    double turn = 0;  ///< of the evolution so far, [0, 2 pi); 0 where nothing evolves

    bool is_too_fine() const { return x > finest || y > finest; }
};

/// `factor` times as many squares along both sides.
Lattice finer(Lattice lattice, int factor);

/// Gradient noise [Perlin1985]. Where it evolves, its gradients turn [Perlin2001], half of them to
/// the left.
struct Noise {
    Lattice lattice;
    std::vector<LatticePoint> slope;  ///< at the corners of squares, x fastest; none: too fine
};
Noise make_noise(const Lattice& lattice, std::uint32_t seed);
/// About -1 to 1 and 0 on average; features are one square wide. 0 where the lattice is too fine.
double eval_noise(const Noise& noise, LatticePoint p);

/// Octaves of it from squares as large as the lattice's, each half as large as the one before.
std::vector<Noise> make_octaves(const Lattice& lattice, int octaves, std::uint32_t seed);
/// Their sum, each `gain` times as strong as the one before. `p` on the first one's lattice.
double eval_octaves(const std::vector<Noise>& octaves, double gain, LatticePoint p);

/// Domes around one random point of each square, after [Worley1996]. Where they evolve, points go
/// round on circles, within the places that points have anyway, and domes breathe; each one in a
/// phase of its own.
struct Domes {
    struct Dome {
        double x = 0, y = 0;  ///< place in its square, from its centre
        double height = 1;
    };
    Lattice lattice;
    std::vector<Dome> dome;  ///< of each square, x fastest; none: too fine
};
Domes make_domes(const Lattice& lattice, std::uint32_t seed);
/// 1 - (d/r)^2 of the nearest one, with a soft maximum (the norm of order 8), so that the valleys
/// between domes are round. In [0, 1.3], a quarter more where domes breathe; 0 where the lattice is
/// too fine.
double eval_domes(const Domes& domes, LatticePoint p);

}  // namespace opaline::formats
