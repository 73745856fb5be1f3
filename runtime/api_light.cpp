#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "formats/opal/cubemap.h"
#include "runtime/api_support.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/parallel.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

namespace {

bool is_radiance(const float* values, std::size_t count) {
    return std::all_of(values, values + count,
                       [](float x) { return x >= 0.0f && std::isfinite(x); });
}

// What a light holds once its map or its rotation has changed.
void project_map(opaline_light& light) {
    light.map_integral.assign(std::size_t{3} * formats::cubemap_texels(light.n), 0.0);
    runtime::integrate_map(light.environment, light.n, light.rotation, light.threads,
                           light.map_integral);
}

// What it holds once its map or suns have changed: turning it does not change these maps.
void prefilter(opaline_light& light) {
    light.specular =
        runtime::make_specular_light(light.environment, light.needs, light.rotation, light.threads);
}

// A black one that keeps everything else.
opaline_light without_environment(const opaline_light& light) {
    opaline_light black;
    black.n = light.n;
    black.threads = light.threads;
    black.rotation = light.rotation;
    black.needs = light.needs;
    black.emitters = light.emitters;
    return black;
}

void project(opaline_light& light) {
    std::vector<double> integral = light.map_integral;
    runtime::integrate_discs(light.environment.discs, light.n, light.rotation, integral);
    light.vector = runtime::make_light_vector(integral, light.n);
}

opaline_status set_map(opaline_light* light, const float* rgb, formats::Environment::Layout layout,
                       std::uint32_t width, std::uint32_t height) {
    return guarded([&] {
        const std::size_t pixels = std::size_t{width} * height;
        if (!is_radiance(rgb, 3 * pixels)) {
            return fail(OPALINE_INVALID_ARGUMENT, "radiance must be finite and not negative");
        }
        opaline_light changed = without_environment(*light);
        changed.environment.discs = light->environment.discs;
        changed.environment.layout = layout;
        changed.environment.width = width;
        changed.environment.height = height;
        changed.environment.pixel.reserve(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            changed.environment.pixel.push_back({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
        }
        project_map(changed);
        project(changed);
        prefilter(changed);
        *light = std::move(changed);
        return OPALINE_OK;
    });
}

}  // namespace

extern "C" {

opaline_status opaline_light_create(const opaline_asset* asset, opaline_light** out) {
    if (asset == nullptr || out == nullptr) {
        return null_argument();
    }
    return guarded([&] {
        auto light = std::make_unique<opaline_light>();
        light->n = asset->loaded.view.cubemap_size;
        light->needs = runtime::specular_needs(asset->loaded.view);
        light->emitters.assign(asset->loaded.view.emitters.size(), {1, 1, 1});
        project_map(*light);
        project(*light);
        prefilter(*light);
        *out = light.release();
        return OPALINE_OK;
    });
}

void opaline_light_release(opaline_light* light) {
    delete light;
}

opaline_status opaline_light_set_threads(opaline_light* light, uint32_t threads) {
    if (light == nullptr) {
        return null_argument();
    }
    if (threads > runtime::kMaxThreads) {
        return fail(OPALINE_INVALID_ARGUMENT, "there may be 256 threads at most");
    }
    light->threads = threads;
    return OPALINE_OK;
}

opaline_status opaline_light_set_rotation(opaline_light* light, const float world_from_light[9]) {
    if (light == nullptr || world_from_light == nullptr) {
        return null_argument();
    }
    const float* m = world_from_light;
    const runtime::Rotation rotation{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
    if (!runtime::is_rotation(rotation, 1e-3f)) {
        return fail(OPALINE_INVALID_ARGUMENT,
                    "the matrix is not a rotation: its columns must be orthonormal to 1e-3, its "
                    "determinant +1");
    }
    return guarded([&] {
        opaline_light changed = *light;
        changed.rotation = changed.specular.rotation = rotation;
        project_map(changed);
        project(changed);
        *light = std::move(changed);
        return OPALINE_OK;
    });
}

opaline_status opaline_light_set_cubemap(opaline_light* light, const float* rgb, uint32_t size) {
    if (light == nullptr || rgb == nullptr) {
        return null_argument();
    }
    if (size < 1 || size > 8192) {
        return fail(OPALINE_INVALID_ARGUMENT, "the cube map's size must be 1 ... 8192");
    }
    return set_map(light, rgb, formats::Environment::Layout::cube, size,
                   size * formats::kCubeFaces);
}

opaline_status opaline_light_set_lat_long(opaline_light* light, const float* rgb, uint32_t width,
                                          uint32_t height) {
    if (light == nullptr || rgb == nullptr) {
        return null_argument();
    }
    if (width < 1 || width > 32768 || height < 1 || height > 32768) {
        return fail(OPALINE_INVALID_ARGUMENT, "the map's width and height must be 1 ... 32768");
    }
    return set_map(light, rgb, formats::Environment::Layout::lat_long, width, height);
}

opaline_status opaline_light_add_sun(opaline_light* light, const float direction[3],
                                     float angular_radius, const float radiance[3]) {
    if (light == nullptr || direction == nullptr || radiance == nullptr) {
        return null_argument();
    }
    const auto toward = unit_vector(direction);
    if (!toward) {
        return fail(OPALINE_INVALID_ARGUMENT, "the sun's direction must be finite and not zero");
    }
    // Below 1e-6 rad the squared radius would leave the range in which its solid angle is exact.
    if (!(angular_radius >= 1e-6f && angular_radius < 0.5f * std::numbers::pi_v<float>)) {
        return fail(OPALINE_INVALID_ARGUMENT, "the sun's radius must be in 1e-6 ... pi/2 radians");
    }
    if (!is_radiance(radiance, 3)) {
        return fail(OPALINE_INVALID_ARGUMENT, "radiance must be finite and not negative");
    }
    return guarded([&] {
        opaline_light changed = *light;
        changed.environment.discs.push_back(
            {*toward, angular_radius, {radiance[0], radiance[1], radiance[2]}});
        project(changed);
        prefilter(changed);
        *light = std::move(changed);
        return OPALINE_OK;
    });
}

opaline_status opaline_light_clear(opaline_light* light) {
    if (light == nullptr) {
        return null_argument();
    }
    return guarded([&] {
        opaline_light changed = without_environment(*light);
        project_map(changed);
        project(changed);
        prefilter(changed);
        *light = std::move(changed);
        return OPALINE_OK;
    });
}

}  // extern "C"
