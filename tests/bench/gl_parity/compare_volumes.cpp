#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "runtime/picture/camera.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/bench/gl_parity/conditioning.h"
#include "tests/runtime/embed_gl/host/host_volumes.h"

namespace opaline::parity {
namespace {

using formats::Vec3;
using test::HostRay;

constexpr int kRays = 400;

struct Release {
    void operator()(opaline_volume_light* light) const { opaline_volume_light_release(light); }
};

// A point of a box that is a little larger than the volume's.
Vec3 point_of(const opaline_volume_info& info, std::mt19937& generator) {
    std::uniform_real_distribution<float> share(-0.05f, 1.05f);
    const auto corner = [&](int i) {
        return Vec3{info.corner[i][0], info.corner[i][1], info.corner[i][2]};
    };
    const float x = share(generator), y = share(generator), z = share(generator);
    return corner(0) + x * (corner(1) - corner(0)) + y * (corner(2) - corner(0)) +
           z * (corner(4) - corner(0));
}

// An offset which added to the eye gives the place that the CPU is asked for: floats round that
// sum.
HostRay ray_from(Vec3 place, Vec3 eye) {
    const Vec3 offset = (eye + (place - eye)) - eye;
    return {{offset.x, offset.y, offset.z}, 0, {0, 0, 1}, 1e30f};
}

void set_direction(HostRay& ray, Vec3 direction) {
    ray.direction[0] = direction.x;
    ray.direction[1] = direction.y;
    ray.direction[2] = direction.z;
}

// Toward points of the volumes: from the eye and beside it, some with a begin or an end there.
std::vector<HostRay> rays_toward(const std::vector<opaline_volume_info>& volumes, Vec3 eye) {
    std::mt19937 generator(5);
    std::vector<HostRay> rays;
    for (std::size_t i = 0; i < kRays; ++i) {
        const opaline_volume_info& volume = volumes[i % volumes.size()];
        const Vec3 to = point_of(volume, generator);
        const Vec3 beside = eye + 0.05f * (point_of(volume, generator) - to);
        const Vec3 from = i % 2 == 0 ? eye : beside, way = to - from;
        HostRay ray = ray_from(from, eye);
        const float distance = length(way);
        if (!(distance > 0)) continue;
        set_direction(ray, formats::normalize(way));
        if (i % 3 == 0) ray.begin = 0.8f * distance;
        if (i % 4 == 0) ray.end = distance;
        rays.push_back(ray);
    }
    return rays;
}

std::vector<HostRay> points_of(const std::vector<opaline_volume_info>& volumes, Vec3 eye) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<HostRay> points;
    for (std::size_t i = 0; i < kRays; ++i) {
        points.push_back(ray_from(point_of(volumes[i % volumes.size()], generator), eye));
        const Vec3 toward{value(generator), value(generator), value(generator) + 0.01f};
        set_direction(points.back(), formats::normalize(toward));
    }
    return points;
}

// Three values of each result.
template <class Result>
std::vector<float> values_of(const std::vector<Result>& results, const float (Result::*values)[3]) {
    std::vector<float> all;
    for (const Result& result : results)
        all.insert(all.end(), result.*values, result.*values + 3);
    return all;
}

// Three of the eight floats of each place.
std::vector<float> half_of(const std::vector<float>& drawn, std::size_t first) {
    std::vector<float> half;
    for (std::size_t i = first; i < drawn.size(); i += 8)
        half.insert(half.end(), {drawn[i], drawn[i + 1], drawn[i + 2]});
    return half;
}

// `function`: march_rays or sample_points; shares of the largest value, or of `scale`.
template <class Function, class Result>
void compare_halves(const Case& in, Kind kind, const char* of, const Function& function,
                    const float (Result::*values)[3], const std::vector<HostRay>& rays, Vec3 eye,
                    const std::vector<float>& gl, float scale) {
    const SeenFrom cpu = [&](Vec3 by) { return values_of(function(rays, eye + by), values); };
    const float far = std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)});
    compare_values(in.report,
                   {kind, of, 3, {scale > 0 ? scale : largest_of(cpu({}))}, far * 0x1p-22f}, cpu,
                   gl);
}

}  // namespace

void compare_volumes(const Case& in) {
    const auto objects = test::filled<opaline_gl_volumes>(opaline_gl_get_volumes, in.gl);
    if (objects.count == 0) return;
    std::vector<opaline_volume_info> volumes;
    for (std::uint32_t v = 0; v < objects.count; ++v) {
        volumes.push_back(
            test::filled<opaline_volume_info>(opaline_asset_volume, in.file.asset(), v));
    }
    opaline_volume_light* made = nullptr;
    test::require(opaline_volume_light_create(in.file.asset(), &made) == OPALINE_OK,
                  opaline_last_error());
    const std::unique_ptr<opaline_volume_light, Release> light(made);
    test::require(opaline_volume_light_update(light.get(), in.file.asset(), in.file.light(), 0,
                                              1) == OPALINE_OK &&
                      opaline_gl_light_volumes(in.gl, light.get()) == OPALINE_OK,
                  opaline_last_error());
    test::HostPicture picture = test::make_volume_picture(in.api, objects);
    const Vec3 front = runtime::frame_asset(in.view(), 40, 128, 96).eye;
    std::mt19937 generator(7);
    const auto march = [&](const std::vector<HostRay>& rays, Vec3 eye) {
        return test::march_rays(in.file.asset(), light.get(), rays, eye);
    };
    const auto sample = [&](const std::vector<HostRay>& points, Vec3 eye) {
        return test::sample_points(in.file.asset(), light.get(), points, eye);
    };
    using March = opaline_march_result;
    using Sample = opaline_sample_result;
    for (const Vec3 eye : {front, point_of(volumes.front(), generator)}) {
        test::require(opaline_gl_look_from(in.gl, &eye.x) == OPALINE_OK, opaline_last_error());
        const std::vector<HostRay> rays = rays_toward(volumes, eye),
                                   points = points_of(volumes, eye);
        picture.set_flag("is_point", false);
        const std::vector<float> seen = picture.draw(rays);
        picture.set_flag("is_point", true);
        const std::vector<float> found = picture.draw(points);
        compare_halves(in, Kind::rays, "radiance of ray", march, &March::radiance, rays, eye,
                       half_of(seen, 0), 0);
        compare_halves(in, Kind::rays, "transmittance of ray", march, &March::transmittance, rays,
                       eye, half_of(seen, 4), 1);
        compare_halves(in, Kind::points, "extinction of point", sample, &Sample::extinction, points,
                       eye, half_of(found, 0), 0);
        compare_halves(in, Kind::points, "light of point", sample, &Sample::scattered, points, eye,
                       half_of(found, 4), 0);
    }
}

}  // namespace opaline::parity
