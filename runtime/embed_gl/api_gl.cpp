#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>

#include "runtime/api_support.h"
#include "runtime/embed_gl/api_gl_support.h"
#include "runtime/embed_gl/saved_state.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

namespace {

using formats::Vec3;
using runtime::GlFunctions;

constexpr std::uint32_t kTextureWidth = 1024;

std::atomic<std::uint32_t> last_marker{0x9a11e000};

constexpr char kMarkerText[] = R"(
layout(local_size_x = 1) in;
layout(location = 0) uniform uint marker;
layout(std430, binding = 0) writeonly buffer Result { uint result; };
void main() { result = marker; }
)";

opaline_status make_marker(opaline_gl& handle) {
    handle.marker_program =
        handle.names.make_program("the context's mark", "", {{GL_COMPUTE_SHADER, kMarkerText}});
    if (handle.marker_program == 0) return OPALINE_GL_REFUSED;
    handle.marker = ++last_marker;
    handle.gl.ProgramUniform1ui(handle.marker_program, 0, handle.marker);
    return OPALINE_OK;
}

opaline_status make_texture(opaline_gl& handle, std::uint32_t receivers) {
    GLint limit = 0;
    handle.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    const std::uint32_t rows = std::max(1u, (receivers + kTextureWidth - 1) / kTextureWidth);
    if (rows > static_cast<std::uint32_t>(limit)) {
        return fail(OPALINE_GL_REFUSED, "more receivers than a texture of the driver has texels");
    }
    handle.objects.radiance_texture = handle.names.make_texture(kTextureWidth, rows);
    handle.objects.radiance_texture_width = kTextureWidth;
    return OPALINE_OK;
}

// The receivers [first, first + count) of one row of the texture, from the buffer that is bound.
void copy_texels(const GlFunctions& gl, std::uint32_t first, std::uint32_t width,
                 std::uint32_t height) {
    // NOLINTBEGIN(performance-no-int-to-ptr): an offset into the buffer, which GL takes so.
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first / kTextureWidth),
                     static_cast<GLsizei>(width), static_cast<GLsizei>(height), GL_RGBA, GL_FLOAT,
                     reinterpret_cast<const void*>(first * runtime::kRadianceBytes));
    // NOLINTEND(performance-no-int-to-ptr)
}

void refresh_texture(const opaline_gl& handle) {
    if (handle.objects.radiance_texture == 0) return;
    const GlFunctions& gl = handle.gl;
    const std::uint32_t receivers = handle.relight.vertices();
    const std::uint32_t rows = receivers / kTextureWidth, rest = receivers % kTextureWidth;
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, handle.relight.radiance());
    gl.BindTexture(GL_TEXTURE_2D, handle.objects.radiance_texture);
    if (rows > 0) copy_texels(gl, 0, kTextureWidth, rows);
    if (rest > 0) copy_texels(gl, rows * kTextureWidth, rest, 1);
}

void show(opaline_gl& handle) {
    handle.relight.view(handle.eye, formats::TermSet::all);
    refresh_texture(handle);
}

opaline_status upload(opaline_gl& handle, const formats::AssetView& asset, std::uint32_t flags) {
    handle.emitters = asset.emitters.size();
    opaline_status status = make_marker(handle);
    if (status == OPALINE_OK) status = handle.upload(asset, flags, {});
    if (status == OPALINE_OK && (flags & OPALINE_GL_WITH_TEXTURE) != 0) {
        status = make_texture(handle, asset.receivers());
        if (status == OPALINE_OK) refresh_texture(handle);
    }
    return status != OPALINE_OK ? status : runtime::check_errors(handle.gl, "uploading the asset");
}

}  // namespace

