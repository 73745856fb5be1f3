#include <cmath>
#include <memory>
#include <utility>

#include "formats/opal/cubemap.h"
#include "runtime/api_support.h"
#include "runtime/clouds/environment_at.h"
#include "runtime/embed_gl/api_gl_support.h"
#include "runtime/embed_gl/saved_state.h"
#include "runtime/parallel.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

namespace {

using formats::Environment;

opaline_status check_layer_pair(const opaline_asset& asset,
                                const opaline_layer_light& layer_light) {
    return asset.id != layer_light.asset_id
               ? invalid("the layer light was made for another asset: make one for this handle")
               : OPALINE_OK;
}

opaline_status read_map(const opaline_layer_sky& sky, Environment& environment) {
    if (sky.map == nullptr) return OPALINE_OK;
    const bool is_cube = sky.is_cubemap != 0;
    if (sky.is_cubemap > 1 || sky.width < 1 || sky.height < 1 ||
        sky.width > (is_cube ? 8192u : 32768u) || sky.height > 6u * 8192u ||
        (is_cube ? sky.height != formats::kCubeFaces * sky.width : sky.height > 32768u)) {
        return invalid(
            "the map must have 1 ... 32768 pixels a side; a cube map six faces of 1 ... "
            "8192, below each other");
    }
    const std::size_t pixels = std::size_t{sky.width} * sky.height;
    if (!is_radiance(sky.map, 3 * pixels)) {
        return invalid("radiance must be finite and not negative");
    }
    environment.layout = is_cube ? Environment::Layout::cube : Environment::Layout::lat_long;
    environment.width = sky.width;
    environment.height = sky.height;
    const auto* const first = reinterpret_cast<const formats::Rgb*>(sky.map);
    environment.pixel.assign(first, first + pixels);
    return OPALINE_OK;
}

opaline_status read_sky(const opaline_layer_sky& sky, Environment& environment,
                        runtime::Rotation& rotation) {
    if (sky.struct_size != sizeof(opaline_layer_sky)) {
        return invalid("struct_size is not one this library knows");
    }
    if (!std::isfinite(sky.time)) return invalid("the time must be finite");
    if (sky.sun_count > 0 && sky.suns == nullptr) return null_argument();
    for (std::uint32_t i = 0; i < sky.sun_count; ++i) {
        const opaline_layer_sun& sun = sky.suns[i];
        if (const char* const fault =
                fault_of_sun(sun.direction, sun.angular_radius, sun.radiance)) {
            return invalid(fault);
        }
        environment.discs.push_back(sun_of(sun.direction, sun.angular_radius, sun.radiance));
    }
    if (sky.world_from_light != nullptr) {
        const auto turned = rotation_of(sky.world_from_light);
        if (!turned) return OPALINE_INVALID_ARGUMENT;
        rotation = *turned;
    }
    return read_map(sky, environment);
}

}  // namespace

extern "C" {

uint32_t opaline_asset_layer_count(const opaline_asset* asset) {
    return asset == nullptr ? 0
                            : static_cast<std::uint32_t>(asset->loaded.view.clouds.records.size());
}

opaline_status opaline_layer_light_create(const opaline_asset* asset, opaline_layer_light** out) {
    if (asset == nullptr || out == nullptr) return null_argument();
    if (opaline_asset_layer_count(asset) == 0) return invalid("the asset has no cloud layer");
    return guarded([&] {
        auto created = std::make_unique<opaline_layer_light>();
        created->asset_id = asset->id;
        created->light =
            runtime::light_layers(asset->loaded.view.clouds, {}, {}, {.time = 0, .threads = 1});
        *out = created.release();
        return OPALINE_OK;
    });
}

void opaline_layer_light_release(opaline_layer_light* layer_light) {
    delete layer_light;
}

opaline_status opaline_layer_light_update(opaline_layer_light* layer_light,
                                          const opaline_asset* asset, const opaline_layer_sky* sky,
                                          uint32_t threads) {
    if (layer_light == nullptr || asset == nullptr || sky == nullptr) return null_argument();
    const runtime::Writing writing(layer_light->users);
    if (!writing) return busy();
    if (const auto status = check_layer_pair(*asset, *layer_light); status != OPALINE_OK) {
        return status;
    }
    if (threads > runtime::kMaxThreads) return invalid(kTooManyThreads);
    return guarded([&] {
        Environment environment;
        runtime::Rotation rotation;
        if (const auto status = read_sky(*sky, environment, rotation); status != OPALINE_OK) {
            return status;
        }
        layer_light->light = runtime::light_layers(asset->loaded.view.clouds, environment, rotation,
                                                   {.time = sky->time, .threads = threads});
        layer_light->environment = std::move(environment);
        layer_light->rotation = rotation;
        return OPALINE_OK;
    });
}

opaline_status opaline_light_set_from_layer(opaline_light* light, const opaline_asset* asset,
                                            const opaline_layer_light* layer_light,
                                            const float point[3]) {
    if (light == nullptr || asset == nullptr || layer_light == nullptr || point == nullptr) {
        return null_argument();
    }
    const runtime::Writing writing(light->users);
    const runtime::Reading reading(layer_light->users);
    if (!writing || !reading) return busy();
    if (const auto status = check_layer_pair(*asset, *layer_light); status != OPALINE_OK) {
        return status;
    }
    if (!is_finite(point, 3)) return invalid("the point must be finite");
    return guarded([&] {
        const Environment seen = runtime::environment_at(
            {layer_light->light, layer_light->environment, layer_light->rotation},
            {point[0], point[1], point[2]}, {.threads = light->threads});
        runtime::DistantLight lit(light->n, light->distant.needs());
        lit.set_map(seen, light->threads);
        for (const formats::DistantDisc& sun : seen.discs) {
            lit.add_sun(sun, light->threads);
        }
        light->distant = std::move(lit);
        return OPALINE_OK;
    });
}

opaline_status opaline_gl_show_layer(opaline_gl* gl, const opaline_asset* asset,
                                     const opaline_layer_light* layer_light) {
    if (gl == nullptr || asset == nullptr || layer_light == nullptr) return null_argument();
    const runtime::Reading reading(layer_light->users);
    if (!reading) return busy();
    if (const auto status = check_layer_pair(*asset, *layer_light); status != OPALINE_OK) {
        return status;
    }
    if (asset->id != gl->asset_id) return invalid("the handle was made of another asset");
    if (const opaline_status status = check_context(*gl); status != OPALINE_OK) return status;
    return guarded([&] {
        const runtime::SavedState saved(gl->gl);
        const opaline_status status =
            gl->layer.show(layer_light->light, gl->eye.value_or(formats::Vec3{}), gl->names);
        return status != OPALINE_OK ? status
                                    : runtime::check_errors(gl->gl, "uploading a cloud layer");
    });
}

opaline_status opaline_gl_get_layer(const opaline_gl* gl, opaline_gl_layer* layer) {
    if (const char* const fault = fault_of_output(gl, layer)) return invalid(fault);
    *layer = gl->layer.objects();
    layer->struct_size = sizeof(opaline_gl_layer);
    return OPALINE_OK;
}

}  // extern "C"
