#include "bake/physics/phase_maps.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "bake/physics/phase.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {

namespace {

// A phase function of the cosine alone is unchanged when a mirror of the cube moves both
// directions. The planes x = 0, y = 0 and z = 0 map texels to texels, none to itself. In a basis of
// vectors that are even or odd in x, y and z, the matrix has eight diagonal blocks of one eighth
// the size, with 64 times less work in total. The plane x = y splits the two blocks in which the
// cube leaves pairs of equal eigenvalues. After that no two eigenvalues of a block are equal by
// symmetry, and the eigenvectors are unique up to sign.

constexpr unsigned kMirrors = 8;  ///< bits: x, y, z

struct Octant {
    std::vector<std::array<std::uint32_t, kMirrors>> texel;  ///< [orbit][mirror]
    std::vector<std::array<double, 3>> direction;            ///< [orbit]; unit; x, y, z > 0
    std::vector<double> solid_angle;                         ///< [orbit]
    std::vector<std::size_t> swapped;  ///< [orbit]: the orbit mirrored at the plane x = y
};

formats::Vec3 mirrored(formats::Vec3 w, unsigned mirror) {
    return {(mirror & 1u) != 0 ? -w.x : w.x, (mirror & 2u) != 0 ? -w.y : w.y,
            (mirror & 4u) != 0 ? -w.z : w.z};
}

/// The cosine between propagation directions for light from a that leaves toward the mirror image
/// of b.
double cosine(const std::array<double, 3>& a, const std::array<double, 3>& b, unsigned mirror) {
    double dot = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        dot += (mirror >> axis & 1u) != 0 ? -a[axis] * b[axis] : a[axis] * b[axis];
    }
    return std::clamp(-dot, -1.0, 1.0);
}

Octant make_octant(std::uint32_t size) {
    Octant octant;
    const std::vector<double> solid_angle = formats::texel_solid_angles(size);
    std::vector<formats::Vec3> position;
    std::vector<std::size_t> orbit_of(formats::cubemap_texels(size));
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t i = 0; i < size * size; ++i) {
            // Exact in single precision where the size is a power of two.
            const auto centre = [&](std::uint32_t at) {
                return static_cast<float>(2 * at + 1) / static_cast<float>(size) - 1;
            };
            const formats::Vec3 w =
                formats::cube_position({face, centre(i % size), centre(i / size)});
            if (w.x > 0 && w.y > 0 && w.z > 0) {
                auto& texel = octant.texel.emplace_back();
                for (unsigned mirror = 0; mirror < kMirrors; ++mirror) {
                    texel[mirror] = formats::texel_index(size, mirrored(w, mirror));
                }
                orbit_of[texel[0]] = octant.direction.size();
                const auto x = static_cast<double>(w.x), y = static_cast<double>(w.y),
                           z = static_cast<double>(w.z);
                const double length = std::sqrt(x * x + y * y + z * z);
                octant.direction.push_back({x / length, y / length, z / length});
                position.push_back(w);
                octant.solid_angle.push_back(solid_angle[i]);
            }
        }
    }
    for (const formats::Vec3 w : position) {
        octant.swapped.push_back(orbit_of[formats::texel_index(size, {w.y, w.x, w.z})]);
    }
    return octant;
}

/// [orbit][orbit][mirror]: sqrt(dW_a) p(w_a, mirrored w_b) sqrt(dW_b).
std::vector<Eigen::MatrixXd> make_mirrored_matrices(const std::function<double(double)>& p,
                                                    const Octant& octant) {
    const auto n = static_cast<Eigen::Index>(octant.direction.size());
    std::vector<Eigen::MatrixXd> matrices(kMirrors, Eigen::MatrixXd(n, n));
    for (unsigned mirror = 0; mirror < kMirrors; ++mirror) {
        for (std::size_t a = 0; a < octant.direction.size(); ++a) {
            for (std::size_t b = a; b < octant.direction.size(); ++b) {
                const double value = p(cosine(octant.direction[a], octant.direction[b], mirror));
                const double entry =
                    value * std::sqrt(octant.solid_angle[a] * octant.solid_angle[b]);
                const auto row = static_cast<Eigen::Index>(a),
                           column = static_cast<Eigen::Index>(b);
                matrices[mirror](row, column) = entry;
                matrices[mirror](column, row) = entry;
            }
        }
    }
    return matrices;
}

