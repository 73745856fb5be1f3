#include "tests/bake/path_differentials/environment_sample.h"

namespace opaline::bake {

EnvironmentSample sample_texel(const TexelChoice& texel, double u, double v) {
    const double ds = texel.width / texel.column_mass, dt = texel.width / texel.row_mass;
    const glm::dvec2 st(texel.s + ds * (u - texel.column_start),
                        texel.t + dt * (v - texel.row_start));
    const glm::dvec3 h = texel.axis + st.x * texel.S + st.y * texel.T;
    const double length = glm::length(h);
    const glm::dvec3 D = h / length;
    const auto column = [&](double rate, const glm::dvec3& along) {
        return rate / length * (along - D * glm::dot(D, along));
    };
    return {D, st, column(ds, texel.S), column(dt, texel.T), length * length * length / (ds * dt)};
}

}  // namespace opaline::bake
