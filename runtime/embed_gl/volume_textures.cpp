#include "runtime/embed_gl/volume_textures.h"

#include <cstdio>

#include "runtime/api_support.h"
#include "runtime/volumes/suns.h"

namespace opaline::runtime {
opaline_status VolumeTextures::check_sizes(const formats::VolumesView& volumes) const {
    char text[160];
    if (volumes.records.size() > kMaxGlVolumes) {
        std::snprintf(text, sizeof text, "%lu volumes: shaders march through %lu at most",
                      static_cast<unsigned long>(volumes.records.size()),
                      static_cast<unsigned long>(kMaxGlVolumes));
        return api::fail(OPALINE_GL_REFUSED, text);
    }
    struct Lines {
        const char* name;
        std::size_t texels;
    };
    for (const Lines& lines : {Lines{"tables of bricks", volumes.table.size()},
                               {"density", volumes.density_scale.size() * kGlBrickWords},
                               {"corners of volumes", volumes.corner.size()},
                               {"light of volumes", count_coefficients(volumes)}}) {
        const opaline_status status = check_lines(gl_, lines.name, lines.texels);
        if (status != OPALINE_OK) return status;
    }
    return OPALINE_OK;
}

opaline_status VolumeTextures::make(const formats::VolumesView& volumes, GlNames& names) {
    if (volumes.records.empty()) return OPALINE_OK;
    if (const opaline_status status = check_sizes(volumes); status != OPALINE_OK) return status;
    const std::vector<std::uint32_t> glow_words = pack_glow(volumes);
    if (const opaline_status status = check_lines(gl_, "own light of volumes", glow_words.size());
        status != OPALINE_OK) {
        return status;
    }
    records_.assign(volumes.records.begin(), volumes.records.end());
    glow_.assign(volumes.glow.record.begin(), volumes.glow.record.end());
    for (std::size_t v = 0; v < records_.size(); ++v) {
        const auto lattice = make_lattice(volumes, records_[v]);
        if (lattice) entry_.push_back({{&records_[v], lattice->to_index, {}, {}, {}, {}}, v});
    }
    for (TexelLines* lines :
         {&brick_numbers_, &density_codes_, &corner_numbers_, &node_light_, &phase_entries_}) {
        lines->make(names);
    }
    brick_numbers_.fill_of(volumes.table);
    density_codes_.fill_of(std::span<const std::uint32_t>(pack_density(volumes)));
    corner_numbers_.fill_of(volumes.corner);
    phase_entries_.fill_of(std::span<const float>(pack_sun_tables(volumes)));
    if (!glow_words.empty()) {
        glow_words_.make(names);
        glow_words_.fill_of(std::span(glow_words));
    }
    const GLuint block = names.make_buffer(
        records_.size() * (sizeof(ShaderVolume) + sizeof(std::array<float, 4>)) + kMaxSuns * 16,
        GL_DYNAMIC_DRAW);
    objects_ = {sizeof objects_,          static_cast<std::uint32_t>(records_.size()),
                most_node_terms(volumes), block,
                brick_numbers_.name(),    density_codes_.name(),
                corner_numbers_.name(),   node_light_.name(),
                phase_entries_.name(),    glow_words.empty() ? 0u : 1u,
                glow_words_.name()};
    return upload(relight_volumes(
        volumes, {}, {.terms = formats::TermSet::none, .emitters = dark_emitters(), .threads = 1}));
}

opaline_status VolumeTextures::upload(const VolumeLight& light) {
    if (records_.empty()) return OPALINE_OK;
    if (const opaline_status status =
            check_lines(gl_, "light of volumes", light.coefficient.size());
        status != OPALINE_OK) {
        return status;
    }
    light_.part = light.part;
    light_.glow = light.glow;
    node_light_.fill_of(std::span(light.coefficient));
    std::array<std::array<float, 4>, kMaxSuns> suns{};
    for (std::size_t i = 0; i < light.sun.size(); ++i) {
        suns[i] = {light.sun[i].x, light.sun[i].y, light.sun[i].z, 0};
    }
    fill_buffer(gl_, objects_.block, records_.size() * sizeof(ShaderVolume),
                std::as_bytes(std::span(suns)));
    fill_records();
    return OPALINE_OK;
}

void VolumeTextures::look_from(formats::Vec3 eye, double units_per_metre) {
    if (records_.empty()) return;
    eye_ = eye;
    units_per_metre_ = units_per_metre;
    fill_records();
}

void VolumeTextures::fill_records() {
    std::vector<ShaderVolume> records(records_.size());  // those without an entry have no cells
    for (const Entry& entry : entry_) {
        records[entry.volume] = make_shader_volume(
            entry.lattice, entry.volume, light_.part[entry.volume], eye_, units_per_metre_);
    }
    fill_buffer(gl_, objects_.block, 0, std::as_bytes(std::span(records)));
    std::vector<std::array<float, 4>> glow_colors;
    glow_colors.reserve(records_.size());
    for (std::size_t v = 0; v < records_.size(); ++v) {
        glow_colors.push_back(shader_glow({glow_, {}, {}, {}}, light_, v, units_per_metre_));
    }
    fill_buffer(gl_, objects_.block, records_.size() * sizeof(ShaderVolume) + kMaxSuns * 16,
                std::as_bytes(std::span(glow_colors)));
}

}  // namespace opaline::runtime