extern "C" {

opaline_status opaline_gl_create(const opaline_asset* asset, opaline_gl_loader loader,
                                 uint32_t flags, opaline_gl** out) {
    if (asset == nullptr || out == nullptr) return null_argument();
    constexpr std::uint32_t kKnown = OPALINE_GL_WITH_MESH | OPALINE_GL_WITH_TEXTURE |
                                     OPALINE_GL_WITH_VOLUMES | OPALINE_GL_WITH_IMAGES;
    if ((flags & ~kKnown) != 0) return invalid("unknown flags");
    return guarded([&] {
        auto handle = std::make_unique<opaline_gl>();
        handle->asset_id = asset->id;
        const opaline_status loaded = runtime::load_gl_functions(loader, handle->gl);
        if (loaded != OPALINE_OK) return loaded;
        if (handle->gl.GetGraphicsResetStatus != nullptr &&
            handle->gl.GetGraphicsResetStatus() != GL_NO_ERROR) {
            return lost_context();
        }
        runtime::drop_errors(handle->gl);
        const runtime::SavedState saved(handle->gl);
        const opaline_status status = upload(*handle, asset->loaded.view, flags);
        if (status != OPALINE_OK) {
            handle->names.release();
            runtime::drop_errors(handle->gl);
            return status;
        }
        *out = handle.release();
        return OPALINE_OK;
    });
}

opaline_status opaline_gl_release(opaline_gl* gl) {
    if (gl == nullptr) return OPALINE_OK;
    const std::unique_ptr<opaline_gl> handle(gl);
    const opaline_status status = check_context(*handle);
    if (status == OPALINE_OK) {
        handle->names.release();
    }
    return status;
}

opaline_status opaline_gl_relight(opaline_gl* gl, const opaline_light* light) {
    if (gl == nullptr || light == nullptr) return null_argument();
    const runtime::Reading reading(light->users);
    if (!reading) return busy();
    if (const char* const fault =
            fault_of_light(*light, gl->relight.cubemap_size(), gl->emitters)) {
        return invalid(fault);
    }
    const opaline_status status = check_context(*gl);
    if (status != OPALINE_OK) return status;
    return guarded([&] {
        const runtime::SavedState saved(gl->gl);
        gl->relight.light(light->vector(), gl->names);
        gl->relight.dot({light->emitters, false});
        gl->mirror(light->specular());
        gl->images.relight(light->vector(), gl->primitives);
        gl->is_relit = true;
        show(*gl);
        return runtime::check_errors(gl->gl, "relighting");
    });
}

opaline_status opaline_gl_look_from(opaline_gl* gl, const float eye[3]) {
    if (gl == nullptr) return null_argument();
    if (eye != nullptr && !is_finite(eye, 3)) {
        return invalid("the eye's coordinates must be finite");
    }
    const opaline_status status = check_context(*gl);
    if (status != OPALINE_OK) return status;
    gl->eye = eye == nullptr ? std::nullopt : std::optional(Vec3{eye[0], eye[1], eye[2]});
    const bool are_receivers_seen = gl->is_relit && gl->relight.needs_eye();
    if (!are_receivers_seen && gl->volumes.size() == 0 && !gl->layer.is_shown()) return OPALINE_OK;
    const runtime::SavedState saved(gl->gl);
    gl->volumes.look_from(gl->eye.value_or(Vec3{}));
    gl->layer.look_from(gl->eye.value_or(Vec3{}));
    if (are_receivers_seen) show(*gl);
    return runtime::check_errors(gl->gl, "adding up view terms");
}

opaline_status opaline_gl_get_objects(const opaline_gl* gl, opaline_gl_objects* objects) {
    if (const char* const fault = fault_of_output(gl, objects)) return invalid(fault);
    *objects = gl->objects;
    return OPALINE_OK;
}

opaline_status opaline_gl_get_surface(const opaline_gl* gl, uint32_t primitive,
                                      opaline_gl_surface* surface) {
    if (const char* const fault = fault_of_output(gl, surface)) return invalid(fault);
    if (primitive >= gl->primitives.size()) return invalid("there is no primitive of that index");
    const formats::PrimitiveRecord& record = gl->primitives[primitive];
    const runtime::MirroredLight::Lobe lobe = gl->mirrored.lobe_of(primitive);
    const runtime::Rotation& r = gl->mirrored.rotation();
    *surface = {sizeof(opaline_gl_surface),
                record.first_index,
                record.index_count,
                lobe.texture,
                {lobe.cosine, lobe.sine},
                {r.x.x, r.y.x, r.z.x, r.x.y, r.y.y, r.z.y, r.x.z, r.y.z, r.z.z},
                0,
                {},
                {}};
    if (!gl->gloss.empty() && gl->gloss[primitive].is_glossy()) {
        const formats::GlossRecord& gloss = gl->gloss[primitive];
        surface->is_glossy = 1;
        const float f[4] = {gloss.f0.r, gloss.f0.g, gloss.f0.b, gloss.f90};
        std::copy(f, f + 4, surface->f0_f90);
        surface->factors[0] = gloss.metallic;
        surface->factors[1] = gloss.roughness;
    }
    return OPALINE_OK;
}

opaline_status opaline_gl_get_images(const opaline_gl* gl, uint32_t primitive,
                                     opaline_gl_images* images) {
    if (const char* const fault = fault_of_output(gl, images)) return invalid(fault);
    if (primitive >= gl->primitives.size()) return invalid("there is no primitive of that index");
    *images = gl->images.of(primitive);
    images->struct_size = sizeof(opaline_gl_images);
    return OPALINE_OK;
}

opaline_status opaline_gl_get_normal_map(const opaline_gl* gl, uint32_t primitive,
                                         opaline_gl_normal_map* map) {
    if (const char* const fault = fault_of_output(gl, map)) return invalid(fault);
    if (primitive >= gl->primitives.size()) return invalid("there is no primitive of that index");
    *map = gl->images.normal_map_of(primitive);
    map->struct_size = sizeof(opaline_gl_normal_map);
    return OPALINE_OK;
}

}  // extern "C"
