#include "runtime/volumes/volume_sample.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

// The brick in which a point lies, counted from the table's lowest corner, and where in it, in
// voxels from its voxel (0, 0, 0).
struct Place {
    std::array<std::int32_t, 3> cell{};
    std::array<float, 3> at{};
};

// Nothing outside the table or where the point is not finite.
std::optional<Place> place_of(const VolumeLattice& lattice, formats::Vec3 point) {
    const std::array<double, 3> index = index_of_point(lattice, point);
    Place place;
    for (std::size_t a = 0; a < 3; ++a) {
        const double brick = index[a] / formats::kBrickSide - lattice.record->first_brick[a];
        const double cell = std::floor(brick);
        if (!(cell >= 0 && cell < lattice.record->extent[a])) return std::nullopt;
        place.cell[a] = static_cast<std::int32_t>(cell);
        place.at[a] = tame(static_cast<float>((brick - cell) * formats::kBrickSide),
                           static_cast<float>(formats::kBrickSide));
    }
    return place;
}

Rgb source_at(const LitVolumes& volumes, const LitVolumes::Entry& entry, std::uint32_t brick,
              const std::array<float, 3>& at, formats::Vec3 to_eye) {
    const SourceWeights weight = source_weights(*volumes.light, entry.volume, to_eye);
    const NodeCell cell = node_cell(entry.lattice, at);
    const auto nodes = nodes_of_cell(entry.lattice, brick, cell.number);
    std::array<Rgb, 8> source{};
    for (std::size_t i = 0; i < 8; ++i) {
        source[i] = eval_node(*volumes.light, entry.volume, nodes[i], weight);
    }
    Rgb sum = mix_nodes(source, cell.weight);
    if (const VolumeLight::Part& part = volumes.light->part[entry.volume]; part.suns > 0) {
        const NodeCell box = box_at(part.sun_boxes, at);
        const auto points = points_of_box(part.sun_boxes, box.number);
        std::array<SunSource, 8> suns{};
        for (std::size_t i = 0; i < 8; ++i) {
            suns[i] = eval_suns(*volumes.light, entry.volume, brick, points[i], weight);
        }
        sum = sum + mix_suns(suns, part.sun_terms, box.weight, kAllThrough);
    }
    return tame(sum, kLargestSource);
}

}  // namespace

VolumeSample sample_volumes(const LitVolumes& volumes, formats::Vec3 point, formats::Vec3 to_eye) {
    VolumeSample sample;
    for (const LitVolumes::Entry& entry : volumes.entry) {
        const auto place = place_of(entry.lattice, point);
        if (!place) continue;
        const BrickBlock block = brick_block(entry.lattice, place->cell);
        if (block.number[0] == formats::kNoBrick) continue;
        const Rgb glow = volumes.light->glow[entry.volume];
        if (glow != Rgb{} && !entry.glow.empty()) {
            sample.scattered = sample.scattered +
                               tame(glow * glow_at(entry.glow, block, place->at), kLargestSource);
        }
        const float density = density_at(entry.lattice, block, place->at);
        if (!(density > 0)) continue;
        const formats::VolumeRecord& record = *entry.lattice.record;
        const Rgb c = tame(density * record.sigma_t, kLargestExtinction);
        const Rgb source = source_at(volumes, entry, block.number[0], place->at, to_eye);
        sample.extinction = sample.extinction + c;
        sample.scattered = sample.scattered + c * record.albedo * source;
    }
    constexpr float kLargest = std::numeric_limits<float>::max();
    return {tame(sample.extinction, kLargest), tame(sample.scattered, kLargest)};
}

}  // namespace opaline::runtime
