#include "bake/effects/volumes/bake_volumes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/volumes/bake_glow.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/node_rows.h"
#include "bake/effects/volumes/phase_table.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_paths.h"
#include "bake/effects/volumes/volume_walks.h"
#include "bake/encode/share_details.h"
#include "bake/trace/density/density_space.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/result.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::SparseRow;

using Grid = formats::SparseGrid<float>;

// One brick: the nearest of 65535 even steps up to its largest voxel.
void append_brick(const Grid& grid, glm::ivec3 brick, formats::Volumes& volumes) {
    const std::uint32_t number = grid.brick_at(brick);
    if (number == Grid::kEmpty) {
        volumes.density_scale.push_back(0);
        volumes.density.insert(volumes.density.end(), formats::kBrickVoxels, std::uint16_t{0});
        return;
    }
    const std::span<const float> value = grid.brick(number);
    const float most = *std::ranges::max_element(value);
    const float scale = most / 65535;
    volumes.density_scale.push_back(scale);
    for (const float density : value) {
        // The scale of very thin density may round to 0.
        const float code = scale > 0 ? std::min(density / scale, 65535.0f) : 0.0f;
        volumes.density.push_back(static_cast<std::uint16_t>(std::lround(code)));
    }
}

// Appends a volume's bricks and nodes to those of a file, its density in 16 bits a voxel; fills in
// all of the record but what concerns rows. `name`: of the volume, for messages. `world` moves the
// scene's frame to the world. Errors: resource (more than 2^32 - 2 bricks, nodes or corners).
formats::Status pack_density(const formats::SparseGrid<float>& density, const std::string& name,
                             const NodeLattice& lattice, glm::dvec3 world,
                             formats::VolumeRecord& record, formats::Volumes& volumes) {
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
    if (volumes.density_scale.size() + lattice.brick.size() > kMost ||
        volumes.node.size() + lattice.node.size() > kMost) {
        return formats::make_error(formats::ErrorKind::resource, "", name,
                                   "it has more than 2^32 bricks or points of light",
                                   "bake it in parts, or in larger voxels");
    }
    glm::dmat4 to_world = density.to_scene;
    to_world[3] += glm::dvec4(world, 0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            const auto place = 4 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
            record.to_world[place] = static_cast<float>(to_world[column][row]);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        record.first_brick[axis] = lattice.first_brick[static_cast<int>(axis)];
        record.extent[axis] = static_cast<std::uint32_t>(lattice.extent[static_cast<int>(axis)]);
    }
    record.first_brick_number = static_cast<std::uint32_t>(volumes.density_scale.size());
    record.brick_count = static_cast<std::uint32_t>(lattice.brick.size());
    record.first_cell = volumes.table.size();
    record.first_corner = volumes.corner.size();
    record.spacing = lattice.spacing;
    record.first_node = static_cast<std::uint32_t>(volumes.node.size());
    record.node_count = static_cast<std::uint32_t>(lattice.node.size());
    volumes.table.insert(volumes.table.end(), lattice.table.begin(), lattice.table.end());
    volumes.corner.insert(volumes.corner.end(), lattice.corner.begin(), lattice.corner.end());
    for (const glm::ivec3 brick : lattice.brick) {
        append_brick(density, brick, volumes);
    }
    for (const glm::ivec3 voxel : lattice.node) {
        volumes.node.push_back({voxel.x, voxel.y, voxel.z});
    }
    return formats::ok_status();
}

// Both ways to light that was scattered before.
struct Scattered {
    const VolumeWalkSpace& walks;
    const VolumePathSpace& paths;
    const std::vector<WalkedLayout>& walked;
};

// The rows T_k of a node.
std::vector<SparseRow> scatter_node(const VolumeJob& job, const PlacedNodes& nodes,
                                    const Scattered& space, std::size_t number,
                                    std::uint64_t& rays) {
    const NodePlace place = find_place(job, nodes, number);
    const VolumeLayout& layout = *place.layout;
    const std::uint32_t terms = layout.often_terms;
    if (terms == 0) {
        return {};
    }
    const auto bands = static_cast<std::uint32_t>(nodes.space.bands());
    std::vector<float> dense(terms * bands * nodes.coarse.size());
    const WalkReceiver receiver = walk_receiver(job, nodes, number);
    const WalkedLayout& walked = space.walked[number_of(job, layout)];
    if (!walked.nodes.empty()) {
        dense =
            smooth_rows(walked.nodes, walked.pairs, place.node, walked.smoothing.weights, terms);
    } else if (receiver.sees_sky || receiver.sees_surfaces) {
        rays += gather_walks(space.walks, receiver, dense);
    }
    if (layout.method == VolumeMethod::path_integration) {
        std::vector<float> paths(dense.size());
        gather_paths(space.paths, {layout.volume, number, receiver.position, layout.views, terms},
                     paths);
        std::ranges::transform(dense, paths, dense.begin(), std::plus<>());
    }
    scale_rows(nodes.albedo[layout.volume][place.node], bands, nodes.coarse.size(), dense);
    return encode_node_rows(nodes.scattered[number_of(job, layout)], dense, terms, nodes.coarse.n,
                            bands);
}

