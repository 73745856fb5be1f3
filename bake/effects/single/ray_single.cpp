#include "bake/effects/single/ray_single.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr float kIsotropic = 0.25f * std::numbers::inv_pi_v<float>;

// If the mean free path is shorter than the resolution of coordinates, distances to the boundary
// are noise. At that scale every body is a half space, whose single scattering depends on the
// albedo only. So a thinner medium of the same albedo, band by band, gives the same result.
formats::Medium thin_to_resolution(formats::Medium medium, double diagonal) {
    constexpr double kLeastPath = 1e-4;  // share of the body's size; ray offsets are 2e-6 of it
    const auto thin = [&](float& sigma_s, float& sigma_a) {
        const double paths = kLeastPath * diagonal * (double{sigma_s} + double{sigma_a});
        if (paths > 1) {
            sigma_s = static_cast<float>(double{sigma_s} / paths);
            sigma_a = static_cast<float>(double{sigma_a} / paths);
        }
    };
    thin(medium.sigma_s.r, medium.sigma_a.r);
    thin(medium.sigma_s.g, medium.sigma_a.g);
    thin(medium.sigma_s.b, medium.sigma_a.b);
    return medium;
}

}  // namespace

std::vector<float> largest_phase_terms(const PhaseTerms& phase) {
    if (phase.lambda.size() == 1) {
        return {kIsotropic};
    }
    constexpr float kRounding = 1.000001f;
    std::vector<float> largest;
    for (std::size_t l = 0; l < phase.lambda.size(); ++l) {
        // The squares of a degree's harmonics sum to (2 l + 1) / (4 pi) in every direction.
        const float orders = static_cast<float>(2 * l + 1);
        largest.insert(largest.end(), 2 * l + 1,
                       kRounding * std::abs(phase.lambda[l]) * std::sqrt(kIsotropic * orders));
    }
    return largest;
}

void eval_phase_terms(const PhaseTerms& phase, float eta, glm::vec3 w, glm::vec3 normal,
                      const Entry<float>& entry, float cosine, std::span<float> value) {
    if (value.size() == 1) {
        value[0] = kIsotropic;
        return;
    }
    const glm::vec3 inside = (w - cosine * normal) / eta + entry.refracted_cosine * normal;
    formats::eval_spherical_harmonics({-inside.x, -inside.y, -inside.z}, value);
    std::size_t k = 0;
    for (std::size_t l = 0; l < phase.lambda.size(); ++l) {
        for (std::size_t m = 0; m < 2 * l + 1; ++m) {
            value[k++] *= phase.lambda[l];
        }
    }
}

SingleMedium make_single_medium(const formats::Scene& scene, std::uint32_t material,
                                std::uint32_t depth_samples, PhaseTerms phase,
                                std::uint32_t bands) {
    const formats::Medium& medium = *scene.materials[material].medium;
    const bool paper = medium.fidelity == formats::Medium::Fidelity::paper;
    const double diagonal{body_diagonals(scene)[material]};
    SingleMedium single;
    single.material = material;
    single.bands = bands;
    single.path = make_path_medium(thin_to_resolution(medium, diagonal));
    single.rule = paper ? make_midpoint_rule(depth_samples) : make_gauss_rule(depth_samples);
    single.boundary = {medium.eta, !paper};
    single.phase = std::move(phase);
    single.path_limit = static_cast<float>(path_limit(single.path, diagonal));
    return single;
}

std::vector<InteriorNode> place_interior_nodes(const SingleMedium& medium, const BodyPoint& point,
                                               const InwardPath& path) {
    std::vector<InteriorNode> nodes;
    // At the edge of a box the normal runs along its other faces; keep a distance to them.
    const glm::vec3 inward = point.inner - point.position;
    const glm::vec3 aside = inward - glm::dot(inward, point.normal) * point.normal;
    for (const PathNode& node : place_path_nodes(medium.rule, medium.path, double{path.length})) {
        const float depth = static_cast<float>(node.depth);
        const std::int32_t shells = shells_at(path, depth);
        if (shells < 1) continue;
        InteriorNode interior{point.position + aside - depth * point.normal, {}, shells};
        for (std::size_t c = 0; c < 3; ++c) {
            interior.weight[c] = static_cast<float>(node.weight[c]);
        }
        nodes.push_back(interior);
    }
    return nodes;
}

std::vector<RayPacket::Lane> texel_shares(const DirectionSet& directions) {
    std::vector<RayPacket::Lane> shares;
    std::vector<float> total(directions.inverse_solid_angle.size(), 0.0f);
    for (const DirectionBlock& block : directions.blocks) {
        RayPacket::Lane& share = shares.emplace_back();
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            // The first moment of a small cell is its solid angle times its direction.
            share[lane] = std::sqrt(block.moment_x[lane] * block.moment_x[lane] +
                                    block.moment_y[lane] * block.moment_y[lane] +
                                    block.moment_z[lane] * block.moment_z[lane]);
            total[block.texel[lane]] += share[lane];
        }
    }
    for (std::size_t b = 0; b < shares.size(); ++b) {
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            shares[b][lane] /= total[directions.blocks[b].texel[lane]];
        }
    }
    return shares;
}

EntryCounts gather_single(const RayScene& rays, const DirectionSet& directions,
                          std::span<const RayPacket::Lane> shares, const SingleMedium& medium,
                          const BodyPoint& point, std::span<float> transport) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    EntryCounts counts;
    const InwardPath path = trace_inward_path(rays, point, medium.path_limit);
    const std::vector<InteriorNode> nodes = place_interior_nodes(medium, point, path);
    const std::size_t terms = medium.phase.count(), bands = medium.bands;
    const std::size_t texels = transport.size() / (bands * terms);
    std::array<float, 3> sigma_t;
    std::copy(medium.path.sigma_t.begin(), medium.path.sigma_t.end(), sigma_t.begin());
    std::array<float, formats::kMaxHarmonics> room;
    const std::span<float> g = std::span<float>(room).first(terms);
    LaneMask all;
    all.fill(-1);
    for (const InteriorNode& node : nodes) {
        std::array<std::int32_t, RayPacket::kSize> shells;
        shells.fill(node.shells);
        RayPacket packet = rays_from(node.position);
        for (std::size_t b = 0; b < directions.blocks.size(); ++b) {
            const DirectionBlock& block = directions.blocks[b];
            packet.dir_x = block.dir_x;
            packet.dir_y = block.dir_y;
            packet.dir_z = block.dir_z;
            const PacketEntries entries =
                find_entries(rays, medium.material, all, packet, shells, counts);
            for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                if (entries.lit[lane] == 0) continue;
                const Entry<float> entry = enter(entries.cosine[lane], medium.boundary);
                const float length = entries.distance[lane] * entry.path_ratio;
                const float lit = shares[b][lane] * entry.throughput;
                eval_phase_terms(
                    medium.phase, medium.boundary.eta,
                    {block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]},
                    {entries.normal_x[lane], entries.normal_y[lane], entries.normal_z[lane]}, entry,
                    entries.cosine[lane], g);
                for (std::size_t c = 0; c < bands; ++c) {
                    const float arrives =
                        node.weight[c] * lit * exp_of_negative(-sigma_t[c] * length);
                    for (std::size_t k = 0; k < terms; ++k) {
                        transport[(bands * k + c) * texels + block.texel[lane]] += g[k] * arrives;
                    }
                }
            }
        }
    }
    return counts;
}

}  // namespace opaline::bake