double largest_row_error(const std::vector<Eigen::MatrixXd>& mirrored, const Octant& octant) {
    Eigen::VectorXd root(static_cast<Eigen::Index>(octant.solid_angle.size()));
    for (std::size_t i = 0; i < octant.solid_angle.size(); ++i) {
        root[static_cast<Eigen::Index>(i)] = std::sqrt(octant.solid_angle[i]);
    }
    Eigen::VectorXd integral = Eigen::VectorXd::Zero(root.size());
    for (const Eigen::MatrixXd& matrix : mirrored) {
        integral += matrix * root;
    }
    return (integral.cwiseQuotient(root).array() - 1).abs().maxCoeff();
}

/// Orthonormal columns that are even (sign 1) or odd (-1) under the swap of x and y.
Eigen::MatrixXd swap_basis(const Octant& octant, double sign) {
    const auto n = static_cast<Eigen::Index>(octant.swapped.size());
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(n, n);
    Eigen::Index columns = 0;
    for (std::size_t orbit = 0; orbit < octant.swapped.size(); ++orbit) {
        const std::size_t other = octant.swapped[orbit];
        const auto i = static_cast<Eigen::Index>(orbit), j = static_cast<Eigen::Index>(other);
        if (other == orbit && sign > 0) {
            basis(i, columns++) = 1;
        } else if (orbit < other) {
            basis(i, columns) = std::sqrt(0.5);
            basis(j, columns++) = sign * std::sqrt(0.5);
        }
    }
    return basis.leftCols(columns);
}

struct Eigenpair {
    double value = 0;
    unsigned odd = 0;         ///< bits: odd in x, y, z
    Eigen::VectorXd orbital;  ///< by orbit; the texels' entries are it / sqrt(8), up to signs
};

double parity_sign(unsigned odd, unsigned mirror) {
    const unsigned both = odd & mirror;
    return ((both ^ both >> 1 ^ both >> 2) & 1u) != 0 ? -1.0 : 1.0;
}

void add_eigenpairs(const Eigen::MatrixXd& block, unsigned odd, const Eigen::MatrixXd& basis,
                    std::vector<Eigenpair>& pairs) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(basis.transpose() * block * basis);
    assert(solver.info() == Eigen::Success);
    for (Eigen::Index i = 0; i < solver.eigenvalues().size(); ++i) {
        pairs.push_back({solver.eigenvalues()[i], odd, basis * solver.eigenvectors().col(i)});
    }
}

std::vector<Eigenpair> find_eigenpairs(const std::vector<Eigen::MatrixXd>& matrices,
                                       const Octant& octant) {
    std::vector<Eigenpair> pairs;
    const auto n = static_cast<Eigen::Index>(octant.direction.size());
    for (unsigned odd = 0; odd < kMirrors; ++odd) {
        Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n, n);
        for (unsigned mirror = 0; mirror < kMirrors; ++mirror) {
            block += parity_sign(odd, mirror) * matrices[mirror];
        }
        if (odd == 0 || odd == kMirrors - 1) {
            add_eigenpairs(block, odd, swap_basis(octant, 1), pairs);
            add_eigenpairs(block, odd, swap_basis(octant, -1), pairs);
        } else {
            add_eigenpairs(block, odd, Eigen::MatrixXd::Identity(n, n), pairs);
        }
    }
    return pairs;
}

