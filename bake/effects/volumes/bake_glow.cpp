#include "bake/effects/volumes/bake_glow.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/volumes/fit_nodes.h"
#include "bake/effects/volumes/glow_walks.h"
#include "bake/effects/volumes/lamp_walks.h"
#include "bake/effects/volumes/smooth_rows.h"
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

// Of the nodes of one layout: value after value, node after node.
struct ScatteringNodes {
    const VolumeJob& job;
    const PlacedNodes& nodes;
    const VolumeLayout& layout;
    const char* stage;

    glm::vec3 position(std::size_t node) const {
        return position_of(job, nodes, layout.volume, node);
    }
    std::size_t number(std::size_t node) const { return nodes.first[layout.volume] + node; }
};

// E_k of a layout's nodes for each of `sources`: source after source, node after node.
// gather(node, values) returns the rays traced.
template <class Gather>
std::vector<std::vector<glm::vec3>> gather_scattered(const ScatteringNodes& of, std::size_t sources,
                                                     const Context& context, std::uint64_t& rays,
                                                     Gather&& gather) {
    std::vector<std::vector<glm::vec3>> all(sources);
    const std::uint32_t terms = of.layout.glow_terms;
    if (terms == 0) return all;
    const std::size_t count = of.nodes.lattices[of.layout.volume].node.size();
    struct Block {
        std::vector<glm::vec3> values;  // node after node
        std::uint64_t rays = 0;
    };
    const std::size_t of_node = sources * terms;
    for_each_block_in_order(
        count, kNodesAtOnce, context,
        [&](Range range) {
            Block block;
            block.values.resize((range.end - range.begin) * of_node);
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto values =
                    std::span(block.values).subspan((i - range.begin) * of_node, of_node);
                block.rays += gather(i, values);
                for (glm::vec3& value : values) {
                    value *= of.nodes.albedo[of.layout.volume][i];
                }
            }
            return block;
        },
        [&](Range range, Block&& block) {
            for (std::size_t i = 0; i < range.end - range.begin; ++i) {
                for (std::size_t source = 0; source < sources; ++source) {
                    const auto own = block.values.begin() +
                                     static_cast<std::ptrdiff_t>(i * of_node + source * terms);
                    all[source].insert(all[source].end(), own,
                                       own + static_cast<std::ptrdiff_t>(terms));
                }
            }
            rays += block.rays;
            if (context.on_progress) {
                context.on_progress({of.stage, range.end, count});
            }
        });
    return all;
}

std::vector<std::vector<glm::vec3>> scatter_glow(const ScatteringNodes& of,
                                                 std::span<const GlowingGrid> grids,
                                                 const Context& context, std::uint64_t& rays) {
    const GlowWalkSpace space{of.nodes.space, grids, of.job.rays, of.job.knobs.seed};
    return gather_scattered(of, grids.size(), context, rays,
                            [&](std::size_t i, std::span<glm::vec3> values) {
                                return gather_glow(space,
                                                   {of.layout.volume, of.number(i), of.position(i),
                                                    of.layout.glow_walks, of.layout.glow_terms},
                                                   values);
                            });
}

// Light that walks found as means over neighbours, as far as it is less wrong so. `odd`: that of
// every other walk.
void smooth(const ScatteringNodes& of, std::span<const NodePairs> pairs,
            std::span<const glm::vec3> odd, const Context& context,
            std::vector<glm::vec3>& scattered) {
    const std::uint32_t terms = of.layout.glow_terms;
    const std::uint32_t every_other = of.layout.glow_walks / 2;
    const auto walks = static_cast<float>(of.layout.glow_walks),
               odd_walks = static_cast<float>(every_other);
    std::vector<WalkedNode> nodes(scattered.size() / terms);
    for (std::size_t i = 0; i < scattered.size(); ++i) {
        WalkedNode& node = nodes[i / terms];
        for (int band = 0; band < 3; ++band) {
            const float all = scattered[i][band], half = odd[i][band];
            node.rows.push_back(all);
            node.half[0].push_back((walks * all - odd_walks * half) / (walks - odd_walks));
            node.half[1].push_back(half);
        }
    }
    const Smoothing smoothing =
        choose_smoothing(nodes, pairs, of.nodes.density[of.layout.volume], terms, context);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::vector<float> rows = smooth_rows(nodes, pairs, n, smoothing.weights, terms);
        for (std::size_t k = 0; k < terms; ++k) {
            scattered[n * terms + k] = {rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]};
        }
    }
}

