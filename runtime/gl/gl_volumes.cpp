#include "runtime/gl/gl_volumes.h"

#include <array>
#include <string>

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::SparseRows;
using formats::TermSet;
using formats::VolumesView;

void copy(const auto& span, auto& vector) {
    vector.assign(span.begin(), span.end());
}

SparseRows copy_rows(const formats::SparseRowsView& view) {
    SparseRows rows;
    rows.cubemap_size = view.cubemap_size;
    rows.code_bits = view.code_bits;
    rows.index_bytes = view.index_bytes;
    copy(view.row_offset, rows.row_offset);
    copy(view.average_scale, rows.average_scale);
    copy(view.detail_scale, rows.detail_scale);
    copy(view.average_code, rows.average_code);
    copy(view.index16, rows.index16);
    copy(view.index32, rows.index32);
    copy(view.code8, rows.code8);
    copy(view.code16, rows.code16);
    return rows;
}

std::size_t coefficient_bytes(const VolumesView& volumes) {
    return count_coefficients(volumes) * sizeof(formats::Rgb);
}

formats::Status check_limits(const VolumesView& volumes, std::size_t max_block_bytes) {
    const std::string remedy = kRenderOnCpu;
    if (volumes.records.size() > kMaxGlVolumes) {
        return make_error(ErrorKind::resource, {}, "volumes",
                          "found " + std::to_string(volumes.records.size()) +
                              ", OpenGL draws at most " + std::to_string(kMaxGlVolumes),
                          remedy);
    }
    struct Block {
        const char* name;
        std::size_t bytes;
    };
    const std::array<Block, 4> blocks{
        {{"tables of bricks", volumes.table.size_bytes()},
         {"density", volumes.density_scale.size() * kGlBrickWords * sizeof(std::uint32_t)},
         {"corners", volumes.corner.size_bytes()},
         {"light", coefficient_bytes(volumes)}}};
    for (const Block& block : blocks) {
        if (block.bytes > max_block_bytes) {
            return make_error(ErrorKind::resource, {}, "volumes",
                              std::string(block.name) + ": " + std::to_string(block.bytes) +
                                  " bytes, the OpenGL driver shows a shader at most " +
                                  std::to_string(max_block_bytes),
                              remedy);
        }
    }
    return formats::ok_status();
}

TermSet of_volumes(TermSet terms) {
    return terms & (TermSet::volume_single | TermSet::volume_multiple);
}

// Coefficients of the last light.
formats::Status update_coefficients(GlVolumes& volumes, TermSet terms) {
    volumes.lit_terms = of_volumes(terms);
    volumes.light = relight_volumes(
        volumes.kept.view(), volumes.lit_by,
        {.terms = volumes.lit_by.n == 0 ? TermSet::none : volumes.lit_terms,
         .emitters = volumes.lit_by.n == 0 ? dark_emitters()
                                           : EmitterLight{volumes.emitters, volumes.shows_own}});
    const std::size_t bytes = volumes.light.coefficient.size() * sizeof(formats::Rgb);
    if (bytes > volumes.max_block_bytes) {
        return make_error(ErrorKind::resource, {}, "volumes",
                          "their light takes " + std::to_string(bytes) + " bytes with " +
                              std::to_string(volumes.light.sun.size()) +
                              " suns, the OpenGL driver shows a shader at most " +
                              std::to_string(volumes.max_block_bytes),
                          kRenderOnCpu);
    }
    std::size_t size = 0;
    volumes.coefficient =
        make_buffer_of(std::span<const formats::Rgb>(volumes.light.coefficient), size);
    volumes.light.coefficient = {};
    return check_gl("uploading the light of volumes");
}

}  // namespace

formats::Result<GlVolumes> upload_volumes(const VolumesView& volumes, std::size_t max_block_bytes) {
    GlVolumes gl;
    if (volumes.empty()) return gl;
    if (const auto status = check_limits(volumes, max_block_bytes); !status) return status.error();
    gl.max_block_bytes = max_block_bytes;
    copy(volumes.records, gl.kept.records);
    copy(volumes.table, gl.kept.table);
    copy(volumes.density_scale, gl.kept.density_scale);
    copy(volumes.density, gl.kept.density);
    copy(volumes.corner, gl.kept.corner);
    copy(volumes.phase, gl.kept.phase);
    gl.kept.rows = copy_rows(volumes.rows);
    const formats::GlowView& glow = volumes.glow;
    gl.kept.glow = {
        {glow.record.begin(), glow.record.end()}, {}, {}, {glow.value.begin(), glow.value.end()}};
    const std::vector<std::uint32_t> glow_words = pack_glow(volumes);
    if (glow_words.size() * sizeof(std::uint32_t) > max_block_bytes) {
        return make_error(ErrorKind::resource, {}, "volumes",
                          "their own light takes more than the " + std::to_string(max_block_bytes) +
                              " bytes that the OpenGL driver shows a shader",
                          kRenderOnCpu);
    }
    gl.glows = !glow_words.empty();
    if (gl.glows) {
        gl.glow = make_buffer_of(std::span<const std::uint32_t>(glow_words), gl.resident);
    }
    gl.harmonics = most_node_terms(volumes);
    for (std::size_t v = 0; v < gl.kept.records.size(); ++v) {
        const formats::VolumeRecord& record = gl.kept.records[v];
        const auto lattice = make_lattice(volumes, record);
        if (lattice) gl.entry.push_back({{&record, lattice->to_index, {}, {}, {}, {}}, v});
    }
    gl.table = make_buffer_of(volumes.table, gl.resident);
    gl.corner = make_buffer_of(volumes.corner, gl.resident);
    const std::vector<std::uint32_t> words = pack_density(volumes);
    gl.density = make_buffer_of(std::span<const std::uint32_t>(words), gl.resident);
    const std::vector<float> phase = pack_sun_tables(volumes);
    gl.phase = make_buffer_of(std::span<const float>(phase), gl.resident);
    gl.resident += coefficient_bytes(volumes);
    if (const auto status = check_gl("uploading volumes"); !status) return status.error();
    if (const auto status = update_coefficients(gl, TermSet::none); !status) return status.error();
    return gl;
}

formats::Status relight_gl_volumes(GlVolumes& volumes, const LightVector& light, TermSet terms,
                                   const EmitterLight& emitters) {
    if (volumes.empty()) return formats::ok_status();
    volumes.lit_by = light;
    volumes.emitters.assign(emitters.color.begin(), emitters.color.end());
    volumes.shows_own = emitters.shows_own;
    return update_coefficients(volumes, terms);
}

formats::Status show_volume_terms(GlVolumes& volumes, TermSet terms) {
    if (volumes.empty() || volumes.lit_terms == of_volumes(terms)) return formats::ok_status();
    return update_coefficients(volumes, terms);
}

}  // namespace opaline::runtime
