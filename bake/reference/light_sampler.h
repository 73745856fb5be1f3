#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/reference/random_stream.h"
#include "formats/opal/environment.h"

namespace opaline::bake {

/// Distant light, to evaluate and to sample. `environment` must outlive it.
struct LightSampler {
    const formats::Environment* environment = nullptr;
    glm::mat3 world_from_light{1.0f};  ///< rotation
    /// 15 of 16 samples of the map come from a grid of cells of equal solid angle, uniform in
    /// longitude and height, in proportion to their flux; 1 of 16 comes from the whole sphere.
    std::uint32_t columns = 0, rows = 0;
    std::vector<double> row_cumulative;     ///< to 1; empty: no map
    std::vector<double> column_cumulative;  ///< to 1 in each row; rows x columns
    double map_probability = 0;
    std::vector<double> disc_probability, disc_solid_angle;  ///< one per disc
};

LightSampler make_light_sampler(const formats::Environment& environment,
                                const glm::mat3& world_from_light);

/// Radiance [W m^-2 sr^-1] from a unit direction, discs included.
glm::vec3 eval_light(const LightSampler& light, glm::vec3 direction);

/// A unit direction to the light, in proportion to its radiance at the resolution of the grid;
/// {0,0,0} if there is no light.
glm::vec3 sample_light(const LightSampler& light, RandomStream& random);

/// Density of `sample_light` over solid angle [1/sr].
float pdf_light(const LightSampler& light, glm::vec3 direction);

}  // namespace opaline::bake
