#include "bake/cli/stand_in.h"

#include <cstdint>

namespace opaline::cli {

formats::Asset make_stand_in(const formats::Scene& scene) {
    formats::Asset asset;
    for (const formats::Primitive& p : scene.primitives) {
        formats::PrimitiveRecord record;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        record.vertex_count = static_cast<std::uint32_t>(p.position.size());
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.index_count = static_cast<std::uint32_t>(p.index.size());
        asset.primitives.push_back(record);
        for (const glm::vec3& v : p.position) {
            const glm::vec3 world(scene.to_world(v));
            asset.position.push_back({world.x, world.y, world.z});
        }
        asset.index.insert(asset.index.end(), p.index.begin(), p.index.end());
    }
    for (const formats::Volume& volume : scene.volumes) {
        formats::PrimitiveRecord record;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        for (const glm::dvec3& corner : volume.density.corners()) {
            const glm::vec3 world(scene.origin + corner);
            asset.position.push_back({world.x, world.y, world.z});
        }
        record.vertex_count =
            static_cast<std::uint32_t>(asset.position.size()) - record.first_vertex;
        asset.primitives.push_back(record);
    }
    return asset;
}

}  // namespace opaline::cli