// The methods of all layouts, those measured that the plan left open.
std::vector<VolumeLayout> decide_methods(const VolumeJob& job, const VolumePathSpace& paths,
                                         VolumeFindings* findings) {
    std::vector<VolumeLayout> layouts(job.layouts.begin(), job.layouts.end());
    for (VolumeLayout& layout : layouts) {
        if (layout.method == VolumeMethod::automatic) {
            const MethodMeasure measure = measure_method(
                paths, job.scene.volumes[layout.volume].density, layout, method_budget(job.knobs));
            layout.method = measure.method;
            if (findings != nullptr) {
                findings->methods.push_back(measure);
            }
        }
    }
    return layouts;
}

// Two pools a layout: V of all nodes, and all T_k.
DetailPools start_pools(const VolumeJob& job, const PlacedNodes& nodes) {
    DetailPools pools;
    for (const VolumeLayout& layout : job.layouts) {
        const NodeCoefficients mean = node_coefficients(job.knobs, layout.often_terms);
        const std::size_t count = nodes.lattices[layout.volume].node.size();
        constexpr std::uint32_t kFaces = formats::kCubeFaces;  // averages, which stay
        pools.most.push_back(count * (mean.attenuated - kFaces));
        pools.most.push_back(count * (mean.scattered - kFaces * layout.often_terms));
    }
    return pools;
}

// The rows of the next node. An error of its light shows by the density that scatters it, and as
// far as eyes see it; some are within the volume.
void add_to_pools(const VolumeJob& job, const PlacedNodes& nodes, std::size_t number,
                  const SparseRow& attenuated, DetailPools& pools) {
    const NodePlace place = find_place(job, nodes, number);
    const auto pool = static_cast<std::uint32_t>(2 * number_of(job, *place.layout));
    constexpr float kLeastSeen = 0.1f;
    const float seen = std::max(mean_visibility(attenuated, job.knobs.cubemap_size), kLeastSeen);
    const float weight = seen * nodes.density[place.layout->volume][place.node];
    pools.pool.push_back(pool);
    pools.weight.push_back(weight);
    for (std::uint32_t k = 0; k < place.layout->often_terms; ++k) {
        pools.pool.push_back(pool + 1);
        pools.weight.push_back(weight);
    }
}

formats::Result<formats::SparseRows> gather_node_rows(const VolumeJob& given,
                                                      const PlacedNodes& nodes, LitNodes lit,
                                                      const SeenLight* seen, const Context& context,
                                                      VolumeFindings* findings,
                                                      std::uint64_t& rays) {
    const VolumeWalkSpace walks{nodes.space, given.rays,   nodes.lattices,   nodes.first,
                                lit.depths,  nodes.coarse, given.knobs.seed, seen};
    const PathCells groups = group_cells(nodes.coarse);
    // Paths support one phase function. With several the plan takes walks.
    const VolumePathSpace paths{walks, groups, nodes.space.volumes.front().phase.moments(),
                                path_lengths(given.knobs.quality)};
    const std::vector<VolumeLayout> layouts = decide_methods(given, paths, findings);
    const VolumeJob job{given.scene, given.rays, layouts, given.knobs, given.surfaces};
    const std::vector<WalkedLayout> walked = walk_nodes(job, nodes, walks, context, rays);
    const Scattered space{walks, paths, walked};
    for (std::size_t i = 0; findings != nullptr && i < walked.size(); ++i) {
        if (!walked[i].nodes.empty()) {
            findings->noise.push_back({layouts[i].whole, walked[i].smoothing.noise});
        }
    }
    const bool smooths = std::ranges::any_of(
        walked, [](const WalkedLayout& layout) { return !layout.nodes.empty(); });
    formats::SparseRows rows =
        formats::make_sparse_rows(job.knobs.cubemap_size, job.knobs.code_bits);
    bool fits = true;
    DetailPools pools = start_pools(job, nodes);
    struct Block {
        std::vector<std::vector<SparseRow>> rows;
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        nodes.count, kNodesAtOnce, context,
        [&](Range range) {
            Block block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.rows.push_back(scatter_node(job, nodes, space, i, block.rays));
            }
            return block;
        },
        [&](Range range, Block&& block) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                add_to_pools(job, nodes, i, lit.row[i], pools);
                fits = fits && formats::append_row(rows, lit.row[i]);
                lit.row[i] = {};
                for (const SparseRow& row : block.rows[i - range.begin]) {
                    fits = fits && formats::append_row(rows, row);
                }
            }
            rays += block.rays;
            if (context.on_progress && !smooths) {
                context.on_progress({scattering_stage(given.layouts), range.end, nodes.count});
            }
        });
    if (!fits) {
        return make_error(ErrorKind::resource, "", "volumes",
                          "more than 2^32 coefficients do not fit into one file",
                          "raise --volume-spacing, or lower --volume-coefficients");
    }
    return share_details(rows, static_cast<std::uint32_t>(nodes.space.bands()),
                         nodes.scattered.front().selector, pools);
}

