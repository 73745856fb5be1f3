#include "bake/effects/emitters/true_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/base/rng.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/exchange/inside_media.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/spread_points.h"
#include "bake/scene/punctual_light.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr float kRayEnd = 1 - 1e-4f;
constexpr std::uint32_t kMostBounces = 64, kMostTurns = 1024;
constexpr double kRoulette = 0.1;

std::vector<Ball> balls_around(std::span<const GlowingGrid> glow) {
    std::vector<Ball> balls;
    balls.reserve(glow.size());
    for (const GlowingGrid& grid : glow) {
        const glm::dmat3 to_scene = glm::inverse(glm::dmat3(grid.to_index));
        const glm::dvec3 size = 8.0 * glm::dvec3(grid.extent);
        const glm::dvec3 middle = 8.0 * glm::dvec3(grid.first_cell) + 0.5 * size;
        double radius = 0;
        for (unsigned c = 0; c < 4; ++c) {
            const glm::dvec3 corner(size.x, c & 1 ? size.y : -size.y, c & 2 ? size.z : -size.z);
            radius = std::max(radius, 0.5 * glm::length(to_scene * corner));
        }
        balls.push_back({to_scene * (middle - glm::dvec3(grid.offset)), radius});
    }
    return balls;
}

/// Bands that follow the extinction of one of them.
struct FlightBand {
    std::size_t band = 0;
    glm::dvec3 counts{1};  // 1 of those bands
};

/// A path backward from a receiver.
struct BackwardPath {
    const EmitterCheck& check;
    const TrueSources& sources;
    std::uint64_t seed, key;
    FlightBand flight;
    std::uint32_t draws = 0;
    std::uint64_t rays = 0;
    /// The first numbers of a path: a lattice over all paths [Roberts2018], shifted at random.
    std::array<float, 5> first{};

    std::vector<Ball> balls = balls_around(check.glow);
    std::uint32_t first_medium = formats::kNone;  ///< around the receiver

    void begin(std::uint32_t path) {
        const auto shift = random_uniform(seed, RandomStage::true_gather, key, 0xfffffffeu);
        const auto more = random_uniform(seed, RandomStage::true_gather, key, 0xfffffffdu);
        double turn = 1;
        for (std::size_t k = 0; k < first.size(); ++k) {
            turn /= 1.1347241384015194;  // the root of x^6 = x + 1
            first[k] = static_cast<float>(
                fraction(static_cast<double>(k < 4 ? shift[k] : more[0]) + path * turn));
        }
    }

    std::array<float, 4> draw() {
        return random_uniform(seed, RandomStage::true_gather, key, draws++);
    }

    // What comes straight to a point, times share(unit direction to it): one point of the
    // triangles, one shadow ray to each light.
    template <class Share>
    glm::dvec3 straight(const glm::vec3& at, bool is_first, const Share& share) {
        glm::dvec3 sum(0);
        for (std::size_t l = 0; l < sources.lights.size(); ++l) {
            const formats::Light& light = sources.lights[l];
            const ArrivingLight arriving = light_at(light, at);
            const double own = share(arriving.to_light);
            if (own == 0 || arriving.irradiance == formats::Rgb{}) continue;
            ++rays;
            if (is_hidden(check.rays, at, arriving.to_light, arriving.distance)) continue;
            const formats::Rgb& e = arriving.irradiance;
            sum +=
                own * glm::dvec3(e.r, e.g, e.b) *
                (sources.around_light[l] == glm::dvec3(0)
                     ? glm::dvec3(1)
                     : glm::exp(-double{arriving.distance} * sources.around_light[l])) *
                volume_transmittance(check.volumes, glm::dvec3(at), glm::dvec3(arriving.to_light),
                                     static_cast<double>(arriving.distance));
        }
        return sources.triangles.empty() ? sum : sum + from_a_triangle(at, is_first, share);
    }

