#include "runtime/embed_gl/gl_asset.h"

#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

void upload_mesh(const formats::AssetView& asset, GlNames& names, opaline_gl_objects& objects) {
    objects.position = names.make_buffer_of(asset.position);
    objects.normal = names.make_buffer_of(asset.normal);
    objects.base_color = names.make_buffer_of(asset.base_color);
    objects.triangle = names.make_buffer_of(asset.index);
    if (!asset.texcoord.empty()) objects.texcoord = names.make_buffer_of(asset.texcoord);
    if (!asset.openness.empty()) objects.openness = names.make_buffer_of(asset.openness);
}

}  // namespace

opaline_status GlAsset::upload(const formats::AssetView& asset, std::uint32_t flags,
                               const RelightOptions& options) {
    objects.struct_size = sizeof(opaline_gl_objects);
    primitives.assign(asset.primitives.begin(), asset.primitives.end());
    opaline_status status = relight.upload(asset, options, names);
    if (status != OPALINE_OK) return status;
    objects.radiance = relight.radiance();
    mirrored.make(asset, names);
    if (specular_needs(asset).gloss) {
        gloss.assign(asset.gloss.begin(), asset.gloss.end());
        glossy.make(names, objects);
    }
    if ((flags & OPALINE_GL_WITH_MESH) != 0) upload_mesh(asset, names, objects);
    if ((flags & OPALINE_GL_WITH_IMAGES) != 0) status = images.make(asset, names);
    if (status == OPALINE_OK && (flags & OPALINE_GL_WITH_VOLUMES) != 0) {
        status = volumes.make(asset.volumes, names);
    }
    return status != OPALINE_OK ? status : check_errors(gl, "uploading the asset");
}

void GlAsset::mirror(const SpecularLight& light) {
    mirrored.turn(light.rotation);
    if (light.id == specular_id) return;
    mirrored.upload(light);
    if (!gloss.empty()) glossy.upload(light.gloss);
    specular_id = light.id;
}

}  // namespace opaline::runtime
