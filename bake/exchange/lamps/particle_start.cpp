#include "bake/exchange/lamps/particle_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/base/rng.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/spread_points.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/scene/punctual_light.h"

namespace opaline::bake {
namespace {

constexpr glm::dvec3 kStill(0);
constexpr float kBelowOne = 1 - 0x1p-24f;

// Two unit vectors across a direction.
std::array<glm::dvec3, 2> axes_across(const glm::dvec3& d) {
    const glm::dvec3 other = std::abs(d.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 first = glm::normalize(glm::cross(d, other));
    return {first, glm::cross(d, first)};
}

// `chance`: of this triangle among those of the lamp, whose surface goes on beyond it: one number
// spans as much of it as one of the density chance / area does.
void start_on_triangle(const GlowingTriangle& triangle, double chance,
                       const DifferentialRules& rules, std::array<double, 4> x, Particle& p) {
    glm::dvec3 normal = triangle.normal;
    if (triangle.is_two_sided) {  // half of the first number chooses the side
        p.path.survival *= 0.5;
        if (x[0] >= 0.5) normal = -normal;
        x[0] = 2 * x[0] - (x[0] >= 0.5 ? 1 : 0);
    }
    const AreaSample at = sample_triangle_folded(triangle.corner, x[0], x[1]);
    const double scale = 1 / std::sqrt(chance);
    add_variable(p.path, {scale * at.dP_du, kStill, 0, 1});
    add_variable(p.path, {scale * at.dP_dv, kStill, 0, 1});
    aim_at_normal(p.path, glm::dmat3(0.0));
    p.direction =
        scatter_in_lobe(p.path, rules, {.axis = normal, .u = x[2], .v = x[3], .N_g = normal});
    const double size = std::max({glm::length(triangle.corner[0]), glm::length(triangle.corner[1]),
                                  glm::length(triangle.corner[2])});
    p.position = at.P + 1e-6 * size * normal;
}

void start_at_light(const LampSources& lamp, const formats::Light& light,
                    const DifferentialRules& rules, const std::array<double, 4>& x, Particle& p) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction));
    if (light.type == formats::Light::Type::directional) {
        const auto across = axes_across(axis);
        const glm::dvec3 side = 2 * lamp.radius * across[0], other = 2 * lamp.radius * across[1];
        const AreaSample at = sample_parallelogram(
            lamp.centre - 2 * lamp.radius * axis - 0.5 * (side + other), side, other, x[0], x[1]);
        add_variable(p.path, {at.dP_du, kStill, 0, 1});
        add_variable(p.path, {at.dP_dv, kStill, 0, 1});
        p.position = at.P;
        p.direction = axis;
        return;
    }
    p.position = glm::dvec3(light.position);
    p.range = static_cast<double>(light.range);
    const bool is_spot = light.type == formats::Light::Type::spot;
    const double outer = std::cos(static_cast<double>(light.outer_cone));
    const Lobe lobe =
        is_spot ? Lobe{Lobe::Kind::cone, outer} : Lobe{Lobe::Kind::henyey_greenstein, 0};
    p.direction =
        scatter_in_lobe(p.path, rules, {.axis = axis, .lobe = lobe, .u = x[2], .v = x[3]});
    if (!is_spot) return;
    // Uniform over the cone; its share of the light at that angle over the mean one.
    formats::Light bare = light;
    bare.range = 0;
    bare.intensity = {1, 1, 1};
    const formats::Rgb there = light_at(bare, light.position + glm::vec3(p.direction)).irradiance;
    p.power *= static_cast<double>(there.r) * 2 * std::numbers::pi * (1 - outer) /
               flux_per_intensity(light);
}

