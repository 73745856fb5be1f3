#include "bake/exchange/lamps/trace_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/exchange/lamps/glow_light.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/particle_start.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kBlock = 2048;  // particles
constexpr std::uint32_t kMostFlights = 64;
constexpr double kLeastShare = 1e-4;       // of its power at first: a particle ends
constexpr double kLeastFootprint = 1e-30;  // [m^2]: its logarithm is finite

struct Deposit {
    std::size_t element;
    glm::dvec3 power;
    double footprint;  // [m^2]
    bool is_caustic;
};

struct Traced {
    std::vector<Deposit> deposits;
    std::uint64_t rays = 0;
};

struct Tracer {
    const formats::Scene& scene;
    const RayScene& surfaces;
    const ElementLayout& layout;
    const ParticleRun& run;
    const StartTable& starts;
    DifferentialRules rules;
};

// Footprint of the particle on the surface, over which its textures are filtered.
std::optional<TextureView> view_of_footprint(const Tracer& tracer, const PathDifferential& path,
                                             const Arrival& at) {
    const ScenePyramids* const textures = tracer.run.textures;
    if (textures == nullptr || !has_pyramid(*textures, tracer.scene.materials[at.material])) {
        return std::nullopt;
    }
    const FootprintPair pair = footprint_in_texture(
        surface_footprint(path, tracer.rules, at.normal, FootprintMode::filter),
        uv_gradient(tracer.scene.primitives[at.side.primitive], at.side.first_index));
    UvMoments moments;
    moments.add(pair.A);
    moments.add(pair.B);
    return TextureView{*textures, moments};
}

// Continuation of a particle at a surface: its ray and its share of the power.
struct Choice {
    glm::dvec3 direction{0}, power{0};
    bool crosses = false, is_diffuse = false;
};

Choice scatter(const Tracer& tracer, const Arrival& at, const std::array<float, 4>& random,
               Particle& p) {
    const std::array<double, 2> x{static_cast<double>(random[0]), static_cast<double>(random[1])};
    const std::optional<TextureView> view = view_of_footprint(tracer, p.path, at);
    const BounceColor color =
        bounce_color(tracer.scene, at.side, glm::vec3(at.weights), view ? &*view : nullptr);
    const double reflect = largest_band(color.reflect), transmit = largest_band(color.transmit);
    const double mirror = mirror_chance(tracer.scene, at, p.direction);
    const double sum = reflect + transmit + mirror, going_on = std::min(1.0, sum);
    const double roulette = static_cast<double>(random[2]);
    if (!(roulette < going_on)) return {};
    const double at_choice = roulette / going_on * sum;
    Choice choice;
    if (at_choice < mirror) {
        const double chance = going_on * mirror / sum;
        p.path.survival *= chance;
        const auto onward = mirror_ray(tracer.scene, at, p.direction, x, tracer.rules, p.path);
        if (onward) choice = {onward->direction, onward->weight / chance * p.power, false, false};
        return choice;
    }
    choice.is_diffuse = true;
    choice.crosses = at_choice >= mirror + reflect;
    const double chance = going_on * (choice.crosses ? transmit : reflect) / sum;
    choice.power = (choice.crosses ? color.transmit : color.reflect) / chance * p.power;
    p.path.survival *= chance;
    const glm::dvec3 axis = choice.crosses ? -at.normal : at.normal;
    aim_at_normal(p.path, glm::dmat3(0.0));
    choice.direction =
        scatter_in_lobe(p.path, tracer.rules, {.axis = axis, .u = x[0], .v = x[1], .N_g = axis});
    return choice;
}

bool is_clear(const formats::Scene& scene, const Arrival& at) {
    return scene.materials[at.material].medium->sigma_s == formats::Rgb{};
}

Choice cross(const Tracer& tracer, const Arrival& at, const std::array<float, 4>& random,
             Particle& p) {
    const auto onward =
        cross_boundary(tracer.scene, at, p.direction, first_three(random), tracer.rules, p.path);
    return onward ? Choice{onward->direction, onward->weight * p.power, onward->crosses, false}
                  : Choice{};
}

