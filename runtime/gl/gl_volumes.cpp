#include "runtime/gl/gl_volumes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "runtime/parallel.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::kBrickSide;
using formats::kBrickVoxels;
using formats::kNoBrick;
using formats::make_error;
using formats::SparseRows;
using formats::TermSet;
using formats::VolumesView;

constexpr std::size_t kSide = kBrickSide + 1;

// The density at a brick's 9 x 9 x 9 voxels, x fastest.
using PaddedBrick = std::array<float, kSide * kSide * kSide>;

PaddedBrick pad_brick(const VolumeLattice& lattice, std::array<std::int32_t, 3> cell) {
    const BrickBlock block = brick_block(lattice, cell);
    PaddedBrick value{};
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::array<std::size_t, 3> at{i % kSide, i / kSide % kSide, i / kSide / kSide};
        std::size_t neighbour = 0, offset = 0;
        for (std::size_t a = 3; a-- > 0;) {
            neighbour |= (at[a] / kBrickSide) << a;
            offset = offset * kBrickSide + at[a] % kBrickSide;
        }
        const std::uint32_t brick = block.number[neighbour];
        if (brick == kNoBrick) continue;
        value[i] = lattice.density_scale[brick] *
                   static_cast<float>(lattice.density[brick * kBrickVoxels + offset]);
    }
    return value;
}

// Keeps the brick's own codes unless a neighbour's density needs a larger scale.
void pack_brick(const PaddedBrick& value, float own_scale, std::span<std::uint32_t> words) {
    constexpr float kLargestCode = 65535;
    const float full =
        std::min(std::max(own_scale * kLargestCode, *std::ranges::max_element(value)),
                 std::numeric_limits<float>::max());
    const auto code = [&](std::size_t i) {
        const float share = value[i] / full;  // NaN of damaged values becomes 0
        return static_cast<std::uint32_t>(
            std::lround(share > 0 ? std::min(share, 1.0f) * kLargestCode : 0.0f));
    };
    words[0] = std::bit_cast<std::uint32_t>(full);
    for (std::size_t row = 0; row < kSide * kSide; ++row) {
        for (std::size_t x = 0; x < kBrickSide; ++x) {
            const std::size_t i = row * kSide + x;
            words[1 + row * kBrickSide + x] = code(i) | code(i + 1) << 16;
        }
    }
}

// Writes the bricks of one volume to their places among those of all.
void pack_bricks(const VolumeLattice& lattice, std::span<std::uint32_t> words) {
    const auto& extent = lattice.record->extent;
    const auto cells = static_cast<std::uint32_t>(lattice.table.size());
    for_ranges(cells, 64, 0, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t at = first; at < end; ++at) {
            const std::uint32_t brick = lattice.table[at];
            if (brick == kNoBrick) continue;
            const std::array<std::int32_t, 3> cell{
                static_cast<std::int32_t>(at % extent[0]),
                static_cast<std::int32_t>(at / extent[0] % extent[1]),
                static_cast<std::int32_t>(at / extent[0] / extent[1])};
            const std::size_t number = std::size_t{lattice.record->first_brick_number} + brick;
            pack_brick(pad_brick(lattice, cell), lattice.density_scale[brick],
                       words.subspan(number * kGlBrickWords, kGlBrickWords));
        }
    });
}

SparseRows copy_rows(const formats::SparseRowsView& view) {
    const auto copy = [](const auto& span, auto& vector) {
        vector.assign(span.begin(), span.end());
    };
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

std::uint32_t most_terms(const formats::VolumeRecord& record) {
    return std::max(record.single_terms, record.multiple_terms);
}

std::size_t coefficient_bytes(const VolumesView& volumes) {
    std::size_t size = 0;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const formats::VolumeRecord& record = volumes.records[v];
        const std::size_t suns = needs_suns(record, volumes.phase_of(v)) ? kMaxSuns : 0;
        size += record.node_count * (most_terms(record) + suns) * sizeof(formats::Rgb);
    }
    return size;
}

formats::Status check_limits(const VolumesView& volumes, std::size_t max_block_bytes) {
    const std::string remedy = "render on the CPU";
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
         {"light of nodes", coefficient_bytes(volumes)}}};
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
    volumes.light =
        relight_volumes(volumes.kept.view(), volumes.lit_by,
                        {.terms = volumes.lit_by.n == 0 ? TermSet::none : volumes.lit_terms});
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
    gl.kept.records.assign(volumes.records.begin(), volumes.records.end());
    gl.kept.phase.assign(volumes.phase.begin(), volumes.phase.end());
    gl.kept.rows = copy_rows(volumes.rows);
    std::vector<std::uint32_t> words(volumes.density_scale.size() * kGlBrickWords);
    for (std::size_t v = 0; v < gl.kept.records.size(); ++v) {
        const formats::VolumeRecord& record = gl.kept.records[v];
        gl.harmonics = std::max(gl.harmonics, most_terms(record));
        auto lattice = make_lattice(volumes, record);
        if (!lattice) continue;
        pack_bricks(*lattice, words);
        gl.entry.push_back({{&record, lattice->to_index, {}, {}, {}, {}}, v});
    }
    gl.table = make_buffer_of(volumes.table, gl.resident);
    gl.corner = make_buffer_of(volumes.corner, gl.resident);
    gl.density = make_buffer_of(std::span<const std::uint32_t>(words), gl.resident);
    // A damaged file may hold NaN, which not all drivers handle.
    std::vector<float> phase;
    std::ranges::transform(volumes.phase, std::back_inserter(phase),
                           [](float p) { return tame(p, kLargestSource); });
    gl.phase = make_buffer_of(std::span<const float>(phase), gl.resident);
    gl.resident += coefficient_bytes(volumes);
    if (const auto status = check_gl("uploading volumes"); !status) return status.error();
    if (const auto status = update_coefficients(gl, TermSet::none); !status) {
        return status.error();
    }
    return gl;
}

formats::Status relight_gl_volumes(GlVolumes& volumes, const LightVector& light, TermSet terms) {
    if (volumes.empty()) return formats::ok_status();
    volumes.lit_by = light;
    return update_coefficients(volumes, terms);
}

formats::Status show_volume_terms(GlVolumes& volumes, TermSet terms) {
    if (volumes.empty() || volumes.lit_terms == of_volumes(terms)) return formats::ok_status();
    return update_coefficients(volumes, terms);
}

}  // namespace opaline::runtime
