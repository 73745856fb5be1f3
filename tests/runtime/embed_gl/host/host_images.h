#pragma once

#include "formats/opal/normal_maps.h"
#include "formats/opal/vec3.h"
#include "tests/runtime/embed_gl/host/host_picture.h"

namespace opaline::test {

/// A host's picture of images, bound: at the texture coordinates `from`.xy a.rgb has `color`, which
/// is decoded, b.rgb has `values`; a.a is 1 where a surface of alpha `begin` covers the pixel
/// `direction`.xy of the triangle kHostTriangle. Throws as `require`.
HostPicture make_image_picture(HostApi api, const opaline_gl_image& color,
                               const opaline_gl_image& values, const opaline_gl_images& of);
inline constexpr unsigned kHostTriangle = 17;

/// A host's picture of a normal map under the light that relit last, bound: `a` is the mapped
/// normal at the texture coordinates `from`.xy of a receiver of the normal `direction` and that
/// host_tangent, `b` its light (1, 0.9, 0.8) * `begin` turned to that. Throws as `require`.
HostPicture make_normal_map_picture(HostApi api, const opaline_gl_normal_map& map);

/// A tangent for a unit normal.
formats::DecodedTangent host_tangent(formats::Vec3 normal);

}  // namespace opaline::test
