#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "runtime/api_support.h"
#include "runtime/parallel.h"
#include "runtime/shade.h"
#include "runtime/terms.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;

namespace {

// Fixed size: reporting that memory ran out must not need memory.
thread_local char last_error[512] = "";

std::atomic<std::uint64_t> last_asset_id{0};

formats::TermSet terms_of(std::uint32_t flags) {
    const auto keep = [flags](std::uint32_t without, formats::TermSet term) {
        return (flags & without) == 0 ? term : formats::TermSet::none;
    };
    return keep(OPALINE_SHADE_WITHOUT_MULTIPLE, formats::TermSet::multiple) |
           keep(OPALINE_SHADE_WITHOUT_SINGLE, formats::TermSet::single) |
           keep(OPALINE_SHADE_WITHOUT_SPECULAR, formats::TermSet::specular) |
           keep(OPALINE_SHADE_WITHOUT_DIFFUSE, formats::TermSet::diffuse);
}

// Without allocating: shading is called per frame.
bool is_prefiltered_for(const opaline_light& light, const formats::AssetView& asset) {
    const bool has_levels = std::ranges::all_of(asset.roughness, [&](float roughness) {
        return roughness < 0 || std::ranges::binary_search(light.distant.needs().levels,
                                                           runtime::roughness_level(roughness));
    });
    return has_levels && (light.distant.needs().gloss ||
                          std::ranges::none_of(asset.gloss, &formats::GlossRecord::is_glossy));
}

// The asset in these bytes, and its handle.
opaline_status make_asset(std::span<const std::byte> bytes, formats::Checks checks,
                          const formats::Memory& memory, opaline_asset** out) {
    using runtime::api::fail;
    formats::Result<formats::LoadedAsset> loaded = formats::read_opal(bytes, {}, checks, memory);
    if (!loaded) return fail(loaded.error());
    void* const place =
        memory.allocate != nullptr
            ? memory.allocate(memory.user, sizeof(opaline_asset), alignof(opaline_asset))
            : ::operator new(sizeof(opaline_asset), std::nothrow);
    if (place == nullptr) return fail(OPALINE_OUT_OF_MEMORY, "not enough memory");
    *out = new (place) opaline_asset{std::move(*loaded), ++last_asset_id, memory, std::nullopt};
    return OPALINE_OK;
}

}  // namespace

namespace opaline::runtime::api {

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

std::optional<formats::Vec3> unit_vector(const float v[3]) {
    // In double precision, where no length of three floats overflows or vanishes.
    const auto x = static_cast<double>(v[0]), y = static_cast<double>(v[1]),
               z = static_cast<double>(v[2]);
    const double norm = std::hypot(x, y, z);
    if (!(norm > 0) || !std::isfinite(norm)) return std::nullopt;
    return formats::Vec3{static_cast<float>(x / norm), static_cast<float>(y / norm),
                         static_cast<float>(z / norm)};
}

}  // namespace opaline::runtime::api

using namespace opaline::runtime::api;

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
        case OPALINE_BUSY:
            return "busy";
        case OPALINE_GL_NO_CONTEXT:
            return "no OpenGL context";
        case OPALINE_GL_TOO_OLD:
            return "OpenGL too old";
        case OPALINE_GL_WRONG_CONTEXT:
            return "wrong OpenGL context";
        case OPALINE_GL_CONTEXT_LOST:
            return "OpenGL context lost";
        case OPALINE_GL_REFUSED:
            return "refused by OpenGL";
    }
    return "unknown status";
}

const char* opaline_last_error(void) {
    return last_error;
}

void opaline_set_thread_pool(void (*run)(void*, uint32_t, void (*)(void*, uint32_t), void*),
                             void* user) {
    runtime::use_thread_pool({run, user});
}

opaline_status opaline_asset_load(const void* bytes, size_t size, opaline_asset** out) {
    return opaline_asset_load_with(bytes, size, nullptr, out);
}

opaline_status opaline_asset_load_with(const void* bytes, size_t size,
                                       const opaline_load_options* options, opaline_asset** out) {
    if (bytes == nullptr || out == nullptr) return null_argument();
    if (reinterpret_cast<std::uintptr_t>(bytes) % formats::kSectionAlignment != 0) {
        return invalid("the asset's bytes must be aligned to 64 bytes");
    }
    formats::Checks checks = formats::Checks::full;
    formats::Memory memory;
    if (options != nullptr) {
        if (options->struct_size != sizeof(opaline_load_options)) {
            return invalid("struct_size is not one this library knows");
        }
        if ((options->flags & ~std::uint32_t{OPALINE_LOAD_TRUSTED}) != 0) {
            return invalid("unknown flags");
        }
        if ((options->allocate == nullptr) != (options->release == nullptr)) {
            return invalid("an allocator needs both of its functions, or none");
        }
        if ((options->flags & OPALINE_LOAD_TRUSTED) != 0) checks = formats::Checks::sizes;
        memory = {options->allocate, options->release, options->user};
    }
    return guarded([&] {
        return make_asset({static_cast<const std::byte*>(bytes), size}, checks, memory, out);
    });
}

