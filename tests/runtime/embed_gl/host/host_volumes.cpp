#include "tests/runtime/embed_gl/host/host_volumes.h"

#include <cstdint>
#include <string>

namespace opaline::test {
namespace {

const char* const kSeeVolumes = R"(
uniform bool is_point;
void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b) {
    if (is_point) {
        OpalineVolumeSample found = opaline_sample_volumes(from, direction);
        a = vec4(found.extinction, 1.0);
        b = vec4(found.scattered, 1.0);
        return;
    }
    OpalineSeen seen = opaline_march_volumes(from, direction, begin, end);
    a = vec4(seen.radiance, 1.0);
    b = vec4(seen.transmittance, 1.0);
}
)";

}  // namespace

HostPicture make_volume_picture(HostApi api, const opaline_gl_volumes& volumes) {
    HostPicture picture(api, {"opaline_volumes.glsl"},
                        "#define OPALINE_VOLUMES " + std::to_string(volumes.count) +
                            "\n#define OPALINE_VOLUME_TERMS " + std::to_string(volumes.terms) +
                            (volumes.glows != 0 ? "\n#define OPALINE_VOLUME_GLOW 1\n" : "\n"),
                        kSeeVolumes);
    picture.bind_texture("opaline_brick_numbers", volumes.brick_numbers);
    picture.bind_texture("opaline_density_codes", volumes.density_codes);
    picture.bind_texture("opaline_corner_numbers", volumes.corner_numbers);
    picture.bind_texture("opaline_node_light", volumes.node_light);
    picture.bind_texture("opaline_phase_entries", volumes.phase_entries);
    picture.bind_block("OpalineVolumeRecords", volumes.block);
    if (volumes.glows != 0) picture.bind_texture("opaline_glow_words", volumes.glow_words);
    return picture;
}

std::vector<opaline_march_result> march_rays(const opaline_asset* asset,
                                             const opaline_volume_light* light,
                                             const std::vector<HostRay>& rays, formats::Vec3 eye) {
    std::vector<opaline_march_ray> march;
    for (const HostRay& ray : rays) {
        march.push_back({{eye.x + ray.from[0], eye.y + ray.from[1], eye.z + ray.from[2]},
                         {ray.direction[0], ray.direction[1], ray.direction[2]},
                         ray.begin,
                         ray.end});
    }
    std::vector<opaline_march_result> seen(march.size());
    require(
        opaline_volumes_march(asset, light, nullptr, march.data(),
                              static_cast<std::uint32_t>(march.size()), seen.data()) == OPALINE_OK,
        opaline_last_error());
    return seen;
}

std::vector<opaline_sample_result> sample_points(const opaline_asset* asset,
                                                 const opaline_volume_light* light,
                                                 const std::vector<HostRay>& rays,
                                                 formats::Vec3 eye) {
    std::vector<opaline_sample_point> points;
    for (const HostRay& ray : rays) {
        points.push_back({{eye.x + ray.from[0], eye.y + ray.from[1], eye.z + ray.from[2]},
                          {ray.direction[0], ray.direction[1], ray.direction[2]}});
    }
    std::vector<opaline_sample_result> found(points.size());
    require(opaline_volumes_sample(asset, light, points.data(),
                                   static_cast<std::uint32_t>(points.size()),
                                   found.data()) == OPALINE_OK,
            opaline_last_error());
    return found;
}

}  // namespace opaline::test
