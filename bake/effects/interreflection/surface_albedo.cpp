#include "bake/effects/interreflection/surface_albedo.h"

#include <algorithm>

#include "bake/scene/lobe_record.h"
#include "bake/scene/marble.h"
#include "bake/scene/sample_image.h"
#include "formats/opal/gloss_model.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

bool has_image(const formats::Scene& scene, const formats::Primitive& p, std::uint32_t image) {
    return image != formats::kNone && !p.texcoord.empty() && scene.images[image].width > 0 &&
           scene.images[image].height > 0;
}

// (1 - metallic) (1 - max E), the mean over diffuse views by the midpoint rule in c^2.
float diffuse_share_at(const formats::Material& material, Rgb base_color, glm::vec4 image) {
    constexpr int kViews = 8;
    const formats::GlossRecord record = make_lobe_record(material.gloss);
    const formats::GlossSurface surface = formats::make_gloss_surface(
        record, base_color, material.gloss.metallic * image.b, material.gloss.roughness * image.g);
    float sum = 0;
    for (int i = 0; i < kViews; ++i) {
        const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kViews);
        sum += formats::eval_gloss_albedo(surface, cosine).diffuse;
    }
    return sum / kViews;
}

}  // namespace

Rgb eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                        const SurfacePoint& point) {
    const formats::Primitive& p = scene.primitives[point.primitive];
    const formats::Material& material = scene.materials[p.material];
    Rgb color = material.base_color * layout.tint;
    Rgb vertex{0, 0, 0};
    glm::vec2 uv(0);
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[point.first_index + static_cast<std::uint32_t>(k)];
        const float weight = point.barycentric[k];
        vertex = p.color.empty() ? vertex : vertex + weight * p.color[v];
        uv += p.texcoord.empty() ? glm::vec2(0) : weight * p.texcoord[v];
    }
    if (!p.color.empty()) {
        color = color * vertex;
    }
    if (material.marble) {
        color = color * marble_color(*material.marble, scene.to_world(point.position));
    }
    if (has_image(scene, p, material.base_color_image)) {
        const glm::vec4 texel = sample_image(
            {scene.images[material.base_color_image], material.wrap_u, material.wrap_v, false}, uv);
        color = color * Rgb{texel.r, texel.g, texel.b};
    }
    if (layout.mirrors && !layout.translucent) {
        const glm::vec4 gloss =
            has_image(scene, p, material.gloss.image)
                ? sample_image({scene.images[material.gloss.image], material.gloss.wrap_u,
                                material.gloss.wrap_v, true},
                               uv)
                : glm::vec4(1);
        color = diffuse_share_at(material, color, gloss) * color;
    }
    return color;
}

}  // namespace opaline::bake
