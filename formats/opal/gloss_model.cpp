#include "formats/opal/gloss_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::formats {

GlossSurface make_gloss_surface(const GlossRecord& record, Rgb base_color, float metallic,
                                float roughness) {
    const auto unit = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
    const float m = unit(metallic);
    const auto mix = [m](float a, float b) { return (1 - m) * a + m * b; };
    GlossSurface surface;
    surface.roughness = unit(roughness);
    surface.f0 = {mix(record.f0.r, unit(base_color.r)), mix(record.f0.g, unit(base_color.g)),
                  mix(record.f0.b, unit(base_color.b))};
    surface.f90 = mix(record.f90, 1.0f);
    surface.diffuse = 1 - m;
    return surface;
}

GlossAlbedo eval_gloss_albedo(const GlossSurface& surface, float cosine) {
    GlossAlbedo albedo;
    albedo.table = ggx_albedo(cosine, surface.roughness);
    const float missing = 1 / std::max(albedo.table.e1(), 1e-3f) - 1;
    const auto compensation = [missing](float f0) { return 1 + f0 * missing; };
    const Rgb k{compensation(surface.f0.r), compensation(surface.f0.g), compensation(surface.f0.b)};
    const float grazing = surface.f90 * albedo.table.of_f90;
    albedo.compensation = k;
    albedo.specular = k * (albedo.table.of_f0 * surface.f0 + Rgb{grazing, grazing, grazing});
    const float most = std::max({albedo.specular.r, albedo.specular.g, albedo.specular.b});
    albedo.diffuse = surface.diffuse * std::max(1 - most, 0.0f);
    return albedo;
}

float ggx_distribution(float n_h, float alpha) {
    // 1 + (alpha^2 - 1) n_h^2 without cancellation at the peak of a narrow lobe.
    const float sine_squared = std::max((1 - n_h) * (1 + n_h), 0.0f);
    const float d = sine_squared + alpha * alpha * n_h * n_h;
    return alpha * alpha / (std::numbers::pi_v<float> * d * d);
}

float smith_visibility(float n_v, float n_l, float alpha) {
    const float a2 = alpha * alpha;
    const float v = n_l * std::sqrt(n_v * n_v * (1 - a2) + a2);
    const float l = n_v * std::sqrt(n_l * n_l * (1 - a2) + a2);
    return 0.5f / (v + l);
}

float schlick_weight(float v_h) {
    const float missing = 1 - std::clamp(v_h, 0.0f, 1.0f), squared = missing * missing;
    return squared * squared * missing;
}

}  // namespace opaline::formats
