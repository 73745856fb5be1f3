#include "bake/effects/multiple/walks/inner_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

std::vector<SurfacePoint> start_points(std::span<const WalkStart> starts) {
    std::vector<SurfacePoint> points;
    points.reserve(starts.size());
    for (const WalkStart& s : starts) {
        points.push_back({.position = s.position, .normal = s.normal});
    }
    return points;
}

constexpr std::size_t kFewest = 12;  // sites of a fit
constexpr float kGridCell = 1.12f;   // of the grid, in radii: sqrt(1 + .5^2)

// How deep flights go [m]: light from behind that an absorbing body dims hardly less than a flight
// comes from everywhere along it.
float reach_of(const WalkSpace& space) {
    constexpr float kPaths = 6;
    float sigma_t = 0;
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        sigma_t += space.media.front().sigma_t[g] / static_cast<float>(space.bands.size());
    }
    return sigma_t > 0 ? kPaths / sigma_t : 0;
}

// Of the lattice [Roberts2018]: powers of 1 / phi, phi^4 = phi + 1.
constexpr std::array<double, 3> kStep{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

float lattice(std::size_t i, std::size_t dimension) {
    const double place = (static_cast<double>(i) + 0.5) * kStep[dimension];
    return static_cast<float>(place - std::floor(place));
}

// Below the facet.
glm::vec3 entering_direction(const WalkSpace& space, const WalkStart& start, float u, float v) {
    const auto inside = static_cast<float>(
        refracted_cosine(std::sqrt(1 - static_cast<double>(u)), static_cast<double>(space.eta)));
    const float sine = std::sqrt(std::max(0.0f, 1 - inside * inside));
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    const glm::vec3 tilted(sine * std::cos(azimuth), sine * std::sin(azimuth), -inside);
    const glm::vec3 direction = make_frame(start.normal).to_world(tilted);
    return glm::dot(direction, start.flat) < 0 ? direction
                                               : make_frame(start.flat).to_world(tilted);
}

}  // namespace

InnerField::InnerField(std::span<const WalkStart> starts, float radius, float path,
                       bool is_isotropic)
    : radius_(radius),
      path_(path),
      is_isotropic_(is_isotropic),
      grid_(start_points(starts), kGridCell * radius) {
    for (const WalkStart& s : starts) {
        position_.push_back(s.position);
        arrival_.push_back(s.arrival);
        depth_.push_back(s.depth);
        low_ = glm::min(low_, s.position);
        high_ = glm::max(high_, s.position);
    }
}

// In radii, of the lowest corner of the box around all sites.
float InnerField::depth_below(glm::vec3 position, glm::vec3 normal) const {
    const glm::vec3 corner = glm::mix(high_, low_, glm::greaterThan(normal, glm::vec3(0)));
    return glm::dot(position - corner, normal) / radius_;
}

// Bounded, so that the few places far beyond the sites are not extrapolated to.
InnerField::Functions InnerField::eval(const Centre& centre, glm::vec3 position,
                                       glm::vec3 direction) const {
    glm::dvec3 at = (position - centre.position) / radius_;
    at /= std::sqrt(1 + glm::dot(at, at));
    const glm::dvec3 squares = at * at, turn = direction - centre.direction;
    if (is_isotropic_) {
        return {1,         at.x,      at.y,        at.z,        squares.x,
                squares.y, squares.z, at.x * at.y, at.y * at.z, at.z * at.x};
    }
    return {1,         at.x,      at.y,      at.z,        turn.x,      turn.y,     turn.z,
            squares.x, squares.y, squares.z, at.x * at.y, at.y * at.z, at.z * at.x};
}

// Three sites a coefficient.
std::size_t InnerField::count_functions(std::size_t sites) const {
    const std::size_t linear = is_isotropic_ ? 4 : 7;
    return sites >= 3 * (linear + 6) ? linear + 6 : sites >= 3 * linear ? linear : 1;
}

