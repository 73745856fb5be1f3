#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/preview_image.h"
#include "formats/opal/vec3.h"

namespace opaline::formats {

/// What an `.opal` file holds of normal maps; formats/README.md, `NORM`.

inline constexpr float kMostNormalScale = 1000;  ///< far steeper than any surface

/// The normal map of a primitive: with x, y, z the image's red, green and blue code, each
/// (code - 128) / 127, the shading normal is that of scale x T + scale y B + z N, with N and T the
/// interpolated normal and tangent of the vertices and B = sign cross(N, T). Fixed size, stored as
/// is.
struct NormalMapRecord {
    std::uint32_t primitive = 0;
    std::uint32_t image = kNoImage;  ///< index into images; its coordinates are the vertices'
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    float scale = 1;  ///< at most kMostNormalScale on either side of 0
    std::uint32_t reserved[3] = {};
};
static_assert(sizeof(NormalMapRecord) == 32);

/// Where the image of a vertex points. Every code means something.
struct Tangent {
    std::int16_t p = 0, q = 0;  ///< octahedral (vec3.h), in steps of 1 / 32767
    std::int16_t sign = 0;      ///< 32767, or -32767 where the image is mirrored; 0: no tangent
    std::uint16_t reserved = 0;
};
static_assert(sizeof(Tangent) == 8);

/// `sign`: 1, -1, or 0 where there is no direction.
Tangent encode_tangent(Vec3 direction, float sign);

/// T of the vertex, zero without a direction, and its sign in [-1, 1].
struct DecodedTangent {
    Vec3 direction;
    float sign = 0;
};
DecodedTangent decode_tangent(Tangent tangent);

/// All normal maps of an asset as spans, into the bytes of a file or into `NormalMaps`. Immutable.
struct NormalMapsView {
    std::span<const NormalMapRecord> record;  ///< ascending by primitive, one each at most
    std::span<const Tangent> tangent;         ///< of all vertices, where there is a record

    bool empty() const { return record.empty(); }
    /// Of a primitive; null: it is shaded with the normals of its vertices.
    const NormalMapRecord* of(std::uint32_t primitive) const;
};

/// Owning twin of `NormalMapsView`: what the baker builds.
struct NormalMaps {
    std::vector<NormalMapRecord> record;
    std::vector<Tangent> tangent;

    NormalMapsView view() const { return {record, tangent}; }
};

}  // namespace opaline::formats