    template <class Share>
    glm::dvec3 from_a_triangle(const glm::vec3& at, bool is_first, const Share& share) {
        auto x = draw();
        if (is_first) std::copy_n(first.begin(), 3, x.begin());
        const double total = sources.cumulative.back();
        const std::size_t t = part_of_sum(sources.cumulative, static_cast<double>(x[0]) * total);
        const double chance =
            (sources.cumulative[t] - (t == 0 ? 0 : sources.cumulative[t - 1])) / total;
        const GlowingTriangle& triangle = sources.triangles[t];
        const double root = std::sqrt(static_cast<double>(x[1])), v = static_cast<double>(x[2]);
        const glm::dvec3 way = (1 - root) * triangle.corner[0] +
                               root * (1 - v) * triangle.corner[1] + root * v * triangle.corner[2] -
                               glm::dvec3(at);
        const double square = glm::dot(way, way), distance = std::sqrt(square);
        const double facing = -glm::dot(triangle.normal, way);
        if (!(square > 0) || (facing <= 0 && !triangle.is_two_sided)) return glm::dvec3(0);
        const double own = share(glm::vec3(way / distance));
        if (own == 0) return glm::dvec3(0);
        ++rays;
        if (is_hidden(check.rays, at, glm::vec3(way / distance),
                      static_cast<float>(distance) * kRayEnd)) {
            return glm::dvec3(0);
        }
        return own * std::abs(facing) / (square * distance) * triangle.area / chance *
               triangle.radiance * glm::exp(-distance * sources.around_triangle[t]) *
               volume_transmittance(check.volumes, glm::dvec3(at), way / distance, distance);
    }

    // What lamps bring to a vertex without diffuse bounces.
    glm::dvec3 from_lamps(const Receiver& at, bool is_first) {
        glm::dvec3 sum = straight(at.origin, is_first, [&](const glm::vec3& to_light) {
            return std::max(0.0, static_cast<double>(glm::dot(to_light, at.normal)));
        });
        if (check.known == nullptr || check.known->lamps.caustics.empty()) return sum;
        std::vector<glm::dvec3> caustic(check.sources.size(), glm::dvec3(0));
        add_caustics(check.known->lamps, at, caustic, rays);
        for (const glm::dvec3& of_lamp : caustic)
            sum += of_lamp;
        return sum;
    }

    // What a medium sends out is known; the path goes on as its boundary mirrors it. False: it
    // ends.
    bool meet_medium(const Arrival& at, glm::dvec3& from, glm::dvec3& direction,
                     const glm::dvec3& throughput, glm::dvec3& sum) {
        if (check.known == nullptr || at.side.is_back) return false;
        const glm::vec3 normal(at.normal), place(from + at.distance * direction);
        const SeenSide side{true, false, normal, -glm::dot(glm::vec3(direction), normal)};
        const MirroredRay ray =
            mirror({check.scene, check.rays},
                   {place, glm::vec3(direction), static_cast<float>(at.distance),
                    static_cast<float>(at.error), at.material, side},
                   {1, 1, 1}, 0);
        sum += static_cast<double>(
                   share_of_radiosity(check.scene.materials[at.material], ray.largest())) *
               throughput * find_sent(*check.known, place, {at.material, false, normal});
        if (!(draw()[0] < ray.largest())) return false;
        from = glm::dvec3(ray.origin);
        direction = glm::dvec3(ray.direction);
        return true;
    }

    // Spread by the cosine around the axis; at first half of them toward volumes that glow.
    // `weight` takes the cosine / (pi density).
    glm::dvec3 draw_diffuse(const glm::dvec3& from, const glm::dvec3& axis, bool is_first,
                            std::array<float, 4> x, glm::dvec3& weight) {
        const double u = static_cast<double>(x[0]), v = static_cast<double>(x[1]);
        const BallDirections cosine({}, glm::dvec3(0), axis);
        if (!is_first || balls.empty()) return cosine.sample(u, v);
        const auto choice = std::min(
            static_cast<std::size_t>(static_cast<float>(balls.size()) * x[3]), balls.size() - 1);
        const double within = static_cast<double>(x[3]) * static_cast<double>(balls.size()) -
                              static_cast<double>(choice);
        const BallDirections toward(balls[choice], from, axis);
        const glm::dvec3 direction = within < 0.5 ? cosine.sample(u, v) : toward.sample(u, v);
        double density = 0.5 * cosine.pdf(direction);
        for (const Ball& ball : balls) {
            density += 0.5 * BallDirections(ball, from, axis).pdf(direction) /
                       static_cast<double>(balls.size());
        }
        weight *= density > 0 ? cosine.pdf(direction) / density : 0;
        return direction;
    }