// Within the radius, and farther along the flight, where sites are few. Those below other surfaces
// lie closer together there than flights scatter, and would outweigh all others.
std::vector<InnerField::Neighbour> InnerField::collect(const WalkSpace& space,
                                                       const BodyPoint& point,
                                                       const Centre& centre) const {
    const glm::vec3 along = glm::normalize(centre.direction);
    const float stretch = std::max(1.0f, reach_of(space) / radius_);
    std::vector<std::uint32_t> around;
    std::vector<Neighbour> near;
    std::vector<glm::vec3> places;
    // Flights of thin media go far beyond the body.
    const float deepest = std::max(0.0f, depth_below(centre.position, point.normal));
    const int steps = static_cast<int>(std::ceil(std::min(stretch - 0.5f, deepest + 1)));
    for (int step = 0; step <= steps; ++step) {
        const glm::vec3 below = static_cast<float>(step) * radius_ * point.normal;
        grid_.collect_around(grid_.cell_of(centre.position - below), around);
        for (const std::uint32_t s : around) {
            const glm::vec3 d = (position_[s] - centre.position) / radius_;
            const float down = -glm::dot(d, point.normal);
            if (std::max(0.0f, std::round(down)) != static_cast<float>(step)) {
                continue;  // of another step
            }
            const float square = glm::dot(d, d) - down * down;
            const float deep = down > 0 ? down / stretch : down;
            float kernel = std::max(0.0f, 1 - square - deep * deep);
            if (!is_isotropic_) {
                kernel *= std::max(0.0f, glm::dot(arrival_[s], along));
            }
            if (kernel > 0) {
                near.push_back({s, static_cast<double>(kernel)});
                places.push_back(position_[s]);
            }
        }
    }
    std::vector<std::uint8_t> seen;
    find_seen(space, point.inner, places, seen);
    std::vector<Neighbour> neighbours;
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (seen[i] != 0) {
            const auto kernel = static_cast<float>(near[i].kernel);
            const float depth = glm::dot(point.position - places[i], point.normal);
            const float shade = std::exp(std::min(0.0f, (depth_[near[i].site] - depth) / path_));
            neighbours.push_back({near[i].site, static_cast<double>(kernel * (kernel * shade))});
        }
    }
    return neighbours.size() < std::min(kFewest, position_.size()) ? nearest(centre) : neighbours;
}

// On a part smaller than sites are apart, or out of their sight.
std::vector<InnerField::Neighbour> InnerField::nearest(const Centre& centre) const {
    std::vector<std::uint32_t> around;
    grid_.collect_around(grid_.cell_of(centre.position), around);
    if (around.size() < kFewest) {
        around.resize(position_.size());
        for (std::uint32_t s = 0; s < around.size(); ++s) {
            around[s] = s;
        }
    }
    const auto distance = [&](std::uint32_t s) {
        return glm::distance(position_[s], centre.position);
    };
    const std::size_t taken = std::min(kFewest, around.size());
    std::partial_sort(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(taken),
                      around.end(), [&](std::uint32_t a, std::uint32_t b) {
                          const float to_a = distance(a), to_b = distance(b);
                          return to_a < to_b || (to_a == to_b && a < b);
                      });
    std::vector<Neighbour> neighbours;
    for (std::size_t i = 0; i < taken; ++i) {
        neighbours.push_back({around[i], 1});
    }
    return neighbours;
}

