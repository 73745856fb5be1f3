#include "bake/effects/transmission/true_transmission.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/effects/transmission/straight_rows.h"
#include "bake/effects/transmission/view_fit.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
constexpr double kSpreadAs = 256;  // views: 5 degrees
// Tells the keys of paths from surfaces apart from those of receivers.
constexpr std::uint64_t kOfViews = std::uint64_t{1} << 63;

double luminance_of(const StraightExit& exit, std::uint32_t bands) {
    double sum = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += kLuminance[b] * static_cast<double>(exit.weight[bands == 1 ? 0 : b]);
    }
    return sum;
}

// Unit, within the cone of that cosine around an axis, evenly.
glm::vec3 random_around(glm::vec3 axis, double cosine, float u, float v) {
    const double c = 1 - (1 - cosine) * static_cast<double>(u), sine = std::sqrt(1 - c * c);
    const double azimuth = 2 * std::numbers::pi * static_cast<double>(v);
    return make_frame(axis).to_world(
        glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), c)));
}

void add_light(const StraightTruth& truth, glm::vec3 direction, double weight,
               const std::array<float, 4>& u, Luminance& sum) {
    const double cosine = spread_cosine(kSpreadAs);
    const double solid_angle = 2 * std::numbers::pi * (1 - cosine);
    const float* const radiance =
        truth.smooth.towards(random_around(direction, cosine, u[2], u[3]));
    for (std::size_t l = 0; l < truth.lights.size(); ++l) {
        sum[l] += weight * static_cast<double>(radiance[l]);
        for (const TestDisc& disc : truth.lights[l].discs) {
            if (static_cast<double>(glm::dot(direction, disc.direction)) > cosine) {
                sum[l] += weight * disc.flux / solid_angle;
            }
        }
    }
}

// The same of a surface, by one path. `number`: of the exit.
std::uint64_t add_surface(const StraightTruth& truth, const StraightExit& exit, std::uint32_t bands,
                          double weight, std::uint64_t key, std::uint32_t number, Luminance& sum) {
    Luminance seen(sum.size());
    const formats::Rgb share{exit.weight[0], exit.weight[bands == 1 ? 0 : 1],
                             exit.weight[bands == 1 ? 0 : 2]};
    const std::uint64_t rays =
        truth.surfaces({exit.origin, exit.direction}, share, key, number, seen);
    for (std::size_t l = 0; l < sum.size(); ++l) {
        sum[l] += weight * seen[l];
    }
    return rays;
}

}  // namespace

TwoEstimates see_lights_through(const StraightBody& body, const StraightTruth& truth,
                                const BodyPoint& point, glm::vec3 toward, std::uint64_t seed,
                                std::uint32_t key, std::uint64_t& traced) {
    const std::size_t lights = truth.lights.size();
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (point.normal == glm::vec3(0)) {
        return estimates;
    }
    const ViewKernel kernel(point.normal, body.eta, truth.terms,
                            toward == glm::vec3(0) ? point.normal : toward);
    const double mean = 1 - fresnel_moments(body.eta).external;
    const StraightStart start = make_straight_start(body, point, traced);
    const Frame frame = make_frame(point.normal);
    std::vector<glm::vec3> seen;
    std::vector<double> weight;
    std::vector<std::array<float, 4>> random;
    std::vector<double> share;
    StraightLight found;
    std::uint32_t number = 0, looks = 0;
    for (Luminance* estimate : {&estimates.first, &estimates.second}) {
        seen.clear(), weight.clear(), random.clear(), share.clear();
        found = {};
        for (std::uint32_t i = 0; i < truth.views; ++i, ++number) {
            // Cosine-distributed, c^2 stratified.
            const auto u = random_uniform(seed, RandomStage::true_straight_views, key, number);
            const double c = std::sqrt(1 - (i + static_cast<double>(u[0])) / truth.views);
            const double passed = fresnel_transmittance(c, body.eta);
            if (!(passed > 0)) {
                continue;
            }
            const double inside = refracted_cosine(c, body.eta);
            const double sine = std::sqrt(1 - inside * inside);
            const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[1]);
            seen.push_back(glm::normalize(frame.to_world(glm::vec3(
                glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), inside)))));
            share.push_back(passed / (mean * truth.views));
            weight.push_back(share.back() * kernel(seen.back()));
            random.push_back(u);
        }
        traced += follow_straight(body, start, seen, found);
        double left = 1;
        for (const std::uint32_t i : found.past) {
            left -= share[i];
        }
        if (!(left > 0)) {
            continue;
        }
        for (const StraightExit& exit : found.exits) {
            add_light(truth, exit.direction,
                      weight[exit.view] / left * luminance_of(exit, body.bands), random[exit.view],
                      *estimate);
        }
        if (truth.surfaces) {
            for (const StraightExit& exit : found.blocked) {
                traced += add_surface(truth, exit, body.bands, weight[exit.view] / left,
                                      kOfViews | key, looks++, *estimate);
            }
        }
    }
    return estimates;
}

}  // namespace opaline::bake
