#pragma once

#include <cstddef>
#include <vector>

namespace opaline::bake {

/// Power that particles brought to a flat patch, on a hierarchy of elements: level l halves the
/// patch l times along both of its coordinates.
struct PatchElements {
    double area = 1;  ///< of the patch [m^2]
    /// [W] by level, 4^l elements each, row by row along the first coordinate.
    std::vector<std::vector<double>> power;

    int finest() const { return static_cast<int>(power.size()) - 1; }
};

/// levels in [1, 14], the finest one included.
PatchElements make_patch_elements(double area, int levels);

/// The level of the largest element that is not larger than the footprint [m^2], or the finest one.
int element_level(const PatchElements& patch, double footprint);

/// Adds a particle's power [W] to the element of the level that (s, t) in [0, 1]^2 lies in. One
/// element takes all of it, so the sum over elements is what was received, whatever the levels.
void deposit(PatchElements& patch, int level, double s, double t, double power);

/// Irradiance [W m^-2] of the finest elements: the sum over each and its ancestors of power over
/// area.
std::vector<double> push_down(const PatchElements& patch);

}  // namespace opaline::bake
