#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/path_images/scattered_light.h"
#include "runtime/picture/camera.h"

namespace opaline::bake {

/// Bounds of the factor.
inline constexpr double kLeastFactor = 0.5, kMostFactor = 2;

/// Factor of orders of two and more with which the ray has radiance 1 in a white furnace, where
/// nothing is absorbed: F = (1 - e^-tau - L_once) / L_often, limited to the bounds above. 1 where
/// there is nothing to scatter. `ray` holds the steps of `band` without its absorption as band
/// `number`; surfaces count as absent. `sky`: an even sky of radiance 1, with the ray's kernel.
double furnace_factor(const ScatteringSpace& space, const ViewRay& ray, const MediumBand& band,
                      std::size_t number, const SkyView& sky);

/// Factors of a picture's rays: exact at the corners of squares of pixels, linear between corners
/// at which the ray meets density.
struct FurnaceGrid {
    static constexpr std::uint32_t kPixels = 4;  ///< along an edge of a square

    std::uint32_t columns = 0, rows = 0, bands = 0;
    std::vector<double> factor;  ///< [(row * columns + column) * bands + band]; 0: no density

    /// At a place of the picture, in pixels.
    double at(double x, double y, std::size_t band) const;
};

/// `eye`: in the scene's frame.
FurnaceGrid make_furnace_grid(const ScatteringSpace& space, const runtime::Camera& camera,
                              glm::vec3 eye, const Context& context);

}  // namespace opaline::bake