std::vector<std::vector<glm::vec3>> scatter_lamps(const ScatteringNodes& of,
                                                  const formats::Scene& surfaces,
                                                  std::span<const LitLamp> lamps,
                                                  const Context& context, std::uint64_t& rays) {
    if (of.layout.glow_terms == 0) return std::vector<std::vector<glm::vec3>>(lamps.size());
    const LampWalkSpace space{of.nodes.space, surfaces, of.job.rays, lamps, of.job.knobs.seed};
    const formats::Volume& volume = of.job.scene.volumes[of.layout.volume];
    const glm::mat3 spacing(static_cast<double>(of.layout.spacing) *
                            glm::dmat3(volume.density.to_scene));
    // Of each lamp what comes straight, then of each the rest, and that of every other walk.
    std::vector<std::vector<glm::vec3>> all = gather_scattered(
        of, 3 * lamps.size(), context, rays, [&](std::size_t i, std::span<glm::vec3> values) {
            const std::size_t part = values.size() / 3;
            return gather_lamps(
                space,
                {of.layout.volume, of.number(i), of.position(i), spacing, of.layout.glow_walks,
                 of.layout.glow_terms},
                {values.first(part), values.subspan(part, part), values.subspan(2 * part)});
        });
    if (context.cancelled()) return std::vector<std::vector<glm::vec3>>(lamps.size());
    std::vector<NodePairs> pairs;
    if (of.job.knobs.quality <= Quality::preview && of.layout.glow_walks > 1) {
        pairs =
            find_node_pairs(of.nodes.lattices[of.layout.volume], of.nodes.density[of.layout.volume],
                            volume.density.to_scene, of.job.rays);
    }
    const auto lines = find_node_lines(of.nodes.lattices[of.layout.volume], volume.density.to_scene,
                                       of.job.rays, rays);
    for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
        fit_tent_means(lines, of.layout.glow_terms, all[lamp]);
        std::vector<glm::vec3>& scattered = all[lamps.size() + lamp];
        if (!pairs.empty()) smooth(of, pairs, all[2 * lamps.size() + lamp], context, scattered);
        std::ranges::transform(all[lamp], scattered, all[lamp].begin(), std::plus<>());
    }
    all.resize(lamps.size());
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
        const auto scattered =
            scatter_glow({job, nodes, layout, "light of volumes"}, grids, context, rays);
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

formats::Glow bake_lamp_glow(const VolumeJob& job, const PlacedNodes& nodes,
                             const LampsOfScene& lit, const Context& context, std::uint64_t& rays) {
    formats::Glow glow;
    std::vector<LitLamp> lamps;
    std::vector<std::uint32_t> number;
    const auto first = static_cast<std::uint32_t>(count_glowing(job.layouts));
    for (std::uint32_t e = 0; e < lit.lamps.size(); ++e) {
        if (lit.lamps[e].volume != formats::kNone) continue;
        lamps.push_back(make_lit_lamp(lit.scene, lit.lamps[e]));
        number.push_back(first + e);
    }
    for (std::size_t i = 0; i < job.layouts.size() && !lamps.empty(); ++i) {
        const VolumeLayout& layout = job.layouts[i];
        const auto scattered =
            scatter_lamps({job, nodes, layout, kLampsInVolumes}, lit.scene, lamps, context, rays);
        for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
            formats::GlowRecord record;
            record.volume = static_cast<std::uint32_t>(i);
            record.emitter = number[lamp];
            append_values(scattered[lamp], layout.glow_terms, record, glow);
            if (record.terms > 0) glow.record.push_back(record);
        }
    }
    return context.cancelled() ? formats::Glow{} : glow;
}

formats::Glow join_glow(const formats::Glow& glow, const formats::Glow& other) {
    struct Source {
        const formats::GlowRecord* record;
        const formats::Glow* of;
    };
    std::vector<Source> sources;
    for (const formats::Glow* of : {&glow, &other}) {
        for (const formats::GlowRecord& record : of->record) {
            sources.push_back({&record, of});
        }
    }
    std::ranges::sort(sources, {}, [](const Source& source) {
        return std::pair(source.record->volume, source.record->emitter);
    });
    formats::Glow joined{.record = {}, .brick = glow.brick, .code = glow.code, .value = {}};
    std::uint32_t first_brick = 0;
    for (const auto& [record, of] : sources) {
        formats::GlowRecord own = *record;
        const auto size = static_cast<std::size_t>(
            record == &of->record.back() ? of->value.size() - record->first_value
                                         : (record + 1)->first_value - record->first_value);
        const auto values = std::span(of->value).subspan(record->first_value, size);
        own.first_value = joined.value.size();
        joined.value.insert(joined.value.end(), values.begin(), values.end());
        own.first_brick = own.brick_count > 0 ? own.first_brick : first_brick;
        first_brick = own.first_brick + own.brick_count;
        joined.record.push_back(own);
    }
    return joined;
}

}  // namespace opaline::bake
