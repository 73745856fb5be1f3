#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/clouds/see_layer.h"
#include "runtime/embed_gl/api_gl_support.h"
#include "runtime/picture/camera.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/bench/gl_parity/conditioning.h"
#include "tests/runtime/embed_gl/camera_rays.h"
#include "tests/runtime/embed_gl/host/host_layer.h"

namespace opaline::parity {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::HostRay;

constexpr float kSpread = 2e-3f;

struct ReleaseLayer {
    void operator()(opaline_layer_light* light) const { opaline_layer_light_release(light); }
};

runtime::Camera camera_at(Vec3 eye, Vec3 target) {
    return {.eye = eye, .target = target, .fov_y = 60, .width = 24, .height = 18, .near_plane = 1};
}

// From below, above, beside and within the layer.
std::array<std::pair<const char*, runtime::Camera>, 4> viewpoints(
    const formats::LayerRecord& layer) {
    const float base = layer.base, top = layer.base + layer.highest, high = base - layer.ground;
    const Vec3 at{layer.center[0], 0, layer.center[1]};
    const auto from = [&](float x, float y, float z) { return at + Vec3{x, y, z}; };
    return {
        {{"from below, ray", camera_at(from(0, layer.ground + 2, 0), from(0, base, -1.5f * high))},
         {"from above, ray",
          camera_at(from(0, top + 2 * high, 0), from(0.6f * high, base, -1.5f * high))},
         {"grazing, ray", camera_at(from(0, top + 0.1f * high, 0), from(3 * high, top, -high))},
         {"from within, ray",
          camera_at(from(0.3f * high, base + 0.3f * layer.highest, 0.2f * high),
                    from(0.9f * high, base + 0.4f * layer.highest, -0.3f * high))}}};
}

// What rays see of the layer: three bands of its light, four shares that pass, and the distance of
// what is more than next to nothing, else 0.
struct Seen {
    std::vector<float> radiance, transmittance, distance;
};

Seen see_on_cpu(const runtime::LayerLight& light, Vec3 eye, const std::vector<HostRay>& rays) {
    Seen all;
    for (const HostRay& ray : rays) {
        const runtime::SeenLayer seen =
            runtime::see_layer(light, {eye,
                                       {ray.direction[0], ray.direction[1], ray.direction[2]},
                                       static_cast<double>(ray.begin),
                                       static_cast<double>(ray.end),
                                       kSpread});
        const Rgb own = seen.radiance + 2.0f * seen.glow, left = seen.transmittance;
        all.radiance.insert(all.radiance.end(), {own.r, own.g, own.b});
        all.transmittance.insert(all.transmittance.end(),
                                 {left.r, left.g, left.b, seen.sun_transmittance.b});
        all.distance.push_back(1 - left.g < 1e-3f ? 0 : static_cast<float>(seen.distance));
    }
    return all;
}

Seen split(const std::vector<float>& drawn) {
    Seen all;
    for (std::size_t i = 0; i < drawn.size(); i += 8) {
        const float* const at = &drawn[i];
        all.radiance.insert(all.radiance.end(), at, at + 3);
        all.transmittance.insert(all.transmittance.end(), at + 4, at + 8);
        all.distance.push_back(at[3]);
    }
    return all;
}

void compare_view(const Case& in, const runtime::LayerLight& light, test::HostPicture& picture,
                  const std::string& name, const runtime::Camera& camera) {
    const Vec3 eye = camera.eye;
    test::require(opaline_gl_look_from(in.gl, &eye.x) == OPALINE_OK, opaline_last_error());
    std::vector<HostRay> rays = test::camera_rays(camera);
    for (std::size_t i = 0; i < rays.size(); i += 5)
        rays[i].end = 1500;
    Seen gl = split(picture.draw(rays));
    const Seen cpu = see_on_cpu(light, eye, rays);
    std::vector<float> distances = cpu.distance;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (distances[i] > 0) continue;
        distances[i] = 1;
        gl.distance[i] = 0;
    }
    const float far =
        std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z), light.record.base});
    const auto compare = [&](const char* what, std::vector<float> Seen::*values, std::size_t each,
                             const std::vector<float>& scale, double tolerance) {
        const std::string of = what + (" " + name);
        compare_values(
            in.report, {Kind::layers, of, each, scale, far * 0x1p-22f, tolerance},
            [&](Vec3 by) { return see_on_cpu(light, eye + by, rays).*values; }, gl.*values);
    };
    compare("radiance", &Seen::radiance, 3, {largest_of(cpu.radiance)}, kTolerance);
    compare("transmittance", &Seen::transmittance, 4, {1}, kTolerance);
    // Where a grazing ray meets the top is the difference of nearly equal heights.
    compare("distance", &Seen::distance, 1, distances, 2e-5);
}

}  // namespace

void compare_layers(const Case& in, const Sky& sky) {
    const opaline_asset* const asset = in.file.asset();
    if (opaline_asset_layer_count(asset) == 0) return;
    opaline_layer_light* made = nullptr;
    test::require(opaline_layer_light_create(asset, &made) == OPALINE_OK, opaline_last_error());
    const std::unique_ptr<opaline_layer_light, ReleaseLayer> light(made);
    const opaline_layer_sky of_layer = sky.of_layer();
    test::require(opaline_layer_light_update(light.get(), asset, &of_layer, 1) == OPALINE_OK &&
                      opaline_gl_show_layer(in.gl, asset, light.get()) == OPALINE_OK,
                  opaline_last_error());
    test::HostPicture picture = test::make_layer_picture(
        in.api, test::filled<opaline_gl_layer>(opaline_gl_get_layer, in.gl));
    picture.set_flag("wants_parts", true);
    picture.set_number("spread", kSpread);
    for (const auto& [name, camera] : viewpoints(light->light.record))
        compare_view(in, light->light, picture, name, camera);
}

}  // namespace opaline::parity
