#include "bake/scene/marble.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/noise.hpp>
#include <numbers>

namespace opaline::bake {
namespace {

using formats::Rgb;

constexpr int kOctaves = 5;
constexpr double kDistortion = 2;  // amplitude of the veins' distortion, in distances between veins
constexpr double kLargestFeature = 2;  // of the noise, in the same unit
const glm::dvec3 kAcross = glm::normalize(glm::dvec3(0.8, 0.5, 0.6));

// GLM's noise repeats after this many units on each axis. Folding in double precision keeps
// positions far away finite.
double fold(double x) {
    constexpr double kPeriod = 289;
    return x - kPeriod * std::floor(x / kPeriod);
}

double gradient_noise(glm::dvec3 p) {
    const double n = glm::perlin(glm::dvec3(fold(p.x), fold(p.y), fold(p.z)));
    return std::clamp(n, -1.0, 1.0);
}

double turbulence(glm::dvec3 p) {
    double sum = 0, weight = 1;
    for (int octave = 0; octave < kOctaves; ++octave, weight /= 2) {
        const glm::dvec3 shift = (octave + 1.0) * glm::dvec3(0.37, 0.71, 0.53);
        sum += weight * std::abs(gradient_noise(p / weight + shift));
    }
    return sum;
}

Rgb ramp(const std::vector<Rgb>& colors, double at) {
    const double place = at * static_cast<double>(colors.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
    const float share = static_cast<float>(place - static_cast<double>(below));
    const Rgb color = (1 - share) * colors[below] + share * colors[below + 1];
    const auto unit = [](float band) { return std::clamp(band, 0.0f, 1.0f); };
    return {unit(color.r), unit(color.g), unit(color.b)};
}

}  // namespace

Rgb marble_color(const formats::Marble& marble, glm::dvec3 position) {
    const glm::dvec3 q = position / static_cast<double>(marble.scale);
    const double u = glm::dot(kAcross, q) + kDistortion * turbulence(q / kLargestFeature);
    return ramp(marble.colors, std::abs(std::sin(std::numbers::pi * u)));
}

}  // namespace opaline::bake
