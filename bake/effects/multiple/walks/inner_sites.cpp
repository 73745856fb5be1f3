#include "bake/effects/multiple/walks/inner_sites.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

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
