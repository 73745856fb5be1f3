#include "formats/media/presets.h"

#include <algorithm>
#include <array>

namespace opaline::formats {

namespace {

struct Measured {
    std::string_view name;
    std::array<double, 3> sigma_s_prime_per_mm, sigma_a_per_mm;
};

constexpr std::array<Measured, 12> kMeasured = {{
    {"apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}},
    {"chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}},
    {"cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},
    {"marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}},
    {"skim-milk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},
    {"skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"spectralon", {11.6, 20.4, 14.9}, {0.0, 0.0, 0.0}},
    {"whole-milk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
}};

constexpr std::array<std::string_view, kMeasured.size()> kNames = [] {
    std::array<std::string_view, kMeasured.size()> names;
    std::transform(kMeasured.begin(), kMeasured.end(), names.begin(),
                   [](const Measured& measured) { return measured.name; });
    return names;
}();

Rgb per_metre(const std::array<double, 3>& per_mm) {
    return {static_cast<float>(1000.0 * per_mm[0]), static_cast<float>(1000.0 * per_mm[1]),
            static_cast<float>(1000.0 * per_mm[2])};
}

}  // namespace

std::optional<Medium> media_preset(std::string_view name) {
    if (name == "skimmilk") {
        name = "skim-milk";
    }
    for (const Measured& measured : kMeasured) {
        if (name == measured.name) {
            Medium medium;
            medium.sigma_s = per_metre(measured.sigma_s_prime_per_mm);
            medium.sigma_a = per_metre(measured.sigma_a_per_mm);
            medium.eta = name == "marble" ? 1.5f : 1.3f;
            return medium;
        }
    }
    return std::nullopt;
}

std::span<const std::string_view> media_preset_names() {
    return kNames;
}

}  // namespace opaline::formats
