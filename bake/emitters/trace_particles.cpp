#include "bake/emitters/trace_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/emitters/bounce_color.h"
#include "bake/emitters/particle_start.h"
#include "bake/path_differentials/path_differential.h"
#include "bake/scene/texture_footprint.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kBlock = 2048;  // particles
constexpr std::uint32_t kMostFlights = 64;

struct Deposit {
    std::size_t element;
    glm::dvec3 power;
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

/// What the first surface along a ray is.
struct Arrival {
    TriangleSide side;
    glm::dvec3 weights{0};
    glm::dvec3 normal{0};  ///< unit, of the side met
    std::uint32_t material = 0;
    double distance = 0, error = 0;
};

bool find_arrival(const RayScene& surfaces, const glm::vec3& from, const glm::vec3& direction,
                  Arrival& arrival) {
    RayPacket packet = rays_from(from);
    packet.dir_x[0] = direction.x;
    packet.dir_y[0] = direction.y;
    packet.dir_z[0] = direction.z;
    packet.tfar[0] = std::numeric_limits<float>::infinity();
    LaneMask lanes{};
    lanes[0] = -1;
    const PacketHits hits = surfaces.closest(lanes, packet);
    if (hits.hit[0] == 0 || hits.cosine[0] == 0) return false;
    const bool is_back = hits.cosine[0] > 0;
    const glm::dvec3 normal(hits.normal_x[0], hits.normal_y[0], hits.normal_z[0]);
    arrival.side = {hits.primitive[0], hits.first_index[0], is_back};
    const double u = hits.u[0], v = hits.v[0];
    arrival.weights = {1 - u - v, u, v};
    arrival.normal = is_back ? -normal : normal;
    arrival.material = hits.material[0];
    arrival.distance = hits.distance[0];
    arrival.error = hits.error[0];
    return true;
}

double largest_of(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

// What the particle stands for of the surface, to look its textures up over.
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

void trace_particle(const Tracer& tracer, std::uint64_t particle, Traced& out) {
    Particle p = start_particle(tracer.starts, tracer.rules, tracer.run, particle);
    for (std::uint32_t flight = 0; flight < kMostFlights && p.power != glm::dvec3(0); ++flight) {
        Arrival at;
        ++out.rays;
        if (!find_arrival(tracer.surfaces, glm::vec3(p.position), glm::vec3(p.direction), at)) {
            return;
        }
        p.position += at.distance * p.direction;
        move_to_surface(p.path, p.direction, at.normal, at.distance);
        if (flight == 0) p.power *= p.dimming(at.distance);
        const auto x = random_uniform(tracer.run.seed, RandomStage::particle_bounces,
                                      particle_key(tracer.run, particle), flight);
        // Levels are a factor of four apart: the one below or above by chance, so that the mean
        // size follows the footprint.
        const double area =
            tracer.run.fixed_area > 0
                ? tracer.run.fixed_area
                : std::pow(4.0, static_cast<double>(x[3]) - 0.25) *
                      surface_footprint(p.path, tracer.rules, at.normal, FootprintMode::polygon)
                          .area;
        const std::size_t element = tracer.layout.element(at.side, at.weights, area);
        if (element < tracer.layout.size()) out.deposits.push_back({element, p.power});

        const std::optional<TextureView> view = view_of_footprint(tracer, p.path, at);
        const BounceColor color =
            bounce_color(tracer.scene, at.side, glm::vec3(at.weights), view ? &*view : nullptr);
        const double reflect = largest_of(color.reflect), transmit = largest_of(color.transmit);
        const double going_on = std::min(1.0, reflect + transmit);
        const double roulette = static_cast<double>(x[2]);
        if (!(roulette < going_on)) return;
        const bool crosses = roulette * (reflect + transmit) >= reflect * going_on;
        const double chance = going_on * (crosses ? transmit : reflect) / (reflect + transmit);
        p.power *= (crosses ? color.transmit : color.reflect) / chance;
        p.path.survival *= chance;
        const glm::dvec3 axis = crosses ? -at.normal : at.normal;
        p.position += crosses ? 2 * at.error * axis
                              : -std::min(2 * at.error / -glm::dot(p.direction, at.normal),
                                          0.5 * at.distance) *
                                    p.direction;
        aim_at_normal(p.path, glm::dmat3(0.0));
        p.direction = scatter_in_lobe(p.path, tracer.rules,
                                      {.axis = axis,
                                       .u = static_cast<double>(x[0]),
                                       .v = static_cast<double>(x[1]),
                                       .N_g = axis});
    }
}

}  // namespace

std::vector<glm::dvec3> trace_particles(const formats::Scene& scene, const RayScene& rays_scene,
                                        const LampSources& lamp, const ElementLayout& layout,
                                        const ParticleRun& run, const Context& context,
                                        std::uint64_t& rays) {
    std::vector<glm::dvec3> power(layout.size(), glm::dvec3(0));
    const StartTable starts = make_start_table(lamp);
    if (starts.empty() || rays_scene.is_empty()) return power;
    const Tracer tracer{scene,
                        rays_scene,
                        layout,
                        run,
                        starts,
                        {.steps = DifferentialRules::Steps::global,
                         .samples = static_cast<double>(run.particles),
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
                power[deposit.element] += deposit.power;
            }
            rays += traced.rays;
        });
    return power;
}

}  // namespace opaline::bake
