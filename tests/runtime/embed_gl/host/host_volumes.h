#pragma once

#include <vector>

#include "formats/opal/vec3.h"
#include "tests/runtime/embed_gl/host/host_picture.h"

namespace opaline::test {

/// A host's picture of volumes, bound: `a` and `b` are radiance and transmittance of a ray, and
/// where its flag `is_point` is set extinction and scattered light at `from` toward `direction`. An
/// earlier host knows nothing of `glows`. Throws as `require`.
HostPicture make_volume_picture(HostApi api, const opaline_gl_volumes& volumes);

/// What the CPU sees of rays whose origins are offsets from the eye. Throws as `require`.
std::vector<opaline_march_result> march_rays(const opaline_asset* asset,
                                             const opaline_volume_light* light,
                                             const std::vector<HostRay>& rays, formats::Vec3 eye);

/// What it has at their origins.
std::vector<opaline_sample_result> sample_points(const opaline_asset* asset,
                                                 const opaline_volume_light* light,
                                                 const std::vector<HostRay>& rays,
                                                 formats::Vec3 eye);

}  // namespace opaline::test