    // Follows a flight through volumes to the surface that ends it: emission is added, scattering
    // turns the path. Nothing: the path is lost.
    std::optional<Arrival> fly(glm::dvec3& from, glm::dvec3& direction, glm::dvec3& throughput,
                               glm::dvec3& sum) {
        for (std::uint32_t n = 0; n < kMostTurns; ++n) {
            ++rays;
            auto at = find_arrival(check.rays, glm::vec3(from), glm::vec3(direction));
            if (check.volumes == nullptr) return at;
            const float reach =
                at ? static_cast<float>(at->distance) : std::numeric_limits<float>::infinity();
            FlightRandom random(seed, RandomStage::true_gather, ~key << 32 | draws++);
            const Collision hit = sample_flight(*check.volumes, flight.band, glm::vec3(from),
                                                glm::vec3(direction), reach, random);
            for (const GlowingGrid& grid : check.glow) {
                const float length = hit.happens ? hit.distance : reach;
                sum += std::numbers::pi * throughput *
                       glm::dvec3(glow_along(grid, glm::vec3(from), glm::vec3(direction), length));
            }
            if (!hit.happens) return at;
            const DensityVolume& own = check.volumes->volumes[hit.volume];
            from += static_cast<double>(hit.distance) * direction;
            const std::array<float, 3> albedo = own.albedo_at(glm::vec3(from));
            throughput *= glm::dvec3(albedo[0], albedo[1], albedo[2]);
            const double most = largest_band(glm::abs(throughput));
            if (most < kRoulette) {
                if (static_cast<double>(random()) * kRoulette >= most) return std::nullopt;
                throughput *= kRoulette / most;
            }
            if (check.scatters_lamps) {
                const glm::vec3 away(direction);
                sum += std::numbers::pi * throughput *
                       straight(glm::vec3(from), false, [&](const glm::vec3& to_light) {
                           return static_cast<double>(
                               eval_scaled(own.phase, glm::dot(away, to_light)));
                       });
            }
            glm::vec3 turned(direction);
            throughput *= static_cast<double>(turn_walk(own.phase, turned, random).weight);
            direction = glm::dvec3(turned);
        }
        return std::nullopt;
    }

    // Through the medium that the path is inside of, as it scatters there, to the next surface.
    std::optional<Arrival> pass_medium(std::optional<Arrival> at, std::uint32_t& medium,
                                       glm::dvec3& from, glm::dvec3& direction,
                                       glm::dvec3& throughput, glm::dvec3& sum) {
        if (check.known == nullptr || check.known->surfaces == nullptr) return at;
        const BounceSpace space = check.known->surfaces->space();
        MirroredRay ray{.medium = medium};
        while (at) {
            const glm::vec3 share(throughput), place(from + at->distance * direction);
            ray.origin = glm::vec3(from), ray.direction = glm::vec3(direction);
            ray.share = {share.x, share.y, share.z};
            const glm::vec3 outward(at->side.is_back ? -at->normal : at->normal);
            const SeenSide side = side_of(check.scene.materials[at->material], outward,
                                          glm::dot(outward, ray.direction));
            const bool goes_on =
                go_on_inside(space,
                             {place, ray.direction, static_cast<float>(at->distance),
                              static_cast<float>(at->error), at->material, side},
                             ray, seed);
            medium = ray.medium;
            throughput = {ray.share.r, ray.share.g, ray.share.b};
            if (!goes_on) break;
            if (ray.inside >= kMostInside) return std::nullopt;
            from = glm::dvec3(ray.origin), direction = glm::dvec3(ray.direction);
            at = fly(from, direction, throughput, sum);
        }
        return at;
    }

