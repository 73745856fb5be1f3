#include "bake/accuracy/sweep/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace opaline::bake {
namespace {

using runtime::Picture;

double difference_at(const Picture& picture, const Picture& truth, std::size_t i) {
    return static_cast<double>(formats::luminance(picture.pixel[i])) -
           static_cast<double>(formats::luminance(truth.pixel[i]));
}

double round_up(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (value <= step * decade * (1 + 1e-9)) {
            return step * decade;
        }
    }
    return 10 * decade;
}

}  // namespace

double difference_scale(std::span<const Picture* const> pictures, const Picture& truth) {
    constexpr double kShown = 0.98;
    std::vector<double> differences;
    for (const Picture* picture : pictures) {
        for (std::size_t i = 0; i < truth.pixel.size(); ++i) {
            if (const double d = std::abs(difference_at(*picture, truth, i)); d > 0) {
                differences.push_back(d);
            }
        }
    }
    if (differences.empty()) {
        return 1.0;
    }
    const auto place =
        differences.begin() +
        static_cast<std::ptrdiff_t>(kShown * static_cast<double>(differences.size() - 1));
    std::nth_element(differences.begin(), place, differences.end());
    return round_up(*place);
}

formats::Image8 draw_difference(const Picture& picture, const Picture& truth, double scale) {
    constexpr std::array<double, 3> kDarker{0, 114, 178}, kBrighter{213, 94, 0};
    formats::Image8 image{truth.width, truth.height, {}};
    image.rgba.reserve(4 * truth.pixel.size());
    for (std::size_t i = 0; i < truth.pixel.size(); ++i) {
        const double d = std::clamp(difference_at(picture, truth, i) / scale, -1.0, 1.0);
        const std::array<double, 3>& full = d < 0 ? kDarker : kBrighter;
        for (const double band : full) {
            image.rgba.push_back(
                static_cast<std::uint8_t>(std::lround(255 + std::abs(d) * (band - 255))));
        }
        image.rgba.push_back(255);
    }
    return image;
}

}  // namespace opaline::bake
