#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "runtime/api_support.h"
#include "runtime/parallel.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

namespace opaline::runtime::api {

bool is_radiance(const float* values, std::size_t count) {
    return std::all_of(values, values + count,
                       [](float x) { return x >= 0.0f && std::isfinite(x); });
}

const char* fault_of_sun(const float direction[3], float angular_radius, const float radiance[3]) {
    if (!unit_vector(direction)) return "the sun's direction must be finite and not zero";
    // Below 1e-6 rad the squared radius would leave the range in which its solid angle is exact.
    if (!(angular_radius >= 1e-6f && angular_radius < 0.5f * std::numbers::pi_v<float>)) {
        return "the sun's radius must be in 1e-6 ... pi/2 radians";
    }
    return is_radiance(radiance, 3) ? nullptr : "radiance must be finite and not negative";
}

formats::DistantDisc sun_of(const float direction[3], float angular_radius,
                            const float radiance[3]) {
    return {*unit_vector(direction), angular_radius, {radiance[0], radiance[1], radiance[2]}};
}

std::optional<Rotation> rotation_of(const float m[9]) {
    const Rotation rotation{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
    if (is_rotation(rotation, 1e-3f)) return rotation;
    invalid(
        "the matrix is not a rotation: its columns must be orthonormal to 1e-3, its "
        "determinant +1");
    return std::nullopt;
}

}  // namespace opaline::runtime::api

namespace {

// The work on a light of a thread that is the only one to use it.
template <class Work>
opaline_status change(opaline_light& light, const Work& work) {
    const runtime::Writing writing(light.users);
    if (!writing) return busy();
    return guarded([&] {
        work();
        return OPALINE_OK;
    });
}

opaline_status set_map(opaline_light& light, const float* rgb, formats::Environment::Layout layout,
                       std::uint32_t width, std::uint32_t height) {
    const std::size_t pixels = std::size_t{width} * height;
    if (!is_radiance(rgb, 3 * pixels)) return invalid("radiance must be finite and not negative");
    return change(light, [&] {
        formats::Environment map;
        map.layout = layout;
        map.width = width;
        map.height = height;
        static_assert(sizeof(formats::Rgb) == 3 * sizeof(float));
        const auto* const first = reinterpret_cast<const formats::Rgb*>(rgb);
        map.pixel.assign(first, first + pixels);
        light.distant.set_map(map, light.threads);
    });
}

opaline_status rotate(opaline_light* light, const float* m, runtime::MapSampling sampling) {
    if (light == nullptr || m == nullptr) return null_argument();
    const auto rotation = rotation_of(m);
    if (!rotation) return OPALINE_INVALID_ARGUMENT;
    return change(*light, [&] { light->distant.turn(*rotation, sampling, light->threads); });
}

}  // namespace

extern "C" {

opaline_status opaline_light_create(const opaline_asset* asset, opaline_light** out) {
    if (asset == nullptr || out == nullptr) return null_argument();
    return guarded([&] {
        const formats::AssetView& view = asset->loaded.view;
        auto light =
            std::make_unique<opaline_light>(view.cubemap_size, runtime::specular_needs(view));
        light->emitters.assign(view.emitters.size(), {1, 1, 1});
        *out = light.release();
        return OPALINE_OK;
    });
}

void opaline_light_release(opaline_light* light) {
    delete light;
}

opaline_status opaline_light_set_threads(opaline_light* light, uint32_t threads) {
    if (light == nullptr) return null_argument();
    if (threads > runtime::kMaxThreads) return invalid(kTooManyThreads);
    return change(*light, [&] { light->threads = threads; });
}

opaline_status opaline_light_set_rotation(opaline_light* light, const float world_from_light[9]) {
    return rotate(light, world_from_light, runtime::MapSampling::full);
}

opaline_status opaline_light_turn(opaline_light* light, const float world_from_light[9]) {
    return rotate(light, world_from_light, runtime::MapSampling::moving);
}

opaline_status opaline_light_set_cubemap(opaline_light* light, const float* rgb, uint32_t size) {
    if (light == nullptr || rgb == nullptr) return null_argument();
    if (size < 1 || size > 8192) return invalid("the cube map's size must be 1 ... 8192");
    return set_map(*light, rgb, formats::Environment::Layout::cube, size,
                   size * formats::kCubeFaces);
}

opaline_status opaline_light_set_lat_long(opaline_light* light, const float* rgb, uint32_t width,
                                          uint32_t height) {
    if (light == nullptr || rgb == nullptr) return null_argument();
    if (width < 1 || width > 32768 || height < 1 || height > 32768) {
        return invalid("the map's width and height must be 1 ... 32768");
    }
    return set_map(*light, rgb, formats::Environment::Layout::lat_long, width, height);
}

opaline_status opaline_light_set_harmonics(opaline_light* light, const float rgb[27]) {
    if (light == nullptr || rgb == nullptr) return null_argument();
    if (!is_finite(rgb, 27)) return invalid("coefficients must be finite");
    runtime::Harmonics harmonics;
    for (std::size_t k = 0; k < harmonics.size(); ++k) {
        harmonics[k] = {rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2]};
    }
    return change(*light, [&] { light->distant.set_harmonics(harmonics, light->threads); });
}

opaline_status opaline_light_set_coefficients(opaline_light* light, const float* rgb,
                                              size_t count) {
    if (light == nullptr || rgb == nullptr) return null_argument();
    if (count != std::size_t{3} * formats::cubemap_texels(light->n)) {
        return fail(count < std::size_t{3} * formats::cubemap_texels(light->n)
                        ? OPALINE_BUFFER_TOO_SMALL
                        : OPALINE_INVALID_ARGUMENT,
                    "the basis has 6 * size * size coefficients, of three floats each");
    }
    if (!is_finite(rgb, count)) return invalid("coefficients must be finite");
    return change(*light, [&] { light->distant.set_coefficients({rgb, count}, light->threads); });
}

opaline_status opaline_light_get_coefficients(const opaline_light* light, float* out_rgb,
                                              size_t out_count) {
    if (light == nullptr || out_rgb == nullptr) return null_argument();
    const std::size_t coefficients = formats::cubemap_texels(light->n);
    if (out_count < 3 * coefficients) {
        return fail(OPALINE_BUFFER_TOO_SMALL,
                    "the basis has 6 * size * size coefficients, of three floats each");
    }
    const runtime::Reading reading(light->users);
    if (!reading) return busy();
    for (std::size_t k = 0; k < coefficients; ++k) {
        std::copy_n(&light->vector().rgba[4 * k], 3, out_rgb + 3 * k);
    }
    return OPALINE_OK;
}

opaline_status opaline_light_add_sun(opaline_light* light, const float direction[3],
                                     float angular_radius, const float radiance[3]) {
    if (light == nullptr || direction == nullptr || radiance == nullptr) return null_argument();
    if (const char* fault = fault_of_sun(direction, angular_radius, radiance)) {
        return invalid(fault);
    }
    return change(*light, [&] {
        light->distant.add_sun(sun_of(direction, angular_radius, radiance), light->threads);
    });
}

opaline_status opaline_light_set_sun(opaline_light* light, uint32_t index, const float direction[3],
                                     float angular_radius, const float radiance[3]) {
    if (light == nullptr || direction == nullptr || radiance == nullptr) return null_argument();
    if (const char* fault = fault_of_sun(direction, angular_radius, radiance)) {
        return invalid(fault);
    }
    bool exists = false;
    const opaline_status status = change(*light, [&] {
        exists = index < light->distant.suns();
        if (!exists) return;
        light->distant.set_sun(index, sun_of(direction, angular_radius, radiance), light->threads);
    });
    return status != OPALINE_OK || exists ? status : invalid("the light has no sun of that index");
}

opaline_status opaline_light_clear(opaline_light* light) {
    if (light == nullptr) return null_argument();
    return change(*light, [&] { light->distant.clear(light->threads); });
}

}  // extern "C"
