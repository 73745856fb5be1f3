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

}  // namespace

TwoEstimates see_lights_through(const StraightBody& body, const StraightTruth& truth,
                                const BodyPoint& point, std::uint64_t seed, std::uint32_t key,
                                std::uint64_t& traced) {
    const std::size_t lights = truth.lights.size();
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (point.normal == glm::vec3(0)) {
        return estimates;
    }
    const ViewKernel kernel(point.normal, body.eta, truth.terms, point.normal);
    const double mean = 1 - fresnel_moments(body.eta).external;
    const StraightStart start = make_straight_start(body, point, traced);
    const Frame frame = make_frame(point.normal);
    std::vector<glm::vec3> seen;
    std::vector<double> weight;
    std::vector<std::array<float, 4>> random;
    std::vector<double> share;
    std::vector<StraightExit> exits;
    std::vector<std::uint32_t> past;
    std::uint32_t number = 0;
    for (Luminance* estimate : {&estimates.first, &estimates.second}) {
        seen.clear(), weight.clear(), random.clear(), exits.clear(), share.clear(), past.clear();
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
        traced += follow_straight(body, start, seen, exits, past);
        double left = 1;
        for (const std::uint32_t i : past) {
            left -= share[i];
        }
        if (!(left > 0)) {
            continue;
        }
        for (const StraightExit& exit : exits) {
            add_light(truth, exit.direction,
                      weight[exit.view] / left * luminance_of(exit, body.bands), random[exit.view],
                      *estimate);
        }
    }
    return estimates;
}

}  // namespace opaline::bake
