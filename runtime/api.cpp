#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>
#include <numbers>
#include <string>
#include <utility>

#include "formats/opal/cubemap.h"
#include "formats/opal/read_opal.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_vector.h"
#include "runtime/opaline.h"
#include "runtime/parallel.h"
#include "runtime/shade.h"
#include "runtime/specular.h"
#include "runtime/terms.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;

struct opaline_asset {
    formats::LoadedAsset loaded;
};

struct opaline_light {
    std::uint32_t n = 0;
    unsigned threads = 1;
    runtime::Rotation rotation;
    formats::Environment environment;
    std::vector<double> map_integral;  // kept, so that a sun does not cost a map
    runtime::LightVector vector;
    std::vector<std::uint32_t> roughness;  // levels that its asset uses
    runtime::SpecularLight specular;
};

namespace {

// Fixed size: reporting that memory ran out must not need memory.
thread_local char last_error[512] = "";

opaline_status fail(opaline_status status, const char* text) {
    std::snprintf(last_error, sizeof last_error, "%s", text);
    return status;
}

opaline_status fail(const formats::Error& error) {
    const formats::Diagnostic& main = error.diagnostics.front();
    std::snprintf(last_error, sizeof last_error, "%s%s%s%s%s%s", main.where.c_str(),
                  main.where.empty() ? "" : ": ", main.fault.c_str(),
                  main.remedy.empty() ? "" : " (", main.remedy.c_str(),
                  main.remedy.empty() ? "" : ")");
    switch (error.kind) {
        case formats::ErrorKind::newer_file:
            return OPALINE_NEWER_FILE;
        case formats::ErrorKind::resource:
            return OPALINE_OUT_OF_MEMORY;
        default:
            return OPALINE_BAD_FILE;
    }
}

// Nothing is thrown across the boundary. All work is done on copies that `work` moves into place at
// its end, so a failure leaves things as they were.
template <class Work>
opaline_status guarded(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::exception&) {  // bad_alloc or length_error: nothing else is thrown here
        return fail(OPALINE_OUT_OF_MEMORY, "not enough memory");
    }
}

opaline_status null_argument() {
    return fail(OPALINE_INVALID_ARGUMENT, "an argument is NULL");
}

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
    light.specular = runtime::prefilter_specular(light.environment, light.roughness, light.rotation,
                                                 light.threads);
}

// A black one that keeps everything else.
opaline_light without_environment(const opaline_light& light) {
    opaline_light black;
    black.n = light.n;
    black.threads = light.threads;
    black.rotation = light.rotation;
    black.roughness = light.roughness;
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

std::uint32_t terms_of(std::uint32_t flags) {
    const auto keep = [flags](std::uint32_t without, std::uint32_t term) {
        return (flags & without) == 0 ? term : 0;
    };
    return keep(OPALINE_SHADE_WITHOUT_MULTIPLE, runtime::kMultipleTerm) |
           keep(OPALINE_SHADE_WITHOUT_SINGLE, runtime::kSingleTerm) |
           keep(OPALINE_SHADE_WITHOUT_SPECULAR, runtime::kSpecularTerm) |
           keep(OPALINE_SHADE_WITHOUT_DIFFUSE, runtime::kDiffuseTerm);
}

// Without allocating: shading is called per frame.
bool is_prefiltered_for(const opaline_light& light, const formats::AssetView& asset) {
    return std::ranges::all_of(asset.roughness, [&](float roughness) {
        return roughness < 0 ||
               std::ranges::binary_search(light.roughness, runtime::roughness_level(roughness));
    });
}

}  // namespace