// From -1 to 1 with the density 1 - |t|.
double hat_of(double u) {
    return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

// `chance`: of this voxel among those of the lamp, as for triangles. u: along the axes.
void start_in_voxel(const GlowingVoxels& voxels, std::size_t i, double chance,
                    const DifferentialRules& rules, const std::array<double, 3>& u,
                    const std::array<double, 4>& x, Particle& p) {
    const glm::dvec3 index =
        voxels.centre[i] + glm::dvec3(hat_of(u[0]), hat_of(u[1]), hat_of(u[2]));
    p.position = glm::dvec3(voxels.to_scene * glm::dvec4(index, 1));
    const double scale = 1 / std::cbrt(chance);
    for (int axis = 0; axis < 3; ++axis) {
        add_variable(p.path, {scale * glm::dvec3(voxels.to_scene[axis]), kStill, 0, 1});
    }
    p.direction = scatter_in_lobe(
        p.path, rules,
        {.axis = {0, 0, 1}, .lobe = {Lobe::Kind::henyey_greenstein, 0}, .u = x[2], .v = x[3]});
}

}  // namespace

StartTable make_start_table(const LampSources& lamp) {
    StartTable table{lamp, {}};
    table.cumulative.reserve(lamp.triangles.size() + lamp.lights.size() +
                             lamp.voxels.centre.size());
    double sum = 0;
    for (const GlowingTriangle& triangle : lamp.triangles) {
        table.cumulative.push_back(sum += largest_band(triangle.power()));
    }
    for (const formats::Light& light : lamp.lights) {
        table.cumulative.push_back(sum += largest_band(light_power(lamp, light)));
    }
    for (std::size_t i = 0; i < lamp.voxels.centre.size(); ++i) {
        table.cumulative.push_back(sum += largest_band(lamp.voxels.power(i)));
    }
    return table;
}

double Particle::dimming(double distance) const {
    if (!(range > 0)) return 1;
    const double square = distance / range * (distance / range);
    return std::max(0.0, 1 - square * square);
}

std::uint64_t particle_key(const ParticleRun& run, std::uint64_t particle) {
    return (std::uint64_t{run.lamp} << 40) + particle;
}

Particle start_particle(const StartTable& table, const DifferentialRules& rules,
                        const ParticleRun& run, std::uint64_t particle) {
    const auto shift = random_uniform(run.seed, RandomStage::particle_starts, run.lamp);
    const auto more = random_uniform(run.seed, RandomStage::particle_starts, run.lamp, 1);
    std::array<double, 8> lattice{};
    double turn = 1;
    for (std::size_t k = 0; k < lattice.size(); ++k) {
        turn /= 1.085070245491451;  // the root of x^9 = x + 1
        lattice[k] = fraction(static_cast<double>(k < 4 ? shift[k] : more[k - 4]) +
                              static_cast<double>(particle) * turn);
    }
    const std::array<double, 4> x{lattice[1], lattice[2], lattice[3], lattice[4]};
    const double total = table.cumulative.back(), at = lattice[0] * total;
    const std::size_t source = part_of_sum(table.cumulative, at);
    const double before = source == 0 ? 0 : table.cumulative[source - 1];
    const double chance = (table.cumulative[source] - before) / total;

    Particle p;
    for (std::size_t k = 0; k < p.first_bounce.size(); ++k) {
        p.first_bounce[k] = std::min(static_cast<float>(lattice[5 + k]), kBelowOne);
    }
    const LampSources& lamp = table.lamp;
    const std::size_t first_light = lamp.triangles.size();
    const std::size_t first_voxel = first_light + lamp.lights.size();
    const auto share_of = [&](const glm::dvec3& power) { return power / (chance * run.particles); };
    if (source >= first_voxel) {
        const auto more_of =
            random_uniform(run.seed, RandomStage::particle_starts, particle_key(run, particle), 2);
        p.path.survival = chance;
        p.power = share_of(lamp.voxels.power(source - first_voxel));
        start_in_voxel(lamp.voxels, source - first_voxel, chance, rules,
                       {x[0], x[1], static_cast<double>(more_of[0])}, x, p);
    } else if (source >= first_light) {
        const formats::Light& light = lamp.lights[source - first_light];
        p.path.survival = chance;
        p.power = share_of(light_power(lamp, light));
        start_at_light(lamp, light, rules, x, p);
    } else {
        p.power = share_of(lamp.triangles[source].power());
        start_on_triangle(lamp.triangles[source], chance, rules, x, p);
    }
    return p;
}

}  // namespace opaline::bake
