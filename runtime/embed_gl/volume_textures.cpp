#include "runtime/embed_gl/volume_textures.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "runtime/api_support.h"
#include "runtime/volumes/suns.h"

namespace opaline::runtime {
namespace {

constexpr std::uint32_t kColumns = 2048;

struct TexelFormat {
    GLint internal = 0;
    GLenum format = 0, type = 0;
    std::size_t bytes = 0;
};
constexpr TexelFormat kWord{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
constexpr TexelFormat kFloat{GL_R32F, GL_RED, GL_FLOAT, 4};
constexpr TexelFormat kColor{GL_RGB32F, GL_RGB, GL_FLOAT, 12};

std::uint32_t rows_of(std::size_t texels) {
    return static_cast<std::uint32_t>(std::max<std::size_t>(1, (texels + kColumns - 1) / kColumns));
}

void set_size(const GlFunctions& gl, const TexelFormat& texel, std::uint32_t rows) {
    gl.TexImage2D(GL_TEXTURE_2D, 0, texel.internal, kColumns, static_cast<GLsizei>(rows), 0,
                  texel.format, texel.type, nullptr);
}

// The first texels of the texture that is bound, row by row.
void fill_texels(const GlFunctions& gl, const TexelFormat& texel,
                 std::span<const std::byte> bytes) {
    const std::size_t texels = bytes.size() / texel.bytes, rows = texels / kColumns;
    const auto fill = [&](std::size_t first, std::size_t width, std::size_t height) {
        if (width * height == 0) return;
        gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first),
                         static_cast<GLsizei>(width), static_cast<GLsizei>(height), texel.format,
                         texel.type, bytes.data() + first * kColumns * texel.bytes);
    };
    fill(0, kColumns, rows);
    fill(rows, texels % kColumns, 1);
}

template <class T>
GLuint make_lines(const GlFunctions& gl, GlNames& names, const TexelFormat& texel,
                  std::span<const T> values) {
    const GLuint name = names.make_table_texture();
    set_size(gl, texel, rows_of(values.size_bytes() / texel.bytes));
    fill_texels(gl, texel, std::as_bytes(values));
    return name;
}

}  // namespace

opaline_status VolumeTextures::check_sizes(const formats::VolumesView& volumes) const {
    char text[160];
    if (volumes.records.size() > kMaxGlVolumes) {
        std::snprintf(text, sizeof text, "%lu volumes: shaders march through %lu at most",
                      static_cast<unsigned long>(volumes.records.size()),
                      static_cast<unsigned long>(kMaxGlVolumes));
        return api::fail(OPALINE_GL_REFUSED, text);
    }
    GLint limit = 0;
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    struct Lines {
        const char* name;
        std::size_t texels;
    };
    for (const Lines& lines : {Lines{"tables of bricks", volumes.table.size()},
                               {"density", volumes.density_scale.size() * kGlBrickWords},
                               {"corners", volumes.corner.size()},
                               {"light of nodes", most_coefficients(volumes)}}) {
        if (rows_of(lines.texels) <= static_cast<std::uint32_t>(std::max(limit, 0))) continue;
        std::snprintf(text, sizeof text,
                      "volumes, %s: %lu texels, more than a texture of the driver has", lines.name,
                      static_cast<unsigned long>(lines.texels));
        return api::fail(OPALINE_GL_REFUSED, text);
    }
    return OPALINE_OK;
}

opaline_status VolumeTextures::make(const formats::VolumesView& volumes, GlNames& names) {
    if (volumes.records.empty()) return OPALINE_OK;
    if (const opaline_status status = check_sizes(volumes); status != OPALINE_OK) return status;
    records_.assign(volumes.records.begin(), volumes.records.end());
    for (std::size_t v = 0; v < records_.size(); ++v) {
        const auto lattice = make_lattice(volumes, records_[v]);
        if (lattice) entry_.push_back({{&records_[v], lattice->to_index, {}, {}, {}, {}}, v});
    }
    const std::vector<std::uint32_t> density = pack_density(volumes);
    const std::vector<float> phase = tame_phases(volumes);
    brick_numbers_ = make_lines(gl_, names, kWord, volumes.table);
    density_codes_ = make_lines(gl_, names, kWord, std::span<const std::uint32_t>(density));
    corner_numbers_ = make_lines(gl_, names, kWord, volumes.corner);
    phase_entries_ = make_lines(gl_, names, kFloat, std::span<const float>(phase));
    node_light_ = names.make_table_texture();
    set_size(gl_, kColor, 1);
    light_rows_ = 1;
    block_ =
        names.make_buffer(records_.size() * sizeof(ShaderVolume) + kMaxSuns * 16, GL_DYNAMIC_DRAW);
    upload(relight_volumes(volumes, {}, {.terms = formats::TermSet::none, .threads = 1}));
    return OPALINE_OK;
}

void VolumeTextures::upload(const VolumeLight& light) {
    if (records_.empty()) return;
    part_ = light.part;
    const std::uint32_t rows = rows_of(light.coefficient.size());
    gl_.BindTexture(GL_TEXTURE_2D, node_light_);
    if (rows != light_rows_) set_size(gl_, kColor, rows);
    light_rows_ = rows;
    fill_texels(gl_, kColor, std::as_bytes(std::span(light.coefficient)));
    std::array<std::array<float, 4>, kMaxSuns> suns{};
    for (std::size_t i = 0; i < light.sun.size(); ++i) {
        suns[i] = {light.sun[i].x, light.sun[i].y, light.sun[i].z, 0};
    }
    fill_buffer(gl_, block_, records_.size() * sizeof(ShaderVolume),
                std::as_bytes(std::span(suns)));
    fill_records();
}

void VolumeTextures::look_from(formats::Vec3 eye) {
    if (records_.empty()) return;
    eye_ = eye;
    fill_records();
}

void VolumeTextures::fill_records() {
    std::vector<ShaderVolume> records(records_.size());  // those without an entry have no cells
    for (const Entry& entry : entry_) {
        records[entry.volume] =
            make_shader_volume(entry.lattice, entry.volume, part_[entry.volume], eye_, 1);
    }
    fill_buffer(gl_, block_, 0, std::as_bytes(std::span(records)));
}

}  // namespace opaline::runtime