extern "C" {

uint32_t opaline_version(void) {
    return OPALINE_VERSION;
}

const char* opaline_status_string(opaline_status status) {
    switch (status) {
        case OPALINE_OK:
            return "ok";
        case OPALINE_INVALID_ARGUMENT:
            return "invalid argument";
        case OPALINE_BAD_FILE:
            return "bad file";
        case OPALINE_NEWER_FILE:
            return "file of a newer version";
        case OPALINE_BUFFER_TOO_SMALL:
            return "buffer too small";
        case OPALINE_OUT_OF_MEMORY:
            return "out of memory";
    }
    return "unknown status";
}

const char* opaline_last_error(void) {
    return last_error;
}

opaline_status opaline_asset_load(const void* bytes, size_t size, opaline_asset** out) {
    if (bytes == nullptr || out == nullptr) {
        return null_argument();
    }
    if (reinterpret_cast<std::uintptr_t>(bytes) % formats::kSectionAlignment != 0) {
        return fail(OPALINE_INVALID_ARGUMENT, "the asset's bytes must be aligned to 64 bytes");
    }
    return guarded([&] {
        formats::Result<formats::LoadedAsset> loaded = formats::read_opal(
            {static_cast<const std::byte*>(bytes), size}, {}, formats::Checks::full);
        if (!loaded) {
            return fail(loaded.error());
        }
        *out = new opaline_asset{std::move(*loaded)};
        return OPALINE_OK;
    });
}

void opaline_asset_release(opaline_asset* asset) {
    delete asset;
}

uint32_t opaline_asset_receiver_count(const opaline_asset* asset) {
    return asset == nullptr ? 0 : asset->loaded.view.receivers();
}

uint32_t opaline_asset_cubemap_size(const opaline_asset* asset) {
    return asset == nullptr ? 0 : asset->loaded.view.cubemap_size;
}

uint32_t opaline_asset_primitive_count(const opaline_asset* asset) {
    return asset == nullptr ? 0 : static_cast<std::uint32_t>(asset->loaded.view.primitives.size());
}

opaline_status opaline_asset_primitive(const opaline_asset* asset, uint32_t index,
                                       opaline_primitive_info* info) {
    if (asset == nullptr || info == nullptr) {
        return null_argument();
    }
    if (info->struct_size != sizeof(opaline_primitive_info)) {
        return fail(OPALINE_INVALID_ARGUMENT, "struct_size is not one this library knows");
    }
    if (index >= opaline_asset_primitive_count(asset)) {
        return fail(OPALINE_INVALID_ARGUMENT, "there is no primitive of that index");
    }
    const formats::PrimitiveRecord& p = asset->loaded.view.primitives[index];
    *info = {sizeof(opaline_primitive_info),
             p.node,
             p.mesh,
             p.primitive,
             p.material,
             p.first_vertex,
             p.vertex_count,
             p.bands,
             p.flags & formats::PrimitiveRecord::kDoubleSided};
    return OPALINE_OK;
}

opaline_status opaline_asset_primitive_shading(const opaline_asset* asset, uint32_t index,
                                               opaline_primitive_shading* shading) {
    if (asset == nullptr || shading == nullptr) {
        return null_argument();
    }
    if (shading->struct_size != sizeof(opaline_primitive_shading)) {
        return fail(OPALINE_INVALID_ARGUMENT, "struct_size is not one this library knows");
    }
    if (index >= opaline_asset_primitive_count(asset)) {
        return fail(OPALINE_INVALID_ARGUMENT, "there is no primitive of that index");
    }
    const formats::PrimitiveRecord& p = asset->loaded.view.primitives[index];
    *shading = {sizeof(opaline_primitive_shading), static_cast<std::uint32_t>(p.shading), p.terms,
                p.eta};
    return OPALINE_OK;
}

opaline_status opaline_light_create(const opaline_asset* asset, opaline_light** out) {
    if (asset == nullptr || out == nullptr) {
        return null_argument();
    }
    return guarded([&] {
        auto light = std::make_unique<opaline_light>();
        light->n = asset->loaded.view.cubemap_size;
        light->roughness = runtime::roughness_levels(asset->loaded.view);
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
    // In double precision, where no length of three floats overflows or vanishes.
    const double norm =
        std::hypot(static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                   static_cast<double>(direction[2]));
    if (!(norm > 0) || !std::isfinite(norm)) {
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
        const auto along = [&](int i) {
            return static_cast<float>(static_cast<double>(direction[i]) / norm);
        };
        changed.environment.discs.push_back({{along(0), along(1), along(2)},
                                             angular_radius,
                                             {radiance[0], radiance[1], radiance[2]}});
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

opaline_status opaline_shade(const opaline_asset* asset, const opaline_light* light, uint32_t flags,
                             float* out_rgb, size_t out_count) {
    return opaline_shade_range(asset, light, flags, 0, opaline_asset_receiver_count(asset), out_rgb,
                               out_count);
}

opaline_status opaline_shade_range(const opaline_asset* asset, const opaline_light* light,
                                   uint32_t flags, uint32_t first, uint32_t count, float* out_rgb,
                                   size_t out_count) {
    return opaline_shade_from(asset, light, flags, nullptr, first, count, out_rgb, out_count);
}

opaline_status opaline_shade_from(const opaline_asset* asset, const opaline_light* light,
                                  uint32_t flags, const float eye[3], uint32_t first,
                                  uint32_t count, float* out_rgb, size_t out_count) {
    if (asset == nullptr || light == nullptr || out_rgb == nullptr) {
        return null_argument();
    }
    const formats::AssetView& view = asset->loaded.view;
    if (light->n != view.cubemap_size) {
        return fail(OPALINE_INVALID_ARGUMENT,
                    "the light was made for an asset of another cube map size");
    }
    constexpr std::uint32_t kKnown = OPALINE_SHADE_WITHOUT_BASE_COLOR |
                                     OPALINE_SHADE_WITHOUT_FRESNEL |
                                     OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SINGLE |
                                     OPALINE_SHADE_WITHOUT_SPECULAR | OPALINE_SHADE_WITHOUT_DIFFUSE;
    if ((flags & ~kKnown) != 0) {
        return fail(OPALINE_INVALID_ARGUMENT, "unknown flags");
    }
    if (eye != nullptr &&
        !(std::isfinite(eye[0]) && std::isfinite(eye[1]) && std::isfinite(eye[2]))) {
        return fail(OPALINE_INVALID_ARGUMENT, "the eye's coordinates must be finite");
    }
    if (first > view.receivers() || count > view.receivers() - first) {
        return fail(OPALINE_INVALID_ARGUMENT, "the range goes past the last receiver");
    }
    if (out_count / 3 < count) {
        return fail(OPALINE_BUFFER_TOO_SMALL, "the result needs three floats per receiver");
    }
    runtime::ShadeOptions options;
    options.base_color = (flags & OPALINE_SHADE_WITHOUT_BASE_COLOR) == 0;
    options.fresnel = (flags & OPALINE_SHADE_WITHOUT_FRESNEL) == 0;
    options.terms = terms_of(flags);
    if ((options.terms & runtime::kSpecularTerm) != 0 && options.fresnel) {
        if (!is_prefiltered_for(*light, view)) {
            return fail(OPALINE_INVALID_ARGUMENT,
                        "the light was made for an asset of other roughnesses: make one for this "
                        "asset, or leave out specular reflection");
        }
        options.specular = &light->specular;
    }
    if (runtime::find_merged(view, options.terms) != view.primitives.size()) {
        return fail(OPALINE_INVALID_ARGUMENT,
                    "multiple and single scattering share their rows in this asset: show both or "
                    "none, or bake it with --separate-terms");
    }
    if (eye != nullptr) {
        options.eye = formats::Vec3{eye[0], eye[1], eye[2]};
    }
    static_assert(sizeof(formats::Rgb) == 3 * sizeof(float));
    runtime::shade_range(view, light->vector, first,
                         {reinterpret_cast<formats::Rgb*>(out_rgb), count}, options);
    return OPALINE_OK;
}

}  // extern "C"
