#pragma once

#include <cstddef>
#include <vector>

#include "bake/physics/slab/slab_medium.h"

namespace opaline::bake {

/// What is asked of the radiance that leaves a slab. Ranges as in SlabRequest.
struct SlabRadianceRequest {
    double optical_depth = 1;
    unsigned halvings = 0;
    std::vector<double> lights, view;  ///< cosines to the normal of light and view
    int streams = 32;
    unsigned modes = 3;        ///< of the azimuth: cos(m phi) for m = 0 to `modes` - 1; 1 or more
    unsigned first_order = 1;  ///< light scattered so often or more; at least 1
};

/// Radiance that leaves a slab under a beam, by azimuth mode. value[(m * views + v) * incidents +
/// i] is mode m of the reflection factor: 1 is the radiance of a white diffuse surface. A beam of
/// irradiance E on a plane facing it gives (E mu_i / pi) sum_m (2 - delta_m0) value cos(m phi);
/// phi = 0 is the side that the light goes to. Symmetric in light and view.
struct SlabRadiance {
    double optical_depth = 0;
    std::size_t incidents = 0, views = 0, modes = 0;
    std::vector<double> reflected, transmitted;
};

/// By adding and doubling, as solve_slab, one mode at a time: depths optical_depth / 2^j. The light
/// that leaves unscattered is in none of them.
std::vector<SlabRadiance> solve_slab_radiance(const SlabMedium& medium,
                                              const SlabRadianceRequest& request);

/// The reflection factor at an azimuth [rad] between the horizontal directions that light and view
/// ray propagate in. `modes`: SlabRadiance::reflected or transmitted of `radiance`.
double eval_slab_radiance(const SlabRadiance& radiance, const std::vector<double>& modes,
                          std::size_t view, std::size_t light, double azimuth);

}  // namespace opaline::bake
