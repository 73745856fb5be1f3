#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "bake/pipeline/pipeline.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::tests {

/// A draft of few walks and rays, of all coefficients.
formats::Result<bake::BakeResult> bake_coarsely(const formats::Scene& scene, unsigned threads,
                                                bool check_model = false);

/// Grey light of the sky and of lamps.
struct LightOfAll {
    std::string name;
    std::vector<float> texels;  ///< radiance, of the coarsest cube map
    bool lamps = false;
    double background = 0;  ///< radiance behind volumes
};

LightOfAll even_light(bool lamps);
LightOfAll half_sky(bool lamps);    ///< radiance 1 from three faces of the cube map
LightOfAll sun_of(float radiance);  ///< of one texel
LightOfAll no_sky(bool lamps);

/// The same for a scene whose directions became turn * direction, a symmetry of the cube.
LightOfAll turned(const LightOfAll& light, const glm::dmat3& turn);
/// The same light brighter, and both together. Lamps are those of the first one.
LightOfAll scaled(float factor, LightOfAll light);
LightOfAll sum(const LightOfAll& a, const LightOfAll& b);

/// In the scene's frame [m].
struct LineOfSight {
    glm::dvec3 from, along;
};

/// Lines through a scene's volumes, the same of the same seed; none without volumes.
std::vector<LineOfSight> lines_through_volumes(const formats::Scene& scene);

struct Shown {
    std::vector<std::vector<double>> vertices;  ///< of each primitive: radiance along its normal
    std::vector<double> through_volumes;        ///< along lines: light of volumes and behind them
};

/// `origin`: of the scene that was baked.
Shown show(const bake::BakeResult& baked, glm::dvec3 origin, const std::vector<LineOfSight>& lines,
           const LightOfAll& light);

/// The error that the bake states of even light: how it blurs suns is no part of it.
double stated_of(const bake::BakeResult& baked);

}  // namespace opaline::tests