    glm::dvec3 run(const Receiver& receiver) {
        std::uint32_t medium = first_medium;
        glm::dvec3 sum(0), throughput(flight.counts), from(receiver.origin), direction,
            axis(receiver.normal);
        bool is_diffuse = true;  // the next direction is drawn around the axis
        PathDifferential unused;
        for (std::uint32_t bounce = 0; bounce < kMostBounces; ++bounce) {
            if (is_diffuse) {
                sum += throughput * from_lamps({glm::vec3(from), glm::vec3(axis)}, bounce == 0);
            }
            auto x = draw();
            if (bounce == 0) std::copy_n(first.begin() + 3, 2, x.begin());
            if (is_diffuse) direction = draw_diffuse(from, axis, bounce == 0, x, throughput);
            if (throughput == glm::dvec3(0)) break;
            const auto at = pass_medium(fly(from, direction, throughput, sum), medium, from,
                                        direction, throughput, sum);
            if (!at) break;
            if (check.scene.materials[at->material].medium) {
                if (!meet_medium(*at, from, direction, throughput, sum)) break;
                is_diffuse = false;
                continue;
            }
            const Next next = choose(*at, direction, static_cast<double>(x[2]), unused);
            if (next.weight == glm::dvec3(0)) break;
            throughput *= next.weight;
            from = leave_surface(from, direction, *at, next.crosses);
            is_diffuse = next.is_diffuse;
            direction = next.direction;
            axis = next.crosses ? -at->normal : at->normal;
        }
        return sum;
    }

    // How a path goes on, with its weight over the probability; 0: it ends.
    struct Next {
        glm::dvec3 weight{0}, direction{0};
        bool crosses = false, is_diffuse = false;
    };
    Next choose(const Arrival& at, const glm::dvec3& direction, double roulette,
                PathDifferential& unused) {
        unused.count = 0;
        const BounceColor color = bounce_color(check.scene, at.side, glm::vec3(at.weights));
        const double reflect = largest_band(color.reflect);
        const double transmit = largest_band(color.transmit);
        const double mirror = mirror_chance(check.scene, at, direction);
        const double all = reflect + transmit + mirror, going_on = std::min(1.0, all);
        if (!(roulette < going_on)) return {};
        const double at_choice = roulette / going_on * all, over = all / going_on;
        if (at_choice < mirror) {
            const auto y = draw();
            const auto onward =
                mirror_ray(check.scene, at, direction,
                           {static_cast<double>(y[0]), static_cast<double>(y[1])}, {}, unused);
            return onward ? Next{over / mirror * onward->weight, onward->direction, false, false}
                          : Next{};
        }
        const bool crosses = at_choice >= mirror + reflect;
        return {over / (crosses ? transmit : reflect) * (crosses ? color.transmit : color.reflect),
                glm::dvec3(0), crosses, true};
    }
};

}  // namespace

TrueSources collect_true_sources(std::span<const LampSources> lamps) {
    TrueSources all;
    double sum = 0;
    for (const LampSources& lamp : lamps) {
        for (const GlowingTriangle& triangle : lamp.triangles) {
            const glm::dvec3 power = triangle.power();
            all.triangles.push_back(triangle);
            all.around_triangle.push_back(lamp.extinction);
            all.cumulative.push_back(sum += power.x + power.y + power.z);
        }
        all.lights.insert(all.lights.end(), lamp.lights.begin(), lamp.lights.end());
        all.around_light.resize(all.lights.size(), lamp.extinction);
    }
    return all;
}

glm::dvec3 trace_irradiance(const EmitterCheck& check, const TrueSources& sources,
                            const Receiver& receiver, std::uint32_t paths, std::uint64_t seed,
                            std::uint64_t key, std::uint64_t& rays) {
    glm::dvec3 sum(0);
    // Bands of one extinction go one way.
    std::vector<FlightBand> flights{{0, glm::dvec3(1)}};
    if (check.volumes != nullptr && !check.volumes->is_grey) {
        flights = {{0, {1, 0, 0}}, {1, {0, 1, 0}}, {2, {0, 0, 1}}};
    }
    for (const FlightBand& flight : flights) {
        BackwardPath path{check, sources, seed, key, flight};
        if (check.known != nullptr && check.known->surfaces != nullptr) {
            path.first_medium = medium_around(check.known->surfaces->space(), receiver).material;
        }
        for (std::uint32_t i = 0; i < paths; ++i) {
            path.begin(i);
            sum += path.run(receiver);
        }
        rays += path.rays;
    }
    return sum / static_cast<double>(paths);
}

}  // namespace opaline::bake
