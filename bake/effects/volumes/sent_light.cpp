#include "bake/effects/volumes/sent_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/effects/volumes/bake_volumes.h"
#include "bake/effects/volumes/scattering_points.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/receivers/receiver.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/detail_codes.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSentCubemap = 8;  // texels along an edge of a face: 11 degrees

using Harmonics = std::array<float, formats::kMaxHarmonics>;

// Sums over nodes in coefficients of the cells, before they become texels.
struct SentSums {
    std::vector<float> once;   // V times the weight of each harmonic in J^(1): k after k, by band
    std::vector<float> often;  // of the rows T_k, by band
};

// Calls visit(coefficient of the cells, value) for the coefficients of a row in one band.
template <class Visit>
void visit_coarse(const SentLight& light, const formats::RowRange& range, std::uint32_t row,
                  std::uint32_t band, Visit&& visit) {
    const formats::SparseRowsView& rows = light.baked.rows;
    const std::uint32_t n = rows.cubemap_size, m = light.cells.n;
    const float finer = static_cast<float>(m) / static_cast<float>(n);
    const std::size_t band_row = std::size_t{range.first_band_row} + row * range.bands + band;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        visit(face * m * m,
              finer * rows.average_scale[band_row] *
                  static_cast<float>(rows.average_code[band_row * formats::kCubeFaces + face]));
    }
    const std::uint32_t first = rows.row_offset[range.first_row];
    const std::uint32_t end = rows.row_offset[range.first_row + row + 1];
    for (std::uint32_t i = rows.row_offset[range.first_row + row]; i < end; ++i) {
        const std::uint16_t to =
            light.coarse[rows.index_bytes == 2 ? rows.index16[i] : rows.index32[i]];
        if (to == SentLight::kFiner) continue;
        const std::size_t at = range.first_code + std::size_t{i - first} * range.bands + band;
        const std::int32_t value = rows.code_bits == 8 ? formats::detail_value(rows.code8[at])
                                                       : formats::detail_value(rows.code16[at]);
        visit(to, finer * rows.detail_scale[band_row] * static_cast<float>(value));
    }
}

// Adds the light that a node scatters to the receiver; `view`: harmonics of the direction to it.
void add_node(const SentLight& light, const formats::VolumeRecord& record, std::uint32_t node,
              const std::array<float, 3>& weight, const Harmonics& view, SentSums& sums) {
    const std::size_t cells = light.cells.size(), bands = light.bands();
    const formats::RowRange range = record.rows();
    const std::uint32_t first = node * record.terms();
    for (std::uint32_t band = 0; band < bands; ++band) {
        const float own = weight[band];
        if (record.single_terms > 0) {
            Harmonics factor{};
            for (std::uint32_t k = 0, l = 0; k < record.single_terms; ++k) {
                l += k >= (l + 1) * (l + 1) ? 1 : 0;
                factor[k] = (l % 2 == 0 ? own : -own) * record.moment[l] * view[k];
            }
            visit_coarse(light, range, first, band, [&](std::size_t at, float value) {
                for (std::uint32_t k = 0; k < record.single_terms; ++k) {
                    sums.once[(k * bands + band) * cells + at] += factor[k] * value;
                }
            });
        }
        for (std::uint32_t k = 0; k < record.multiple_terms; ++k) {
            const float factor = record.multiple_terms == 1 ? own : own * view[k];
            visit_coarse(light, range, first + 1 + k, band, [&](std::size_t at, float value) {
                sums.often[band * cells + at] += factor * value;
            });
        }
    }
}

// One of the nodes around a point, by their weights; none where density rounds to 0.
std::uint32_t choose_node(const NodeLattice& lattice, glm::vec3 index, float u) {
    const NodesAround around = nodes_around(lattice, index);
    std::uint32_t chosen = formats::kNoNode;
    for (std::size_t i = 0; around.found && i < around.node.size(); ++i) {
        if (around.weight[i] > 0) {
            chosen = around.node[i];
            if (u < around.weight[i]) break;
        }
        u -= around.weight[i];
    }
    return chosen;
}

void add_ray(const SentLight& light, glm::vec3 from, glm::vec3 direction, float reach,
             const std::array<float, 4>& random, SentSums& sums) {
    std::vector<ScatteringPoint> points;
    find_scattering_points(light.space, light.sends, from, direction, reach, kPointsOfSentRay,
                           random[2], points);
    if (points.empty()) return;
    float choice = random[3];
    Harmonics view{};
    formats::eval_spherical_harmonics({-direction.x, -direction.y, -direction.z}, view);
    for (const ScatteringPoint& point : points) {
        const DensityVolume& volume = light.space.volumes[point.volume];
        const std::uint32_t node = choose_node(
            light.lattices[point.volume], volume.to_index * point.position + volume.offset, choice);
        if (node != formats::kNoNode) {
            add_node(light, light.baked.records[light.record[point.volume]], node, point.weight,
                     view, sums);
        }
        choice += 1.0f / kPointsOfSentRay;
        choice -= std::floor(choice);
    }
}

// Rays of cells that follow each other, and four numbers for each.
struct SentPacket {
    RayPacket rays;
    std::array<std::array<float, 4>, RayPacket::kSize> random{};

    glm::vec3 direction(std::uint32_t lane) const {
        return {rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]};
    }
};

