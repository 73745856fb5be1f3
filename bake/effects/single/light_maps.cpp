#include "bake/effects/single/light_maps.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/base/parallel_indices.h"
#include "bake/effects/single/gather_direction.h"
#include "bake/receivers/spatial_order.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// The directions of each texel.
std::vector<std::vector<GatherDirection>> directions_by_texel(const DirectionSet& set) {
    const std::vector<RayPacket::Lane> shares = texel_shares(set);
    std::vector<std::vector<GatherDirection>> texels(set.inverse_solid_angle.size());
    for (std::size_t b = 0; b < set.blocks.size(); ++b) {
        const DirectionBlock& block = set.blocks[b];
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            texels[block.texel[lane]].push_back(
                {{block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]}, shares[b][lane]});
        }
    }
    return texels;
}

// Sub-pixel position of a map, spread evenly over the directions by the plastic number's sequence.
glm::vec2 jitter_of(std::size_t index) {
    const double k = static_cast<double>(index) + 1.0;
    const double x = k * 0.7548776662466927, y = k * 0.5698402909980532;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

std::vector<float> invert(std::vector<float> values) {
    constexpr float kTooSmall = 1e-30f;  // treated as 0: its inverse would overflow
    for (float& value : values) {
        value = value > kTooSmall ? 1.0f / value : 0.0f;
    }
    return values;
}

// `value`: [receiver][term][band].
template <std::size_t kBands>
void pack_texel(std::span<const float> value, std::span<const float> inverse_scale,
                std::span<const float> inverse_term, std::uint16_t* packed) {
    const float* from = value.data();
    for (const float inverse : inverse_scale) {
        for (std::size_t k = 0; k < inverse_term.size(); ++k) {
            const float scale = inverse * inverse_term[k];
            const float lowest = k == 0 ? 0.0f : -1.0f;
            BandValues<kBands> scaled;
            for (float& band : scaled) {
                band = std::clamp(scale * *from++, lowest, 1.0f);
            }
            store_packed<kBands>(pack_values<kBands>(scaled, k > 0), packed);
            packed += packed_words(kBands);
        }
    }
}

}  // namespace

std::uint32_t light_view_size(const BodyMesh& mesh) {
    constexpr float kSmallest = 128, kLargest = 2048;
    const float wanted = mesh.mean_edge > 0 ? 8.0f * mesh.radius / mesh.mean_edge : kSmallest;
    return static_cast<std::uint32_t>(std::clamp(wanted, kSmallest, kLargest));
}

SingleRows gather_single_rows(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                              const DirectionSet& directions, const SingleMedium& medium,
                              std::span<const BodyPoint> given, const Context& context) {
    SingleRows result;
    std::vector<glm::vec3> positions;
    for (const BodyPoint& point : given) {
        positions.push_back(point.position);
    }
    const std::vector<std::uint32_t> order = spatial_order(positions);
    std::vector<BodyPoint> points;
    for (const std::uint32_t index : order) {
        points.push_back(given[index]);
    }
    const NodeList list = collect_nodes(rays, medium, mesh.centre, points, context);
    const auto texels = directions_by_texel(directions);
    const std::size_t terms = medium.phase.count(), stride = medium.bands * terms;
    result.rows.texels = static_cast<std::uint32_t>(texels.size());
    result.rows.bands = medium.bands;
    result.rows.largest_term = largest_phase_terms(medium.phase);
    result.rows.scale = list.scale;
    result.rows.scale.resize(points.size());  // cancelled: there may be fewer
    result.rows.place.resize(points.size());
    for (std::uint32_t r = 0; r < points.size(); ++r) {
        result.rows.place[order[r]] = r;
    }
    const std::vector<float> inverse_scale = invert(list.scale);
    const std::vector<float> inverse_term = invert(result.rows.largest_term);
    result.rows.packed.resize(texels.size());
    const GatherJob job = make_gather_job(rays, mesh, size, medium, list);
    tbb::enumerable_thread_specific<GatherWorkspace> workspaces;
    tbb::task_arena arena(static_cast<int>(thread_count(context)));
    const auto gather_texel = [&](std::size_t j) {
        if (context.cancelled()) return;
        GatherWorkspace& work = workspaces.local();
        work.value.assign(stride * points.size(), 0.0f);
        for (std::size_t i = 0; i < texels[j].size(); ++i) {
            gather_direction(job, texels[j][i], jitter_of(j * texels[j].size() + i), work);
        }
        // Allocated by the thread that fills it; one thread would take seconds to allocate all.
        std::vector<std::uint16_t>& packed = result.rows.packed[j];
        packed.resize(points.size() * terms * packed_words(medium.bands));
        (medium.bands == 1 ? pack_texel<1> : pack_texel<3>)(work.value, inverse_scale, inverse_term,
                                                            packed.data());
    };
    arena.execute([&] { for_each_index(texels.size(), gather_texel); });
    for (const GatherWorkspace& work : workspaces) {
        result.counts.rays += work.counts.rays;
        result.counts.missing += work.counts.missing;
        result.look_ups += work.look_ups;
        result.unsure += work.unsure;
    }
    return result;
}

}  // namespace opaline::bake