void trace_particle(const Tracer& tracer, std::uint64_t particle, Traced& out) {
    Particle p = start_particle(tracer.starts, tracer.rules, tracer.run, particle);
    const double least = kLeastShare * largest_band(p.power);
    bool is_from_lamp = true;  // by metals and media alone
    for (std::uint32_t flight = 0; flight < kMostFlights; ++flight) {
        ++out.rays;
        const auto at =
            find_arrival(tracer.surfaces, glm::vec3(p.position), glm::vec3(p.direction));
        if (!at) return;
        move_to_surface(p.path, p.direction, at->normal, at->distance);
        if (flight == 0) p.power *= p.dimming(at->distance);
        p.power *= straight_transmittance(tracer.scene, *at) *
                   volume_transmittance(tracer.run.volumes, p.position, p.direction, at->distance);
        if (!(largest_band(p.power) > least)) return;
        const double footprint =
            tracer.run.fixed_area > 0
                ? tracer.run.fixed_area
                : surface_footprint(p.path, tracer.rules, at->normal, FootprintMode::polygon).area;
        const std::size_t element = tracer.layout.element(at->side, at->weights);
        const bool is_caustic = is_from_lamp && flight > 0;
        if (element < tracer.layout.size()) {
            out.deposits.push_back(
                {element, p.power, std::max(footprint, kLeastFootprint), is_caustic});
        }
        auto x = random_uniform(tracer.run.seed, RandomStage::particle_bounces,
                                particle_key(tracer.run, particle), flight);
        if (flight == 0) std::ranges::copy(p.first_bounce, x.begin());
        const bool is_medium = lets_through(tracer.scene, *at);
        if (is_medium && at->side.is_back && flight == 0 && !is_clear(tracer.scene, *at)) return;
        const Choice next = is_medium ? cross(tracer, *at, x, p) : scatter(tracer, *at, x, p);
        if (next.power == glm::dvec3(0)) return;
        p.position = leave_surface(p.position, p.direction, *at, next.crosses);
        p.direction = next.direction;
        p.power = next.power;
        is_from_lamp = is_from_lamp && !next.is_diffuse;
        if (tracer.run.ends_diffuse && !is_from_lamp) return;
    }
}

void add_deposit(const Deposit& deposit, std::vector<ElementDeposit>& elements) {
    ElementDeposit& element = elements[deposit.element];
    const double weight = largest_band(deposit.power);
    element.power += deposit.power;
    element.weight += weight;
    element.weight_squares += weight * weight;
    element.log_footprint += weight * std::log(deposit.footprint);
}

}  // namespace

ParticleLight trace_particles(const formats::Scene& scene, const RayScene& rays_scene,
                              const LampSources& lamp, const ElementLayout& layout,
                              const ParticleRun& run, const Context& context, std::uint64_t& rays) {
    ParticleLight light;
    light.all.resize(layout.size());
    const StartTable starts = make_start_table(lamp);
    if (starts.empty() || rays_scene.is_empty()) return light;
    const Tracer tracer{scene,
                        rays_scene,
                        layout,
                        run,
                        starts,
                        {.samples = static_cast<double>(run.particles),
                         .gradient_limit = run.gradient_limit,
                         .extent = 2 * lamp.radius}};
    for_each_block_in_order(
        run.particles, kBlock, context,
        [&](Range range) {
            Traced traced;
            traced.deposits.reserve(2 * (range.end - range.begin));
            for (std::size_t i = range.begin; i < range.end; ++i) {
                trace_particle(tracer, i, traced);
            }
            return traced;
        },
        [&](Range, Traced&& traced) {
            for (const Deposit& deposit : traced.deposits) {
                add_deposit(deposit, light.all);
                if (!deposit.is_caustic) continue;
                light.caustic.resize(layout.size());
                add_deposit(deposit, light.caustic);
            }
            rays += traced.rays;
        });
    return light;
}

}  // namespace opaline::bake