// Cosine-distributed, from cell `first` on.
SentPacket draw_rays(const SentLight& light, const Receiver& at, std::uint32_t first) {
    SentPacket drawn{rays_from(at.origin), {}};
    const Frame frame = make_frame(at.normal);
    const std::uint64_t key = key_of(at);
    const double width = 1.0 / light.side;
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        const std::uint32_t cell = first + lane;
        const std::uint32_t column = cell % light.side, row = cell / light.side;
        const auto random = drawn.random[lane] =
            random_uniform(light.seed, RandomStage::volume_rays, key, cell);
        const DiskPoint disk = map_to_disk((column + static_cast<double>(random[0])) * width,
                                           (row + static_cast<double>(random[1])) * width);
        const glm::vec2 d(disk.radius * disk.outward);
        const glm::vec3 direction =
            frame.to_world({d.x, d.y, static_cast<float>(std::sqrt(std::max(0.0, 1 - disk.q)))});
        drawn.rays.dir_x[lane] = direction.x;
        drawn.rays.dir_y[lane] = direction.y;
        drawn.rays.dir_z[lane] = direction.z;
        drawn.rays.tfar[lane] = std::numeric_limits<float>::infinity();
    }
    return drawn;
}

// From sums to texels: J^(1) is V times a function of the direction of light.
std::vector<float> finish_sums(const SentLight& light, SentSums sums, float scale) {
    const std::size_t cells = light.cells.size(), bands = light.bands();
    std::vector<float> rows(light.row_size());
    const auto add = [&](std::span<float> part, const float* harmonic, std::size_t band) {
        haar_inverse_cube(part, light.cells.n);
        for (std::size_t i = 0; i < cells; ++i) {
            rows[band * cells + i] += scale * (harmonic != nullptr ? harmonic[i] : 1) * part[i];
        }
    };
    for (std::size_t part = 0; part < sums.once.size() / cells; ++part) {
        add(std::span(sums.once).subspan(part * cells, cells),
            light.harmonic.data() + part / bands * cells, part % bands);
    }
    for (std::size_t band = 0; band < bands; ++band) {
        add(std::span(sums.often).subspan(band * cells, cells), nullptr, band);
    }
    return rows;
}

}  // namespace

std::uint32_t count_sent_light_rays(Quality quality) {
    constexpr std::array<std::uint32_t, 4> kRays{64, 144, 256, 1024};  // whole packets
    return kRays[static_cast<std::size_t>(quality)];
}

SentLight make_sent_light(const formats::Scene& scene, const RayScene& rays,
                          std::span<const VolumeLayout> layouts, const formats::VolumesView& baked,
                          const Knobs& knobs) {
    const std::uint32_t n = knobs.cubemap_size, m = std::min(n, kSentCubemap);
    SentLight light{rays,
                    baked,
                    make_density_space(scene, layouts),
                    std::vector<NodeLattice>(scene.volumes.size()),
                    std::vector<std::uint32_t>(scene.volumes.size(), formats::kNone),
                    std::vector<bool>(scene.volumes.size()),
                    make_light_cells(m),
                    {},
                    std::vector<std::uint16_t>(formats::cubemap_texels(n), SentLight::kFiner),
                    0,
                    knobs.seed};
    light.side = static_cast<std::uint32_t>(
        std::lround(std::sqrt(static_cast<double>(count_sent_light_rays(knobs.quality)))));
    for (std::uint32_t i = 0; i < layouts.size(); ++i) {
        const std::uint32_t v = layouts[i].volume;
        if (!layouts[i].lights_surfaces || baked.records[i].node_count == 0) continue;
        light.lattices[v] = lattice_of(scene.volumes[v], layouts[i]);
        light.record[v] = i;
        light.sends[v] = true;
    }
    const std::size_t cells = light.cells.size();
    light.harmonic.resize(formats::kMaxHarmonics * cells);
    for (std::size_t i = 0; i < cells; ++i) {
        const glm::vec3 w = light.cells.direction(i);
        Harmonics value{};
        formats::eval_spherical_harmonics({w.x, w.y, w.z}, value);
        for (std::size_t k = 0; k < value.size(); ++k) {
            light.harmonic[k * cells + i] = value[k];
        }
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t column = i % m, row = i / m % m, face = i / m / m;
        light.coarse[(face * n + row) * n + column] = static_cast<std::uint16_t>(i);
    }
    return light;
}

SentIrradiance gather_sent_light(const SentLight& light, const Receiver& at) {
    SentIrradiance sent;
    if (at.normal == glm::vec3(0)) {
        sent.rows.resize(light.row_size());
        return sent;
    }
    std::uint32_t harmonics = 0;
    for (const formats::VolumeRecord& record : light.baked.records) {
        harmonics = std::max(harmonics, record.single_terms);
    }
    SentSums sums{std::vector<float>(harmonics * light.row_size()),
                  std::vector<float>(light.row_size())};
    const std::uint32_t count = light.side * light.side;
    std::uint32_t open = 0;
    for (std::uint32_t first = 0; first < count; first += RayPacket::kSize) {
        const SentPacket drawn = draw_rays(light, at, first);
        PacketHits hits{};
        if (!light.rays.is_empty()) {
            LaneMask all;
            all.fill(-1);
            hits = light.rays.closest(all, drawn.rays);
            sent.rays += RayPacket::kSize;
        }
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const bool is_hit = hits.hit[lane] != 0;
            open += is_hit ? 0 : 1;
            add_ray(light, at.origin, drawn.direction(lane),
                    is_hit ? hits.distance[lane] : std::numeric_limits<float>::infinity(),
                    drawn.random[lane], sums);
        }
    }
    sent.open = static_cast<float>(open) / static_cast<float>(count);
    sent.rows =
        finish_sums(light, std::move(sums), std::numbers::pi_v<float> / static_cast<float>(count));
    return sent;
}

}  // namespace opaline::bake