// Sets the first row of each volume, once all rows are packed.
void number_rows(const VolumeJob& job, const PlacedNodes& nodes, formats::Volumes& volumes) {
    std::uint32_t row = 0, band_row = 0;
    std::uint64_t code = 0;
    for (std::size_t i = 0; i < job.layouts.size(); ++i) {
        formats::VolumeRecord& record = volumes.records[i];
        record.single_terms = job.layouts[i].once_terms;
        record.multiple_terms = job.layouts[i].often_terms;
        record.bands = static_cast<std::uint32_t>(nodes.space.bands());
        record.first_row = row;
        record.first_band_row = band_row;
        record.first_code = code;
        const std::uint32_t count = record.node_count * record.terms();
        code += std::uint64_t{volumes.rows.row_offset[row + count] - volumes.rows.row_offset[row]} *
                record.bands;
        row += count;
        band_row += count * record.bands;
    }
}

formats::Rgb rgb(const std::array<float, 3>& band) {
    return {band[0], band[1], band[2]};
}

}  // namespace

formats::Result<formats::Volumes> bake_volumes(const VolumeJob& job, const Context& context,
                                               StageLog& log, VolumeFindings* findings) {
    formats::Volumes volumes;
    const PlacedNodes nodes = place_nodes(job);
    const double bytes = 2.0 * static_cast<double>(nodes.count) *
                         static_cast<double>(nodes.space.extinction_bands()) *
                         static_cast<double>(nodes.coarse.size());
    if (bytes > kDepthBytes) {
        return make_error(ErrorKind::resource, "", "volumes",
                          "light at " + std::to_string(nodes.count) + " points takes " +
                              std::to_string(static_cast<std::uint64_t>(bytes / 1e9)) +
                              " GB of memory",
                          "raise --volume-spacing, or bake in a lower quality");
    }
    for (const VolumeLayout& layout : job.layouts) {
        formats::VolumeRecord record;
        const DensityVolume& own = nodes.space.volumes[layout.volume];
        record.sigma_t = rgb(own.sigma_t);
        record.albedo = rgb(own.albedo);
        for (std::size_t l = 0; l < record.moment.size(); ++l) {
            record.moment[l] = static_cast<float>(own.phase.lambda[l]);
        }
        if (auto status =
                pack_density(*own.grid, job.scene.volumes[layout.volume].name,
                             nodes.lattices[layout.volume], job.scene.origin, record, volumes);
            !status) {
            return std::move(status).error();
        }
        const std::vector<float> phase =
            tabulate_phase(job.scene.volumes[layout.volume].phase, own.phase.peak);
        volumes.phase.insert(volumes.phase.end(), phase.begin(), phase.end());
        volumes.records.push_back(record);
    }
    LitNodes lit =
        run_stage(log, "light in volumes", "volume-single: rows",
                  [&](std::uint64_t& rays) { return light_nodes(job, nodes, context, rays); });
    std::optional<SeenLight> seen;
    if (job.surfaces != nullptr && sees_surfaces(job.layouts)) {
        seen.emplace(run_stage(log, "surfaces that volumes see", "surface-volume: rows",
                               [&](std::uint64_t&) {
                                   return see_surfaces(*job.surfaces, nodes.space, nodes.coarse,
                                                       nodes.space.bands(), context);
                               }));
    }
    if (context.cancelled()) {
        return formats::Volumes{};
    }
    auto rows = run_stage(
        log, scattering_stage(job.layouts), "volume-multiple: rows", [&](std::uint64_t& rays) {
            return gather_node_rows(job, nodes, std::move(lit), seen ? &*seen : nullptr, context,
                                    findings, rays);
        });
    if (!rows) return std::move(rows).error();
    if (context.cancelled()) {
        return formats::Volumes{};
    }
    volumes.rows = std::move(*rows);
    if (std::ranges::any_of(job.layouts, &VolumeLayout::glows)) {
        volumes.glow =
            run_stage(log, "light of volumes", "emitters: rows",
                      [&](std::uint64_t& rays) { return bake_glow(job, nodes, context, rays); });
        if (context.cancelled()) {
            return formats::Volumes{};
        }
    }
    number_rows(job, nodes, volumes);
    if (formats::find_faulty_row(volumes.rows, static_cast<std::uint32_t>(nodes.space.bands()))) {
        return make_error(ErrorKind::bad_input, "", "volumes",
                          "light in a volume is not a finite number",
                          "look for extreme numbers in its density and its medium");
    }
    return volumes;
}

}  // namespace opaline::bake
