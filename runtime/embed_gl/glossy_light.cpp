#include "runtime/embed_gl/glossy_light.h"

#include <vector>

#include "formats/opal/ggx_albedo.h"
#include "runtime/gloss_tables.h"

namespace opaline::runtime {

void GlossyLight::make(GlNames& names) {
    maps_ = names.make_array_texture();
    gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    const std::vector<float> black(std::size_t{4} * 6);
    gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, 1, 1, 6, 0, GL_RGBA, GL_FLOAT, black.data());
    cells_ = names.make_table_texture();
    suns_ = names.make_table_texture();
    albedo_ = names.make_table_texture();
    fill_table(gl_, cells_, 2, std::span(black).first(8));
    fill_table(gl_, suns_, 2, std::span(black).first(8));
    std::vector<float> albedo;
    albedo.reserve(4 * formats::ggx_albedo_table().size());
    for (const formats::GgxAlbedo& entry : formats::ggx_albedo_table()) {
        albedo.insert(albedo.end(), {entry.of_f0, entry.of_f90, 0, 0});
    }
    fill_table(gl_, albedo_, formats::kAlbedoColumns, albedo);
}

void GlossyLight::upload(const GlossLight& light) {
    if (light.map.empty()) return;
    gl_.BindTexture(GL_TEXTURE_2D_ARRAY, maps_);
    std::vector<float> rgba;
    for (std::size_t level = 0; level < light.map.size(); ++level) {
        const formats::Environment& map = light.map[level];
        rgba.clear();
        for (const formats::Rgb pixel : map.pixel) {
            rgba.insert(rgba.end(), {pixel.r, pixel.g, pixel.b, 0});
        }
        const auto n = static_cast<GLsizei>(map.width);
        gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(level), GL_RGBA32F, n, n, 6, 0,
                       GL_RGBA, GL_FLOAT, rgba.data());
    }
    std::vector<float> suns = make_sun_table(light);
    if (suns.empty()) suns.resize(8);  // one that lights nothing
    fill_table(gl_, cells_, 2, make_cell_table(light));
    fill_table(gl_, suns_, 2, suns);
}

}  // namespace opaline::runtime