opaline_status opaline_asset_load_path(const char* path, opaline_asset** out) {
    if (path == nullptr || out == nullptr) return null_argument();
    return guarded([&] {
        formats::Result<formats::FileBytes> file = formats::FileBytes::open(path);
        if (!file) return fail(file.error());
        const opaline_status status = make_asset(file->bytes(), formats::Checks::full, {}, out);
        if (status == OPALINE_OK) {
            (*out)->file = std::move(*file);
        }
        return status;
    });
}

void opaline_asset_release(opaline_asset* asset) {
    if (asset == nullptr) return;
    const formats::Memory memory = asset->memory;
    asset->~opaline_asset();
    if (memory.allocate != nullptr) {
        memory.release(memory.user, asset, sizeof(opaline_asset), alignof(opaline_asset));
    } else {
        ::operator delete(asset);
    }
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
    if (const char* const fault = fault_of_output(asset, info)) return invalid(fault);
    if (index >= opaline_asset_primitive_count(asset)) {
        return invalid("there is no primitive of that index");
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
    if (const char* const fault = fault_of_output(asset, shading)) return invalid(fault);
    if (index >= opaline_asset_primitive_count(asset)) {
        return invalid("there is no primitive of that index");
    }
    const formats::PrimitiveRecord& p = asset->loaded.view.primitives[index];
    *shading = {sizeof(opaline_primitive_shading), static_cast<std::uint32_t>(p.shading), p.terms,
                p.eta};
    return OPALINE_OK;
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
    if (asset == nullptr || light == nullptr || (count > 0 && out_rgb == nullptr)) {
        return null_argument();
    }
    const runtime::Reading reading(light->users);
    if (!reading) return busy();
    const formats::AssetView& view = asset->loaded.view;
    if (const char* const fault = fault_of_light(*light, view.cubemap_size, view.emitters.size())) {
        return invalid(fault);
    }
    constexpr std::uint32_t kKnown = OPALINE_SHADE_WITHOUT_BASE_COLOR |
                                     OPALINE_SHADE_WITHOUT_FRESNEL |
                                     OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SINGLE |
                                     OPALINE_SHADE_WITHOUT_SPECULAR |
                                     OPALINE_SHADE_WITHOUT_DIFFUSE | OPALINE_SHADE_WITHOUT_EMISSION;
    if ((flags & ~kKnown) != 0) return invalid("unknown flags");
    if (eye != nullptr && !is_finite(eye, 3)) {
        return invalid("the eye's coordinates must be finite");
    }
    if (first > view.receivers() || count > view.receivers() - first) {
        return invalid("the range goes past the last receiver");
    }
    if (out_count / 3 < count) {
        return fail(OPALINE_BUFFER_TOO_SMALL, "the result needs three floats per receiver");
    }
    runtime::ShadeOptions options;
    options.base_color = (flags & OPALINE_SHADE_WITHOUT_BASE_COLOR) == 0;
    options.fresnel = (flags & OPALINE_SHADE_WITHOUT_FRESNEL) == 0;
    options.terms = terms_of(flags);
    options.emitters = {light->emitters, (flags & OPALINE_SHADE_WITHOUT_EMISSION) == 0};
    if (has_any(options.terms, formats::TermSet::specular) && options.fresnel) {
        if (!is_prefiltered_for(*light, view)) {
            return invalid(
                "the light was made for an asset of other roughnesses: make one for this "
                "asset, or leave out specular reflection");
        }
        options.specular = &light->specular();
    }
    if (runtime::find_merged(view, options.terms) != view.primitives.size()) {
        return invalid(
            "multiple and single scattering share their rows in this asset: show both or "
            "none, or bake it with --separate-terms");
    }
    if (eye != nullptr) {
        options.eye = formats::Vec3{eye[0], eye[1], eye[2]};
    }
    static_assert(sizeof(formats::Rgb) == 3 * sizeof(float));
    runtime::shade_range(view, light->vector(), first,
                         {reinterpret_cast<formats::Rgb*>(out_rgb), count}, options);
    return OPALINE_OK;
}

}  // extern "C"
