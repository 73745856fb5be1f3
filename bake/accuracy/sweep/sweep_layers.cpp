#include "bake/accuracy/sweep/sweep_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/layers/stored_tables.h"

namespace opaline::bake {
namespace {

// Between the nodes of tables of any size; from thin to thick, and as layer_error draws them.
constexpr std::array kDepths{0.4, 1.7, 6.3, 21.0};
constexpr std::array kLights{0.21, 0.47, 0.83};
constexpr std::array kViews{0.13, 0.37, 0.61, 0.91};
constexpr unsigned kAzimuths = 5;
constexpr std::size_t kGroup = kViews.size() * kAzimuths;

}  // namespace

std::vector<double> read_layer_radiance(const formats::CloudsView& clouds) {
    std::vector<double> radiance;
    for (const formats::LayerRecord& record : clouds.records) {
        for (std::size_t band = 0; band < record.band.size(); ++band) {
            const StoredTables tables = read_tables(clouds, record, band);
            for (const double depth : kDepths) {
                for (const double light : kLights) {
                    for (const bool transmitted : {false, true}) {
                        for (std::size_t i = 0; i < kGroup; ++i) {
                            const double azimuth = std::numbers::pi / kAzimuths *
                                                   (static_cast<double>(i % kAzimuths) + 0.4);
                            radiance.push_back(eval_scattered(
                                tables, depth, light, kViews[i / kAzimuths], azimuth, transmitted));
                        }
                    }
                }
            }
        }
    }
    return radiance;
}

void scale_layer_radiance(std::span<PointRecord> points) {
    if (points.empty()) return;
    std::vector<double> scale;
    const std::vector<double>& first = points.front().layer_radiance;
    for (std::size_t begin = 0; begin + kGroup <= first.size(); begin += kGroup) {
        double square = 0;
        for (std::size_t i = begin; i < begin + kGroup; ++i) {
            square += first[i] * first[i] / static_cast<double>(kGroup);
        }
        scale.push_back(square > 0 ? 1 / std::sqrt(square) : 0);
    }
    for (PointRecord& point : points) {
        for (std::size_t i = 0; i < point.layer_radiance.size(); ++i) {
            point.layer_radiance[i] *= scale[i / kGroup];
        }
    }
}

void take_larger(ErrorReport& error, const LayerErrorReport& layer) {
    if (error.receivers_checked == 0 || layer.rms_relative > error.rms_relative) {
        error.rms_relative = layer.rms_relative;
        std::ranges::copy(layer.ci95, error.ci95);
        error.max_relative = layer.worst;
    }
    if (error.receivers_checked > 0) {
        error.reference += "; clouds: " + layer.reference;
    }
    error.receivers_checked += layer.radiances_checked;
}

}  // namespace opaline::bake
