#include "bake/volumes/bake_glow.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/volumes/glow_walks.h"
#include "formats/opal/half.h"

namespace opaline::bake {
namespace {

// A power of two, so that the scale rounds nothing, that brings the largest value to 2^14.
float scale_for(float largest) {
    return largest > 0 ? std::ldexp(1.0f, std::max(std::ilogb(largest) - 14, -126)) : 0;
}

formats::Rgb color_of(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

// The bricks of a volume that glow, in the order of the file's bricks.
void append_bricks(const formats::SparseGrid<glm::vec3>& grid, const NodeLattice& lattice,
                   formats::GlowRecord& record, formats::Glow& glow) {
    float largest = 0;
    for (const glm::vec3& v : grid.value) {
        largest = std::max({largest, v.x, v.y, v.z});
    }
    record.code_scale = scale_for(largest);
    record.first_brick = static_cast<std::uint32_t>(glow.brick.size());
    for (std::uint32_t i = 0; i < lattice.brick.size() && record.code_scale > 0; ++i) {
        const std::uint32_t own = grid.brick_at(lattice.brick[i]);
        if (own == formats::SparseGrid<glm::vec3>::kEmpty) continue;
        glow.brick.push_back(i);
        for (const glm::vec3& v : grid.brick(own)) {
            glow.code.push_back(formats::pack_shared(color_of(v / record.code_scale)));
        }
    }
    record.brick_count = static_cast<std::uint32_t>(glow.brick.size()) - record.first_brick;
}

void append_values(std::span<const glm::vec3> values, std::uint32_t terms,
                   formats::GlowRecord& record, formats::Glow& glow) {
    float largest = 0;
    for (const glm::vec3& v : values) {
        largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    record.value_scale = scale_for(largest);
    record.first_value = glow.value.size();
    record.terms = record.value_scale > 0 ? terms : 0;
    for (std::size_t i = 0; record.terms > 0 && i < values.size(); ++i) {
        for (int band = 0; band < 3; ++band) {
            glow.value.push_back(formats::half_from_float(values[i][band] / record.value_scale));
        }
    }
}

// E_k of a layout's nodes: grid after grid, node after node.
std::vector<std::vector<glm::vec3>> scatter_glow(const VolumeJob& job, const PlacedNodes& nodes,
                                                 const VolumeLayout& layout,
                                                 std::span<const GlowingGrid> grids,
                                                 const Context& context, std::uint64_t& rays) {
    std::vector<std::vector<glm::vec3>> all(grids.size());
    const std::uint32_t terms = layout.glow_terms;
    if (terms == 0) return all;
    const std::size_t count = nodes.lattices[layout.volume].node.size();
    const GlowWalkSpace space{nodes.space, grids, job.rays, job.knobs.seed};
    struct Block {
        std::vector<glm::vec3> values;  // node after node
        std::uint64_t rays = 0;
    };
    const std::size_t of_node = grids.size() * terms;
    for_each_block_in_order(
        count, kNodesAtOnce, context,
        [&](Range range) {
            Block block;
            block.values.resize((range.end - range.begin) * of_node);
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto values =
                    std::span(block.values).subspan((i - range.begin) * of_node, of_node);
                block.rays += gather_glow(
                    space,
                    {layout.volume, nodes.first[layout.volume] + i,
                     position_of(job, nodes, layout.volume, i), layout.glow_walks, terms},
                    values);
                for (glm::vec3& value : values) {
                    value *= nodes.albedo[layout.volume][i];
                }
            }
            return block;
        },
        [&](Range range, Block&& block) {
            for (std::size_t i = 0; i < range.end - range.begin; ++i) {
                for (std::size_t grid = 0; grid < grids.size(); ++grid) {
                    const auto own = block.values.begin() +
                                     static_cast<std::ptrdiff_t>(i * of_node + grid * terms);
                    all[grid].insert(all[grid].end(), own,
                                     own + static_cast<std::ptrdiff_t>(terms));
                }
            }
            rays += block.rays;
            if (context.on_progress) {
                context.on_progress({"light of volumes", range.end, count});
            }
        });
    return all;
}

}  // namespace

formats::Glow bake_glow(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                        std::uint64_t& rays) {
    formats::Glow glow;
    std::vector<std::uint32_t> glowing;
    for (const VolumeLayout& layout : job.layouts) {
        if (layout.glows) {
            glowing.push_back(layout.volume);
        }
    }
    const std::vector<GlowingGrid> grids = make_glowing_grids(job.scene, glowing);
    for (std::size_t i = 0; i < job.layouts.size() && !grids.empty(); ++i) {
        const VolumeLayout& layout = job.layouts[i];
        const auto scattered = scatter_glow(job, nodes, layout, grids, context, rays);
        for (std::size_t grid = 0; grid < grids.size(); ++grid) {
            formats::GlowRecord record;
            record.volume = static_cast<std::uint32_t>(i);
            record.emitter = static_cast<std::uint32_t>(grid);
            record.first_brick = static_cast<std::uint32_t>(glow.brick.size());
            if (grids[grid].volume == layout.volume) {
                append_bricks(*grids[grid].grid, nodes.lattices[layout.volume], record, glow);
            }
            append_values(scattered[grid], layout.glow_terms, record, glow);
            if (record.terms > 0 || record.brick_count > 0) {
                glow.record.push_back(record);
            }
        }
    }
    return context.cancelled() ? formats::Glow{} : glow;
}

}  // namespace opaline::bake
