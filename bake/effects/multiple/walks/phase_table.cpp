#include "bake/effects/multiple/walks/phase_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/scattering/phase.h"

namespace opaline::bake {

PhaseTable make_phase_table(const formats::PhaseFunction& phase) {
    using Type = formats::PhaseFunction::Type;
    PhaseTable table;
    table.type = phase.type;
    table.g = static_cast<double>(phase.g);
    if (phase.type == Type::isotropic || phase.type == Type::henyey_greenstein) {
        return table;
    }
    // Steps of s, cosine = 1 - 2 s^2: fine where functions have their peak. p dcosine = 4 s p ds.
    constexpr std::size_t kFineSteps = 65536, kStored = 4096;
    const PhaseDensity density = make_phase_density(phase);
    const auto cosine_at = [](double s) { return 1 - 2 * s * s; };
    std::vector<double> cumulative{0};
    for (std::size_t i = 0; i < kFineSteps; ++i) {
        const double s = (static_cast<double>(i) + 0.5) / kFineSteps;
        cumulative.push_back(cumulative.back() + s * eval_phase(density, cosine_at(s)));
    }
    std::size_t at = 0;
    for (std::size_t k = 0; k <= kStored; ++k) {
        const double wanted = cumulative.back() * static_cast<double>(k) / kStored;
        while (at + 1 < kFineSteps && cumulative[at + 1] < wanted) {
            ++at;
        }
        const double width = cumulative[at + 1] - cumulative[at];
        const double part = width > 0 ? std::clamp((wanted - cumulative[at]) / width, 0.0, 1.0) : 0;
        table.cosine.push_back(
            static_cast<float>(cosine_at((static_cast<double>(at) + part) / kFineSteps)));
    }
    return table;
}

double mean_cosine(const PhaseTable& table) {
    if (table.cosine.empty()) {
        return table.g;
    }
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.cosine.size(); ++i) {
        sum += 0.5 * static_cast<double>(table.cosine[i] + table.cosine[i + 1]);
    }
    return sum / static_cast<double>(table.cosine.size() - 1);
}

float sample_cosine(const PhaseTable& table, float u) {
    if (!table.cosine.empty()) {
        const float place = u * static_cast<float>(table.cosine.size() - 1);
        const auto i = std::min(static_cast<std::size_t>(place), table.cosine.size() - 2);
        const float part = place - static_cast<float>(i);
        return table.cosine[i] + part * (table.cosine[i + 1] - table.cosine[i]);
    }
    const double x = static_cast<double>(u), g = table.g;
    if (std::abs(g) < 1e-4) {
        // To first order in g; the closed form divides by it.
        const double c = 1 - 2 * x;
        return static_cast<float>(std::clamp(c + 1.5 * g * (1 - c * c), -1.0, 1.0));
    }
    const double s = (1 - g * g) / (1 + g - 2 * g * x);
    return static_cast<float>(std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0));
}

glm::vec3 scatter(const PhaseTable& table, glm::vec3 direction, float u, float v) {
    const float cosine = sample_cosine(table, u);
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    const glm::vec3 turned = make_frame(direction).to_world(
        {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
    return glm::normalize(turned);  // thousands of turns would add up their rounding
}

}  // namespace opaline::bake