/// Descending by magnitude. Values that differ by rounding alone keep the order of the blocks,
/// which rounding cannot change.
void sort_descending(std::vector<Eigenpair>& pairs) {
    const auto magnitude = [](const Eigenpair& pair) { return std::abs(pair.value); };
    std::stable_sort(pairs.begin(), pairs.end(), [&](const Eigenpair& a, const Eigenpair& b) {
        return magnitude(a) > magnitude(b);
    });
    constexpr double kRounding = 1e-10;
    const double rounding = kRounding * magnitude(pairs.front());
    for (auto first = pairs.begin(); first != pairs.end();) {
        auto last = first + 1;
        while (last != pairs.end() && magnitude(*(last - 1)) - magnitude(*last) <= rounding) {
            ++last;
        }
        std::stable_sort(first, last,
                         [](const Eigenpair& a, const Eigenpair& b) { return a.odd < b.odd; });
        first = last;
    }
}

void add_maps(const Eigenpair& pair, const Octant& octant, PhaseMaps& maps) {
    std::vector<double> h(formats::cubemap_texels(maps.size));
    for (std::size_t orbit = 0; orbit < octant.texel.size(); ++orbit) {
        const double value = pair.orbital[static_cast<Eigen::Index>(orbit)] /
                             std::sqrt(kMirrors * octant.solid_angle[orbit]);
        for (unsigned mirror = 0; mirror < kMirrors; ++mirror) {
            h[octant.texel[orbit][mirror]] = parity_sign(pair.odd, mirror) * value;
        }
    }
    double largest = 0;
    for (const double value : h) {
        largest = std::max(largest, std::abs(value));
    }
    // Mirror symmetry repeats the largest magnitude, so rounding must not choose among the
    // repetitions.
    const auto first = std::find_if(
        h.begin(), h.end(), [&](double value) { return std::abs(value) >= (1 - 1e-6) * largest; });
    const double sign = *first < 0 ? -1 : 1;
    std::vector<double> g(h.size());
    for (std::size_t i = 0; i < h.size(); ++i) {
        h[i] *= sign;
        g[i] = pair.value * h[i];
    }
    maps.g.push_back(std::move(g));
    maps.h.push_back(std::move(h));
}

}  // namespace

PhaseMaps factor_phase(const formats::PhaseFunction& phase, std::uint32_t size, unsigned terms) {
    const PhaseDensity density = make_phase_density(phase);
    return factor_phase([&](double cosine) { return eval_phase(density, cosine); }, size, terms);
}

PhaseMaps factor_phase(const std::function<double(double)>& p, std::uint32_t size, unsigned terms) {
    assert(size % 2 == 0 && size > 0 && size <= 32 && terms <= formats::cubemap_texels(size));
    const Octant octant = make_octant(size);
    const auto matrices = make_mirrored_matrices(p, octant);
    std::vector<Eigenpair> pairs = find_eigenpairs(matrices, octant);
    sort_descending(pairs);
    PhaseMaps maps;
    maps.size = size;
    maps.row_error = largest_row_error(matrices, octant);
    for (const Eigenpair& pair : pairs) {
        maps.singular_value.push_back(std::abs(pair.value));
    }
    // Rounding can put equal values out of order; restore the order of the blocks.
    std::sort(maps.singular_value.begin(), maps.singular_value.end(), std::greater<>());
    for (unsigned term = 0; term < terms; ++term) {
        add_maps(pairs[term], octant, maps);
    }
    return maps;
}

double phase_rms_relative(const PhaseMaps& maps, unsigned terms) {
    assert(terms <= maps.singular_value.size());
    double kept = 0, dropped = 0;
    // Sum from the smallest, so that small values are not lost beside large ones.
    for (std::size_t k = maps.singular_value.size(); k-- > 0;) {
        const double square = maps.singular_value[k] * maps.singular_value[k];
        (k < terms ? kept : dropped) += square;
    }
    return std::sqrt(dropped / (kept + dropped));
}

}  // namespace opaline::bake
