#include "bake/encode/pack_asset.h"

#include <cstddef>
#include <cstdint>

#include "bake/scene/copies.h"
#include "bake/scene/lobe_record.h"
#include "formats/opal/sheet_shares.h"

namespace opaline::bake {

formats::NormalMaps pack_normal_maps(const formats::Scene& scene) {
    formats::NormalMaps maps;
    for (std::uint32_t i = 0; i < scene.primitives.size(); ++i) {
        const formats::Primitive& p = original_of(scene, i);
        const formats::Material& material = scene.materials[p.material];
        if (material.normal_image == formats::kNone || material.normal_scale == 0 ||
            p.tangent.empty()) {
            continue;
        }
        formats::NormalMapRecord map;
        map.primitive = i;
        map.image = material.normal_image;
        map.wrap_u = material.normal_wrap_u;
        map.wrap_v = material.normal_wrap_v;
        map.scale = material.normal_scale;
        if (material.sheet) {
            formats::store_sheet_shares({material.sheet->reflect, material.sheet->transmit}, map);
        }
        maps.record.push_back(map);
    }
    if (maps.record.empty()) return maps;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t v = 0; v < p.position.size(); ++v) {
            const glm::vec4 t = p.tangent.empty() ? glm::vec4(0.0f) : p.tangent[v];
            maps.tangent.push_back(formats::encode_tangent({t.x, t.y, t.z}, t.w));
        }
    }
    return maps;
}

}  // namespace opaline::bake