void InnerField::weigh(const WalkSpace& space, const BodyPoint& point, const ViewSet& views,
                       const FirstFlight& flight, std::uint32_t rows,
                       std::vector<InnerWeight>& weights) const {
    weights.clear();
    Centre centre;
    float sum = 0;
    for (const FlightNode& node : flight) {
        const float weight = node.weight[0] * views.share[node.view][0];
        centre.position += weight * node.position;
        centre.direction += weight * node.direction;
        sum += weight;
    }
    if (!(sum > 0) || empty()) return;
    centre.position /= sum;
    centre.direction /= sum;
    const std::vector<Neighbour> neighbours = collect(space, point, centre);
    const std::size_t functions = count_functions(neighbours.size());
    const std::size_t groups = space.bands.size();

    // What the flight makes of each function, column by column: rows of each group.
    using ByFunction = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const std::size_t columns = groups * rows;
    ByFunction moments =
        ByFunction::Zero(static_cast<Eigen::Index>(functions), static_cast<Eigen::Index>(columns));
    for (std::size_t first = 0, end = 0; first < flight.size(); first = end) {
        const std::uint32_t view = flight[first].view;
        std::array<Functions, 3> of_view{};  // of each group
        for (end = first; end < flight.size() && flight[end].view == view; ++end) {
            const FlightNode& node = flight[end];
            const Functions at = eval(centre, node.position, node.direction);
            for (std::size_t g = 0; g < groups; ++g) {
                const auto weight = static_cast<double>(node.weight[g]);
                for (std::size_t f = 0; f < functions; ++f) {
                    of_view[g][f] += weight * at[f];
                }
            }
        }
        for (std::size_t f = 0; f < functions; ++f) {
            double* const to = moments.data() + f * columns;
            for (std::size_t g = 0; g < groups; ++g) {
                for (std::size_t r = 0; r < rows; ++r) {
                    to[g * rows + r] += static_cast<double>(views.share[view][r]) * of_view[g][f];
                }
            }
        }
    }
    const auto size = static_cast<Eigen::Index>(functions);
    ByFunction matrix = ByFunction::Zero(size, size);  // its lower half
    std::vector<Functions> at;
    at.reserve(neighbours.size());
    for (const Neighbour& n : neighbours) {
        const Functions& own = at.emplace_back(eval(centre, position_[n.site], arrival_[n.site]));
        for (std::size_t i = 0; i < functions; ++i) {
            const double factor = n.kernel * own[i];
            double* const to = matrix.data() + i * functions;
            for (std::size_t j = 0; j <= i; ++j) {
                to[j] += factor * own[j];
            }
        }
    }
    // Slopes along directions without sites are 0.
    constexpr double kRidge = 1e-4;
    for (Eigen::Index i = 1; i < size; ++i) {
        matrix(i, i) += kRidge * matrix(0, 0);
    }
    const ByFunction solved = matrix.ldlt().solve(moments);
    weights.reserve(neighbours.size());
    for (std::size_t s = 0; s < neighbours.size(); ++s) {
        std::array<double, 3 * (1 + kAllDegrees)> value{};
        for (std::size_t f = 0; f < functions; ++f) {
            const double factor = neighbours[s].kernel * at[s][f];
            const double* const from = solved.data() + f * columns;
            for (std::size_t c = 0; c < columns; ++c) {
                value[c] += factor * from[c];
            }
        }
        InnerWeight& weight = weights.emplace_back();
        weight.site = neighbours[s].site;
        for (std::size_t g = 0; g < groups; ++g) {
            for (std::size_t r = 0; r < rows; ++r) {
                weight.row[r][g] = static_cast<float>(value[g * rows + r]);
            }
        }
    }
}

std::vector<WalkStart> make_inner_starts(const WalkSpace& space,
                                         std::span<const SurfaceSample> sites,
                                         const Context& context) {
    constexpr float kBeforeSurface = 0.999f;
    float sigma_t = 0;
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        sigma_t += space.media.front().sigma_t[g] / static_cast<float>(space.bands.size());
    }
    std::vector<WalkStart> starts = make_walk_starts(space, sites, context);
    for (std::size_t i = 0; i < starts.size(); ++i) {
        WalkStart& start = starts[i];
        start.arrival = entering_direction(space, start, lattice(i, 0), lattice(i, 1));
        WalkHit hit;
        // Through a hole: a mean free path deep.
        const float distance = find_hit(space, start.position, start.arrival,
                                        std::numeric_limits<float>::infinity(), hit)
                                   ? glm::distance(hit.position, start.position)
                                   : 1 / sigma_t;
        const float length = -std::log1p(std::expm1(-sigma_t * distance) * lattice(i, 2)) / sigma_t;
        const glm::vec3 way = std::min(length, kBeforeSurface * distance) * start.arrival;
        start.position += way;
        start.depth = std::max(0.0f, -glm::dot(way, start.normal));
    }
    return starts;
}

}  // namespace opaline::bake
