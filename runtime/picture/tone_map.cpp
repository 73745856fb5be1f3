#include "runtime/picture/tone_map.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace opaline::runtime {
namespace {

// Far below the float limit, so that sums of two stay finite.
constexpr float kLargest = 1e37f;

// NaN fails the comparison and becomes 0.
float finite_part(float value) {
    return value > 0.0f ? std::min(value, kLargest) : 0.0f;
}

formats::Rgb cut_off(formats::Rgb radiance) {
    return {std::min(finite_part(radiance.r), 1.0f), std::min(finite_part(radiance.g), 1.0f),
            std::min(finite_part(radiance.b), 1.0f)};
}

std::uint8_t encode_byte(float linear) {
    return static_cast<std::uint8_t>(std::lround(255.0f * encode_srgb(linear)));
}

constexpr double kDim = 1.0 / 64, kBright = 1.5, kShown = 0.35, kMostRaised = 10;
constexpr double kToShown = 3;  // [EV] above kBright

}  // namespace

formats::Rgb tone_map_neutral(formats::Rgb radiance) {
    constexpr float kReflectance = 0.04f;  // Fresnel reflectance at normal incidence, taken off
    constexpr float kShoulder = 0.8f - kReflectance;
    constexpr float kDesaturation = 0.15f;

    formats::Rgb c{finite_part(radiance.r), finite_part(radiance.g), finite_part(radiance.b)};
    const float least = std::min({c.r, c.g, c.b});
    const float offset =
        least < 2.0f * kReflectance ? least - least * least / (4.0f * kReflectance) : kReflectance;
    c = {c.r - offset, c.g - offset, c.b - offset};

    const float peak = std::max({c.r, c.g, c.b});
    if (peak <= kShoulder) return c;
    constexpr float kRoom = 1.0f - kShoulder;
    const auto compress = [](float x) {
        return x <= kShoulder ? x : 1.0f - kRoom * kRoom / (x + kRoom - kShoulder);
    };
    const float new_peak = compress(peak);
    const float keep = 1.0f / (kDesaturation * (peak - new_peak) + 1.0f);
    const auto desaturate = [&](float x) {
        return std::clamp(new_peak + keep * (compress(x) - new_peak), 0.0f, 1.0f);
    };
    return {desaturate(c.r), desaturate(c.g), desaturate(c.b)};
}

float encode_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

DisplayPicture tone_map(const Picture& picture, float exposure_ev, ToneMap map) {
    const float scale = std::exp2(std::clamp(exposure_ev, -100.0f, 100.0f));
    DisplayPicture display{picture.width, picture.height, {}};
    display.rgba.reserve(picture.pixel.size() * 4);
    for (const formats::Rgb pixel : picture.pixel) {
        const formats::Rgb c =
            map == ToneMap::neutral ? tone_map_neutral(scale * pixel) : cut_off(scale * pixel);
        display.rgba.insert(display.rgba.end(),
                            {encode_byte(c.r), encode_byte(c.g), encode_byte(c.b), 255});
    }
    return display;
}

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
