#include "runtime/volumes/node_radiance.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::VolumeRecord;

// Position of a node among the points of suns.
struct NodePlace {
    std::uint32_t brick = formats::kNoBrick;
    std::size_t point = 0;
};

std::vector<NodePlace> find_nodes(const formats::VolumesView& volumes, std::size_t volume,
                                  std::uint32_t boxes) {
    const VolumeRecord& record = volumes.records[volume];
    std::vector<NodePlace> places(record.node_count);
    const std::size_t side = record.corners_along_edge(), stride = boxes / (side - 1);
    for (std::uint32_t brick = 0; brick < record.brick_count; ++brick) {
        const auto corner = volumes.corner.subspan(
            record.first_corner + brick * record.corners_of_brick(), record.corners_of_brick());
        for (std::size_t i = 0; i < corner.size(); ++i) {
            if (corner[i] == formats::kNoNode) continue;
            const std::size_t x = i % side, y = i / side % side, z = i / side / side;
            const std::size_t points = std::size_t{boxes} + 1;
            places[corner[i]] = {brick, stride * ((z * points + y) * points + x)};
        }
    }
    return places;
}

}  // namespace

std::vector<Rgb> node_radiance(const formats::VolumesView& volumes, const VolumeLight& light,
                               std::size_t volume, const std::optional<formats::Vec3>& eye) {
    const VolumeRecord& record = volumes.records[volume];
    const VolumeLight::Part& part = light.part[volume];
    const auto& m = record.to_world;
    std::vector<Rgb> radiance(record.node_count);
    if (part.terms == 0) return radiance;
    const SourceWeights mean = mean_weights(light, volume);
    const std::vector<NodePlace> places = find_nodes(volumes, volume, part.sun_boxes);
    for (std::uint32_t i = 0; i < record.node_count; ++i) {
        SourceWeights weight = mean;
        if (eye) {
            const formats::NodeVoxel node = volumes.node[record.first_node + i];
            const auto x = static_cast<float>(node[0]), y = static_cast<float>(node[1]),
                       z = static_cast<float>(node[2]);
            const formats::Vec3 to_eye =
                *eye - formats::Vec3{m[0] * x + m[1] * y + m[2] * z + m[3],
                                     m[4] * x + m[5] * y + m[6] * z + m[7],
                                     m[8] * x + m[9] * y + m[10] * z + m[11]};
            // From the node itself there is no direction: the mean, as without an eye.
            if (const float norm = length(to_eye); norm > 0 && std::isfinite(norm)) {
                weight = source_weights(light, volume, (1 / norm) * to_eye);
            }
        }
        Rgb sum = eval_node(light, volume, i, weight);
        if (part.suns > 0 && places[i].brick != formats::kNoBrick) {
            const SunSource suns =
                eval_suns(light, volume, places[i].brick, places[i].point, weight);
            for (std::size_t j = 0; j < part.sun_terms; ++j) {
                sum = sum + suns[j];
            }
        }
        radiance[i] = tame(sum, std::numeric_limits<float>::max());
    }
    return radiance;
}

}  // namespace opaline::runtime
