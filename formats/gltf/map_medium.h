#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// The single-scattering albedo of a medium whose thick slab reflects `multiscatter` under diffuse
/// light: the inversion of [Kulla2017], with the similarity relation for the mean cosine g: s^2 =
/// (1 - a) / (1 - a g). Precondition: multiscatter in [0, 1], |g| < 1. Result in [0, 1]; 0 for 0.
double single_scattering_albedo(double multiscatter, double g);

/// The medium that a material's extensions describe [1/m], or nothing where they describe none.
/// `KHR_materials_volume` gives sigma_t = -ln(attenuationColor) / attenuationDistance,
/// `KHR_materials_scatter` the albedo (of strength times colour; with its predecessor
/// `KHR_materials_volume_scatter` the albedo is that of g = 0), `KHR_materials_ior` and
/// `KHR_materials_specular` eta, by way of the reflectance at normal incidence. `remarks` gets one
/// sentence for each property that differs from the file. A volume that lets light in and does not
/// scatter is glass: sigma_s is 0, sigma_a above 0 however clear it is.
std::optional<Medium> map_medium(const TranslucencySource& source, double metres_per_unit,
                                 std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
