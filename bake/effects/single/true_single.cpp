#include "bake/effects/single/true_single.h"

#include <algorithm>
#include <array>

#include "bake/physics/entry.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCoarse = 8;  // its cells are those of 16 x 16 texels
constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};

// The integrals over the texels of kTruthCubemap, summed over the cells of 2 kCoarse.
std::vector<double> sum_over_cells(std::span<const float> smooth) {
    constexpr std::uint32_t kCells = 2 * kCoarse, kEach = kTruthCubemap / kCells;
    std::vector<double> cells(formats::cubemap_texels(kCells));
    for (std::uint32_t j = 0; j < smooth.size(); ++j) {
        const std::uint32_t column = j % kTruthCubemap, row = j / kTruthCubemap % kTruthCubemap;
        const std::uint32_t face = j / (kTruthCubemap * kTruthCubemap);
        cells[(face * kCells + row / kEach) * kCells + column / kEach] +=
            static_cast<double>(smooth[j]);
    }
    return cells;
}

// Contribution of one node through each lane, per unit of radiance times solid angle.
std::array<double, RayPacket::kSize> trace_node(const SingleQuadrature& q, const RayScene& rays,
                                                const BodyPoint& point, const InteriorNode& node,
                                                const RayPacket& packet, const LaneMask& lanes,
                                                EntryCounts& counts) {
    std::array<std::int32_t, RayPacket::kSize> shells;
    shells.fill(node.shells);
    const PacketEntries entries =
        find_entries(rays, q.medium.material, lanes, packet, shells, counts);
    std::array<double, RayPacket::kSize> light{};
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        if (lanes[lane] == 0 || entries.lit[lane] == 0) continue;
        const Entry<float> entry = enter(entries.cosine[lane], q.medium.boundary);
        const auto length = static_cast<double>(entries.distance[lane] * entry.path_ratio);
        const glm::dvec3 inside = refracted_direction(
            {packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]},
            {entries.normal_x[lane], entries.normal_y[lane], entries.normal_z[lane]},
            static_cast<double>(q.medium.boundary.eta));
        const double cosine = std::clamp(-glm::dot(inside, glm::dvec3(point.normal)), -1.0, 1.0);
        double arrives = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            arrives += kLuminance[c] * static_cast<double>(node.weight[c]) *
                       std::exp(-q.medium.path.sigma_t[c] * length);
        }
        const glm::vec3 way{packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]};
        light[lane] =
            static_cast<double>(entry.throughput) * eval_phase(q.phase, cosine) * arrives *
            let_through(q.suns.between, node.position + entries.distance[lane] * way, way);
    }
    return light;
}

}  // namespace

SingleQuadrature make_single_quadrature(const formats::Scene& scene, std::uint32_t material,
                                        std::uint32_t depth_samples,
                                        std::span<const TestLight> lights,
                                        const DensitySpace* between) {
    constexpr std::uint32_t kRaysPerSun = 4;
    SingleQuadrature q{make_single_medium(scene, material, depth_samples),
                       make_phase_density(scene.materials[material].medium->phase),
                       make_sun_rays(lights, kRaysPerSun, between),
                       make_direction_set(kCoarse),
                       {},
                       lights.size()};
    q.integral.resize(q.directions.blocks.size() * RayPacket::kSize * lights.size());
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const std::vector<double> cells = sum_over_cells(lights[l].smooth);
        std::size_t at = l;
        for (const DirectionBlock& block : q.directions.blocks) {
            for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane, at += lights.size()) {
                q.integral[at] = static_cast<float>(cells[formats::texel_index(
                    2 * kCoarse, {block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]})]);
            }
        }
    }
    return q;
}

Luminance integrate_single(const SingleQuadrature& q, const RayScene& rays, const BodyPoint& point,
                           std::uint64_t& traced) {
    Luminance luminance(q.lights);
    EntryCounts counts;
    LaneMask all;
    all.fill(-1);
    const InwardPath path = trace_inward_path(rays, point, q.medium.path_limit);
    for (const InteriorNode& node : place_interior_nodes(q.medium, point, path)) {
        RayPacket packet = rays_from(node.position);
        for (const SunRays::Packet& sun : q.suns.packets) {
            packet.dir_x = sun.dir_x;
            packet.dir_y = sun.dir_y;
            packet.dir_z = sun.dir_z;
            LaneMask lanes;
            for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                lanes[lane] = sun.flux[lane] > 0 ? -1 : 0;
            }
            const auto light = trace_node(q, rays, point, node, packet, lanes, counts);
            for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                luminance[sun.light[lane]] += light[lane] * static_cast<double>(sun.flux[lane]);
            }
        }
        const float* integral = q.integral.data();
        for (const DirectionBlock& block : q.directions.blocks) {
            packet.dir_x = block.dir_x;
            packet.dir_y = block.dir_y;
            packet.dir_z = block.dir_z;
            const auto light = trace_node(q, rays, point, node, packet, all, counts);
            for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                for (std::size_t l = 0; l < q.lights; ++l) {
                    luminance[l] += light[lane] * static_cast<double>(*integral++);
                }
            }
        }
    }
    traced += counts.rays;
    return luminance;
}

}  // namespace opaline::bake
