#include "bake/encode/pack_asset.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

#include "bake/scene/copies.h"
#include "bake/scene/coverage.h"
#include "bake/scene/lobe_record.h"

namespace opaline::bake {
namespace {

using namespace formats;

PreviewImageData alpha_of(const Image8& image) {
    PreviewImageData alpha{image.width, image.height, {}};
    alpha.rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        alpha.rgb.insert(alpha.rgb.end(), 3, image.rgba[i]);
    }
    return alpha;
}

float within_alpha(float x) {
    return x > 0 ? std::min(x, 1.0f) : 0.0f;
}

void append_vertex_alpha(const Scene& scene, std::vector<float>& alphas) {
    for (const Primitive& p : scene.primitives) {
        const bool has_alpha =
            scene.materials[p.material].alpha_mode != Material::AlphaMode::opaque &&
            has_holes(scene.materials[p.material]) && !p.alpha.empty();
        for (std::size_t v = 0; v < p.position.size(); ++v) {
            alphas.push_back(has_alpha ? within_alpha(p.alpha[v]) : 1.0f);
        }
    }
}

}  // namespace

Holes pack_holes(const Scene& scene, std::vector<PreviewImageData>& images) {
    Holes holes;
    std::map<std::uint32_t, std::uint32_t> packed;  // image of the scene to image of the file
    for (std::uint32_t i = 0; i < scene.primitives.size(); ++i) {
        const Material& material = scene.materials[scene.primitives[i].material];
        if (!has_holes(material)) continue;
        const bool is_whole = material.alpha_mode == Material::AlphaMode::opaque;  // and glass
        HoleRecord hole;
        hole.primitive = i;
        if (is_clear(material)) {
            store_clear_share({material.sheet->clear, std::min(material.sheet->eta, kLargestHalf)},
                              hole);
        }
        hole.alpha = is_whole ? 1 : within_alpha(material.alpha);
        hole.cutoff = material.alpha_cutoff;
        hole.mode =
            material.alpha_mode == Material::AlphaMode::mask ? HoleMode::mask : HoleMode::blend;
        if (!is_whole && material.base_color_image != kNone &&
            !original_of(scene, i).texcoord.empty()) {
            const auto [found, is_new] = packed.try_emplace(
                material.base_color_image, static_cast<std::uint32_t>(images.size()));
            if (is_new) images.push_back(alpha_of(scene.images[material.base_color_image]));
            hole.image = found->second;
            hole.wrap_u = material.wrap_u;
            hole.wrap_v = material.wrap_v;
        }
        holes.record.push_back(hole);
    }
    if (std::ranges::any_of(holes.record, [&](const HoleRecord& hole) {
            return !original_of(scene, hole.primitive).alpha.empty();
        })) {
        append_vertex_alpha(scene, holes.vertex_alpha);
    }
    return holes;
}

}  // namespace opaline::bake
