#include "runtime/embed_gl/volume_textures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

#include "runtime/api_support.h"
#include "runtime/parallel.h"
#include "runtime/volumes/sun_phase.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kBrickVoxels;
using formats::kNoBrick;

constexpr std::size_t kSide = kBrickSide + 1;

// Where the i-th of a brick's 9 x 9 x 9 voxels is, x fastest: in it or the brick above along some
// axes, bit a for axis a.
struct PaddedVoxel {
    std::size_t neighbour = 0, offset = 0;
};
PaddedVoxel place_of(std::size_t i) {
    const std::array<std::size_t, 3> at{i % kSide, i / kSide % kSide, i / kSide / kSide};
    PaddedVoxel voxel;
    for (std::size_t a = 3; a-- > 0;) {
        voxel.neighbour |= (at[a] / kBrickSide) << a;
        voxel.offset = voxel.offset * kBrickSide + at[a] % kBrickSide;
    }
    return voxel;
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

// A brick's own light at its 9 x 9 x 9 voxels; empty where it is dark.
std::vector<std::uint32_t> pad_glow(const VolumeGlow& glow, const BrickBlock& block) {
    std::vector<std::uint32_t> words(kSide * kSide * kSide);
    bool is_dark = true;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto [neighbour, offset] = place_of(i);
        const std::uint32_t brick = block.number[neighbour];
        const std::uint32_t place = brick == kNoBrick ? kNoBrick : glow.place[brick];
        if (place == kNoBrick) continue;
        words[i] = glow.code[place * kBrickVoxels + offset];
        is_dark = is_dark && words[i] == 0;
    }
    return is_dark ? std::vector<std::uint32_t>{} : words;
}

// Appends the bricks of one volume to the words of all, and says where they begin.
void append_glow(const VolumeLattice& lattice, const VolumeGlow& glow,
                 std::vector<std::uint32_t>& words) {
    const auto& extent = lattice.record->extent;
    for (std::uint32_t at = 0; at < lattice.table.size(); ++at) {
        if (lattice.table[at] == kNoBrick) continue;
        const BrickBlock block =
            brick_block(lattice, {static_cast<std::int32_t>(at % extent[0]),
                                  static_cast<std::int32_t>(at / extent[0] % extent[1]),
                                  static_cast<std::int32_t>(at / extent[0] / extent[1])});
        const std::vector<std::uint32_t> own = pad_glow(glow, block);
        if (own.empty()) continue;
        words[lattice.record->first_brick_number + lattice.table[at]] =
            static_cast<std::uint32_t>(words.size());
        words.insert(words.end(), own.begin(), own.end());
    }
}

std::uint32_t terms_of(const formats::VolumesView& volumes, std::size_t v) {
    std::uint32_t most =
        std::max(volumes.records[v].single_terms, volumes.records[v].multiple_terms);
    for (const formats::GlowRecord& glow : volumes.glow.of_volume(v)) {
        most = std::max(most, glow.terms);
    }
    return most;
}

// The way from the eye into the table, in shader units. False where floats cannot hold it.
bool set_way(const VolumeLattice& lattice, formats::Vec3 from, double unit, ShaderVolume& volume) {
    const auto eye = index_of_point(lattice, from);
    bool is_finite = true;
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t c = 0; c < 3; ++c) {
            volume.to_bricks[a][c] =
                static_cast<float>(lattice.to_index[4 * a + c] / kBrickSide / unit);
        }
        volume.to_bricks[a][3] =
            static_cast<float>(eye[a] / kBrickSide - lattice.record->first_brick[a]);
        is_finite = is_finite && std::ranges::all_of(volume.to_bricks[a],
                                                     [](float x) { return std::isfinite(x); });
    }
    return is_finite;
}

}  // namespace

std::vector<std::uint32_t> pack_density(const formats::VolumesView& volumes) {
    std::vector<std::uint32_t> words(volumes.density_scale.size() * kGlBrickWords);
    for (const formats::VolumeRecord& record : volumes.records) {
        if (const auto lattice = make_lattice(volumes, record)) pack_bricks(*lattice, words);
    }
    return words;
}

std::vector<std::uint32_t> pack_glow(const formats::VolumesView& volumes) {
    if (volumes.glow.brick.empty()) return {};
    std::vector<std::uint32_t> words(volumes.density_scale.size(), kNoBrick);
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const VolumeGlow own = make_glow(volumes, v);
        const auto lattice = make_lattice(volumes, volumes.records[v]);
        if (lattice && !own.empty()) append_glow(*lattice, own, words);
    }
    return words;
}

std::uint32_t most_node_terms(const formats::VolumesView& volumes) {
    std::uint32_t most = 1;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        most = std::max(most, terms_of(volumes, v));
    }
    return most;
}

std::size_t count_coefficients(const formats::VolumesView& volumes) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const formats::VolumeRecord& record = volumes.records[v];
        const std::span<const float> phase = volumes.phase_of(v);
        VolumeLight::Part part;
        if (needs_suns(record, phase)) {
            part.suns = 1;
            part.sun_terms = make_sun_phase(record, phase).terms;
            part.sun_boxes = sun_boxes(record);
        }
        count += part.suns + record.brick_count * part.brick_stride() +
                 record.node_count * std::size_t{terms_of(volumes, v)};
    }
    return count;
}

ShaderVolume make_shader_volume(const VolumeLattice& lattice, std::size_t volume,
                                const VolumeLight::Part& part, formats::Vec3 eye,
                                double units_per_metre) {
    const formats::VolumeRecord& record = *lattice.record;
    ShaderVolume made;
    if (!set_way(lattice, eye, units_per_metre, made)) return {};
    made.extent_first = {record.extent[0], record.extent[1], record.extent[2],
                         static_cast<std::uint32_t>(record.first_cell)};
    made.numbers = {record.first_brick_number, static_cast<std::uint32_t>(record.first_corner),
                    record.corners_along_edge() - 1, part.terms};
    const auto per_unit = [&](float sigma) {
        return static_cast<float>(std::min(static_cast<double>(sigma) / units_per_metre, 1e30));
    };
    made.extinction = {per_unit(record.sigma_t.r), per_unit(record.sigma_t.g),
                       per_unit(record.sigma_t.b), part.sun_power[1]};
    made.albedo = {record.albedo.r, record.albedo.g, record.albedo.b, part.sun_power[2]};
    made.coefficient = {static_cast<std::uint32_t>(3 * part.first), part.suns,
                        static_cast<std::uint32_t>(kMaxSunTerms * formats::kPhaseEntries * volume),
                        part.sun_terms};
    return made;
}

std::array<float, 4> shader_glow(const formats::GlowView& glow, const VolumeLight& light,
                                 std::size_t volume, double units_per_metre) {
    const formats::GlowRecord* const record = glow.own_of(volume);
    if (record == nullptr) return {};
    const double scale = static_cast<double>(record->code_scale) / units_per_metre;
    const auto channel = [&](float c) {
        return static_cast<float>(std::min(scale * static_cast<double>(c), 1e30));
    };
    const formats::Rgb color = light.glow[volume];
    return {channel(color.r), channel(color.g), channel(color.b), 0};
}

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
