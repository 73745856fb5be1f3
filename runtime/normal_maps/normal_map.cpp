#include "runtime/normal_maps/normal_map.h"

#include <algorithm>

#include "runtime/texture.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

// As an image stores a coordinate: code 128 is 0, so that flat maps are flat.
float signed_code(float value) {
    return (255.0f * value - 128.0f) / 127.0f;
}

}  // namespace

Vec3 mapped_normal(const formats::AssetView& asset, const formats::NormalMapRecord& map,
                   formats::Float2 texcoord, Vec3 normal, formats::DecodedTangent tangent) {
    const formats::Rgb value =
        sample_image_values(asset.images[map.image], texcoord, map.wrap_u, map.wrap_v);
    const Vec3 bitangent = tangent.sign * cross(normal, tangent.direction);
    const Vec3 mapped = (map.scale * signed_code(value.r)) * tangent.direction +
                        (map.scale * signed_code(value.g)) * bitangent +
                        signed_code(value.b) * normal;
    const float size = length(mapped);
    return size > 0 ? (1 / size) * mapped : normal;
}

ViewOfReceiver view_mapped(const ViewOfReceiver& view, Vec3 mapped) {
    constexpr float kLeastSeen = 0.05f;
    ViewOfReceiver bent = view;
    bent.normal = view.is_turned ? -1.0f * mapped : mapped;
    bent.cosine = dot(bent.normal, view.to_eye);
    const float least = std::min(view.cosine, kLeastSeen);
    if (bent.cosine < least) {
        const Vec3 toward = bent.normal + (least - bent.cosine) * view.to_eye;
        bent.normal = (1 / length(toward)) * toward;
        bent.cosine = dot(bent.normal, view.to_eye);
    }
    return bent;
}

}  // namespace opaline::runtime
