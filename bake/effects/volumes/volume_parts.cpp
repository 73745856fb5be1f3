#include "bake/effects/volumes/volume_parts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "bake/effects/volumes/coarse_volume.h"
#include "bake/effects/volumes/lamp_spacing.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/trace/density/scaled_phase.h"

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// The bricks of a grid that `is_kept` names.
template <class Kept>
Grid keep_bricks(const Grid& grid, Kept&& is_kept) {
    Grid part{grid.first_brick, grid.extent, grid.table, {}, grid.to_scene};
    for (std::uint32_t& number : part.table) {
        if (number == Grid::kEmpty) continue;
        if (!is_kept(number)) {
            number = Grid::kEmpty;
            continue;
        }
        const std::span<const float> values = grid.brick(number);
        number = static_cast<std::uint32_t>(part.brick_count());
        part.value.insert(part.value.end(), values.begin(), values.end());
    }
    return part;
}

struct Part {
    Grid density;
    std::uint32_t spacing = 1;
};

std::size_t count_nodes(const Grid& grid, std::uint32_t spacing) {
    return make_node_lattice(grid, spacing).node.size();
}

// Of a volume that is better whole, none. `own`: the distance that it has then; `by_lamps`: the
// largest ones of bricks, or empty.
std::vector<Part> part_grid(const Grid& grid, std::uint32_t own, double sigma_t, double depth,
                            std::span<const std::uint32_t> by_lamps) {
    std::vector<std::uint32_t> spacing(grid.brick_count(), 0);  // 0: nothing in it
    bool is_closer = false;                                     // by lamps
    for (std::uint32_t b = 0; b < spacing.size(); ++b) {
        const std::span<const float> values = grid.brick(b);
        if (std::ranges::any_of(values, [](float v) { return v > 0; })) {
            spacing[b] = choose_spacing(values, grid.to_scene, sigma_t, depth);
            if (!by_lamps.empty() && by_lamps[b] < spacing[b]) {
                spacing[b] = by_lamps[b];
                is_closer = is_closer || spacing[b] < own;
            }
        }
    }
    std::vector<Part> parts;
    std::size_t nodes = 0;
    for (const std::uint32_t s : {1U, 2U, 4U, 8U}) {
        if (std::ranges::count(spacing, s) > 0) {
            parts.push_back(
                {keep_bricks(grid, [&](std::uint32_t b) { return spacing[b] == s; }), s});
            nodes += count_nodes(parts.back().density, s);
        }
    }
    constexpr double kMostOfClosest = 0.75, kMostOfOwn = 1.5, kMostWithLamps = 4;
    const auto is_within = [&](double share, std::uint32_t whole) {
        return static_cast<double>(nodes) <= share * static_cast<double>(count_nodes(grid, whole));
    };
    if (parts.size() < 2 || !is_within(is_closer ? kMostWithLamps : kMostOfOwn, own) ||
        !is_within(kMostOfClosest, parts.front().spacing)) {
        parts.clear();
    }
    return parts;
}

const VolumeLayout* find_layout(std::span<const VolumeLayout> layouts, std::uint32_t volume) {
    const auto found = std::ranges::find(layouts, volume, &VolumeLayout::volume);
    return found == layouts.end() ? nullptr : &*found;
}

std::vector<Part> part_volume(const formats::Scene& scene, const formats::Volume& volume,
                              const VolumeLayout* layout, const Knobs& knobs) {
    if (layout == nullptr || !layout->has_nodes() || knobs[kVolumeSpacing] > 0 ||
        !volume.emission.empty() || !volume.scattering.empty()) {
        return {};
    }
    const std::array<float, 3> s = scale_medium(volume, scale_phase(volume.phase).peak).sigma_t;
    return part_grid(volume.density, layout->spacing, static_cast<double>(std::ranges::max(s)),
                     spacing_depth(knobs), lamp_spacings(scene, volume.density, knobs));
}

formats::Volume make_part(const formats::Volume& whole, Grid&& density) {
    formats::Volume part;
    part.name = whole.name;
    part.density = std::move(density);
    part.sigma_t = whole.sigma_t;
    part.albedo = whole.albedo;
    part.phase = whole.phase;
    return part;
}

}  // namespace

std::size_t count_nodes_of_parts(const formats::Scene& scene, const formats::Volume& volume,
                                 const VolumeLayout& layout, const Knobs& knobs) {
    const std::vector<Part> parts = part_volume(scene, volume, &layout, knobs);
    if (parts.empty()) return count_nodes(volume.density, layout.spacing);
    std::size_t nodes = 0;
    for (const Part& part : parts) {
        nodes += count_nodes(part.density, part.spacing);
    }
    return nodes;
}

VolumeParts part_volumes(const formats::Scene& scene, std::span<const VolumeLayout> layouts,
                         const Knobs& knobs) {
    constexpr std::size_t kMostDrawn = 4;  // by OpenGL (runtime/gl) and by pages
    std::size_t count = layouts.size();
    std::vector<std::vector<Part>> parts;
    std::vector<std::optional<formats::Volume>> joined(scene.volumes.size());
    for (std::uint32_t v = 0; v < scene.volumes.size(); ++v) {
        const VolumeLayout* const layout = find_layout(layouts, v);
        if (layout != nullptr && layout->joined > 1) {
            joined[v] = join_voxels(scene.volumes[v], static_cast<int>(layout->joined));
        }
        const formats::Volume& volume = joined[v] ? *joined[v] : scene.volumes[v];
        parts.push_back(count < kMostDrawn ? part_volume(scene, volume, layout, knobs)
                                           : std::vector<Part>());
        if (!parts.back().empty() && count + parts.back().size() - 1 > kMostDrawn) {
            parts.back().clear();
        }
        count += parts.back().empty() ? 0 : parts.back().size() - 1;
    }
    if (std::ranges::all_of(parts, &std::vector<Part>::empty) &&
        std::ranges::none_of(joined, &std::optional<formats::Volume>::has_value)) {
        return {std::nullopt, {layouts.begin(), layouts.end()}};
    }
    VolumeParts found;
    formats::Scene& parted = found.scene.emplace();
    parted.origin = scene.origin;
    const auto add = [&](formats::Volume&& volume, const VolumeLayout* layout,
                         std::uint32_t spacing) {
        if (layout != nullptr) {
            found.layouts.push_back(*layout);
            found.layouts.back().volume = static_cast<std::uint32_t>(parted.volumes.size());
            found.layouts.back().spacing = spacing;
        }
        parted.volumes.push_back(std::move(volume));
    };
    // Walks collide in volumes that are not baked, too.
    for (std::uint32_t v = 0; v < scene.volumes.size(); ++v) {
        const VolumeLayout* const layout = find_layout(layouts, v);
        const formats::Volume& volume = joined[v] ? *joined[v] : scene.volumes[v];
        if (parts[v].empty()) {
            add(formats::Volume(volume), layout, layout != nullptr ? layout->spacing : 1);
        }
        for (Part& part : parts[v]) {
            add(make_part(volume, std::move(part.density)), layout, part.spacing);
        }
    }
    return found;
}

}  // namespace opaline::bake
