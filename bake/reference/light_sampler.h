#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/reference/random_stream.h"
#include "formats/opal/environment.h"

namespace opaline::bake {

/// Distant light that can be looked at and sampled. `environment` must outlive it.
struct LightSampler {
    const formats::Environment* environment = nullptr;
    glm::mat3 world_from_light{1.0f};  ///< rotation
    /// The map's samples come from a grid of cells of equal solid angle, uniform in longitude and
    /// height, in proportion to what they send; 1 in 16 from the whole sphere.
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

/// A unit direction to the light, in proportion to its radiance as far as the grid tells;
/// {0,0,0} where there is no light at all.
glm::vec3 sample_light(const LightSampler& light, RandomStream& random);

/// Density of `sample_light` over solid angle [1/sr].
float pdf_light(const LightSampler& light, glm::vec3 direction);

}  // namespace opaline::bake
