#include "runtime/picture/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace opaline::runtime {
namespace {

constexpr double kDim = 1.0 / 64, kBright = 1.5, kShown = 0.35, kMostRaised = 10;
constexpr double kToShown = 3;  // [EV] above kBright

}  // namespace

Camera meter_camera(const Camera& camera) {
    constexpr double kMost = 96;
    const double scale = std::min(1.0, kMost / std::max({camera.width, camera.height, 1u}));
    Camera small = camera;
    small.width = std::max(1u, static_cast<std::uint32_t>(std::lround(scale * camera.width)));
    small.height = std::max(1u, static_cast<std::uint32_t>(std::lround(scale * camera.height)));
    return small;
}

float choose_exposure(const Picture& metered) {
    std::vector<double> stops;
    for (const formats::Rgb pixel : metered.pixel) {
        const auto y = static_cast<double>(formats::luminance(pixel));
        if (y > 0 && std::isfinite(y)) stops.push_back(std::log2(y));
    }
    if (stops.empty()) return 0;
    std::ranges::sort(stops, std::greater<>());
    stops.resize((stops.size() + 1) / 2);
    double sum = 0;
    for (const double stop : stops)
        sum += stop;
    const double mean = sum / static_cast<double>(stops.size());
    const double over = mean - std::log2(kBright), under = std::log2(kDim) - mean;
    double exposure = 0;
    if (over > 0) {
        const double dimmer = std::log2(kShown / kBright) * std::min(1.0, over / kToShown);
        exposure = dimmer - over;
    } else if (under > 0) {
        exposure = std::min(under, kMostRaised);
    }
    return static_cast<float>(std::round(100 * exposure) / 100);
}

}  // namespace opaline::runtime
