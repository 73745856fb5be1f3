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
#include "bake/physics/medium_flight.h"
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
    enum Kind { first, caustic, leaving } kind;
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

// Scatters the particle before it reaches the surface, or attenuates it to there. False: the
// latter.
bool scatter_inside(const Tracer& tracer, const Arrival& at, std::uint64_t key,
                    std::uint32_t flight, Particle& p) {
    const formats::Medium& medium = *tracer.scene.materials[tracer.run.medium].medium;
    const auto x = random_uniform(tracer.run.seed, RandomStage::particle_flights, key, flight);
    const double scale = largest_band(p.power);
    const glm::vec3 share(p.power / scale);
    const MediumFlight drawn = draw_flight(medium, {share.x, share.y, share.z},
                                           static_cast<float>(at.distance), x[0], x[1]);
    p.power = scale * glm::dvec3(drawn.share[0], drawn.share[1], drawn.share[2]);
    if (!drawn.length) return false;
    p.position += double{*drawn.length} * p.direction;
    p.direction = glm::dvec3(direction_on_sphere(x[2], x[3]));
    return true;
}

void trace_particle(const Tracer& tracer, std::uint64_t particle, Traced& out) {
    Particle p = start_particle(tracer.starts, tracer.rules, tracer.run, particle);
    const std::uint64_t key = particle_key(tracer.run, particle);
    const double least = kLeastShare * largest_band(p.power);
    bool is_from_lamp = true;  // by metals and media alone
    bool is_inside = tracer.run.medium != formats::kNone, is_scattered = false;
    const std::uint32_t most = is_inside ? kMostFlightsInside : kMostFlights;
    for (std::uint32_t flight = 0; flight < most; ++flight) {
        ++out.rays;
        const auto at =
            find_arrival(tracer.surfaces, glm::vec3(p.position), glm::vec3(p.direction));
        if (!at) return;
        if (flight == 0) p.power *= p.dimming(at->distance);
        if (is_inside && scatter_inside(tracer, *at, key, flight, p)) {
            if (!(largest_band(p.power) > least)) return;
            is_scattered = true;
            continue;
        }
        move_to_surface(p.path, p.direction, at->normal, at->distance);
        if (!is_inside) {
            p.power *=
                straight_transmittance(tracer.scene, *at) *
                volume_transmittance(tracer.run.volumes, p.position, p.direction, at->distance);
        }
        if (!(largest_band(p.power) > least)) return;
        const double footprint =
            tracer.run.fixed_area > 0
                ? tracer.run.fixed_area
                : surface_footprint(p.path, tracer.rules, at->normal, FootprintMode::polygon).area;
        const auto deposit = [&](const TriangleSide& side, Deposit::Kind kind) {
            const std::size_t element = tracer.layout.element(side, at->weights);
            if (element < tracer.layout.size()) {
                out.deposits.push_back(
                    {element, p.power, std::max(footprint, kLeastFootprint), kind});
            }
        };
        // What surfaces inside reflect again, the exchange has.
        if (!is_inside || is_from_lamp) {
            deposit(at->side, is_from_lamp && flight > 0 ? Deposit::caustic : Deposit::first);
        }
        auto x = random_uniform(tracer.run.seed, RandomStage::particle_bounces, key, flight);
        if (flight == 0) std::ranges::copy(p.first_bounce, x.begin());
        const bool is_medium = lets_through(tracer.scene, *at);
        if (is_inside && is_medium && at->material != tracer.run.medium) return;
        if (is_medium && at->side.is_back && flight == 0 && !is_inside &&
            !is_clear(tracer.scene, *at)) {
            return;
        }
        const Choice next = is_medium ? cross(tracer, *at, x, p) : scatter(tracer, *at, x, p);
        if (next.power == glm::dvec3(0)) return;
        if (is_inside && is_medium && next.crosses) {
            if (is_scattered) {
                p.power = next.power;
                deposit({at->side.primitive, at->side.first_index, !at->side.is_back},
                        Deposit::leaving);
            }
            if (is_scattered || !is_from_lamp) return;
            is_inside = false;
        }
        p.position = leave_surface(p.position, p.direction, *at, next.crosses);
        p.direction = next.direction;
        p.power = next.power;
        is_from_lamp = is_from_lamp && !next.is_diffuse;
        is_scattered = is_scattered && !next.is_diffuse;
        if (tracer.run.ends_diffuse && !is_from_lamp && !is_inside) return;
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
                if (deposit.kind != Deposit::leaving) add_deposit(deposit, light.all);
                if (deposit.kind == Deposit::first) continue;
                auto& part = deposit.kind == Deposit::leaving ? light.leaving : light.caustic;
                part.resize(layout.size());
                add_deposit(deposit, part);
            }
            rays += traced.rays;
        });
    return light;
}

}  // namespace opaline::bake
