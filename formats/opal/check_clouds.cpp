#include "formats/opal/check_clouds.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>

#include "formats/opal/used_part.h"

namespace opaline::formats {
namespace {

constexpr const char *kCloudsSection = "section CLOU", *kLayer = "section CLOU, layer";

// False for NaN.
bool lies_within(float x, float low, float high) {
    return x >= low && x <= high;
}

bool is_coordinate(float x) {
    return lies_within(x, -kMaxLayerLength, kMaxLayerLength);
}

bool is_side(std::uint32_t cells) {
    return cells >= 1 && cells <= kMaxLayerSide;
}

std::string find_place_fault(const LayerRecord& layer) {
    if (!is_coordinate(layer.base) || !is_coordinate(layer.ground) ||
        !(layer.base > layer.ground)) {
        return "its base at " + number_in_fault(layer.base) + " m is not above its ground at " +
               number_in_fault(layer.ground) + " m, or is too far from 0";
    }
    const float lengths[] = {layer.center[0], layer.center[1], layer.wind[0], layer.wind[1]};
    if (!std::all_of(std::begin(lengths), std::end(lengths), is_coordinate)) {
        return "its centre or wind is not finite, or too far from 0";
    }
    for (const float size : layer.size) {
        if (!lies_within(size, kMinLayerSize, kMaxLayerLength)) {
            return "it is " + number_in_fault(size) + " m wide; expected 0.001 m or more";
        }
    }
    if (!lies_within(layer.highest, 0, kMaxLayerLength)) {
        return "its largest thickness of " + number_in_fault(layer.highest) +
               " m is below zero or not finite";
    }
    if (!lies_within(layer.haze, 0, kMaxLayerExtinction)) {
        return "its haze of " + number_in_fault(layer.haze) +
               " per metre is below zero or not finite";
    }
    constexpr std::uint32_t kKnown =
        LayerRecord::kRepeat | LayerRecord::kRadiosity | LayerRecord::kLoop | LayerRecord::kPaper;
    if ((layer.flags & ~kKnown) != 0) return "it has flags that only later versions know";
    return {};
}

std::string find_frame_fault(const LayerRecord& layer) {
    if (layer.frames < 1 || layer.frames > kMaxLayerFrames) {
        return "it has " + number_in_fault(layer.frames) + " frames of thickness; expected 1 to " +
               number_in_fault(kMaxLayerFrames);
    }
    const bool moves = layer.frames > 1;
    if (moves ? !lies_within(layer.frame_seconds, kMinFrameSeconds, kMaxFrameSeconds)
              : layer.frame_seconds != 0) {
        return "its frames of thickness are " + number_in_fault(layer.frame_seconds) +
               " s apart; expected 0.001 to 1e9, and 0 of one frame";
    }
    if (!moves && layer.loops()) return "it has one frame of thickness and says that they loop";
    return {};
}

std::string find_band_fault(const LayerRecord& layer) {
    if (!(layer.peak_angle >= 0 && layer.peak_angle < std::numbers::pi_v<float> / 2)) {
        return "its forward peak of " + number_in_fault(layer.peak_angle) +
               " rad is not in 0 ... pi / 2 (exclusive)";
    }
    for (const LayerBand& band : layer.band) {
        if (!lies_within(band.kappa, 0, kMaxLayerExtinction)) {
            return "its extinction of " + number_in_fault(band.kappa) +
                   " per metre is below zero or not finite";
        }
        if (!(band.peak_weight >= 0 && band.peak_weight < 1) ||
            (layer.peak_angle == 0 && band.peak_weight != 0)) {
            return "its forward peak has " + number_in_fault(band.peak_weight) +
                   " of the light; expected less than 1, and 0 where the peak has no angle";
        }
        if (!(std::abs(band.g) < 1)) {
            return "a mean cosine of " + number_in_fault(band.g) +
                   " is not in -1 ... 1 (exclusive)";
        }
        if (band.reserved != 0) return "a band has a value that only later versions know";
    }
    return {};
}

std::string find_count_fault(const LayerRecord& layer) {
    if (!is_side(layer.columns) || !is_side(layer.rows) || !is_side(layer.ground_columns) ||
        !is_side(layer.ground_rows)) {
        return "its thickness has " + number_in_fault(layer.columns) + " x " +
               number_in_fault(layer.rows) + " cells, its ground " +
               number_in_fault(layer.ground_columns) + " x " + number_in_fault(layer.ground_rows) +
               "; expected 1 to " + number_in_fault(kMaxLayerSide) + " along an edge";
    }
    if (layer.phase_angles < 2 || layer.flux_depths < 2 || layer.flux_cosines < 2) {
        return "its phase function has " + number_in_fault(layer.phase_angles) +
               " angles, its table of flux " + number_in_fault(layer.flux_depths) + " depths and " +
               number_in_fault(layer.flux_cosines) + " cosines; expected 2 or more each";
    }
    const bool has_no_glow = layer.glow_angles == 0 && layer.glow_events == 0;
    const bool has_glow = layer.glow_angles >= 2 && layer.glow_events >= 2;
    if (!(layer.peak_angle > 0 ? has_glow : has_no_glow)) {
        return "its glow has " + number_in_fault(layer.glow_angles) + " angles and " +
               number_in_fault(layer.glow_events) +
               " numbers of events; expected 2 or more each, or 0 where the forward peak has no "
               "angle";
    }
    const bool has_no_radiance =
        layer.radiance_depths == 0 && layer.radiance_cosines == 0 && layer.radiance_modes == 0;
    const bool has_radiance =
        layer.radiance_depths >= 2 && layer.radiance_cosines >= 2 && layer.radiance_modes >= 1;
    if (!has_no_radiance && !has_radiance) {
        return "its tables of radiance have " + number_in_fault(layer.radiance_depths) +
               " depths, " + number_in_fault(layer.radiance_cosines) + " cosines and " +
               number_in_fault(layer.radiance_modes) +
               " modes; expected 2, 2 and 1 or more, or all 0";
    }
    return {};
}

// The product where it is at most `limit`, which any of the counts and steps on the way may exceed.
std::optional<std::uint64_t> product_within(std::uint64_t limit,
                                            std::initializer_list<std::uint32_t> counts) {
    std::uint64_t product = 1;
    for (const std::uint32_t count : counts) {
        if (count != 0 && product > limit / count) return std::nullopt;
        product *= count;
    }
    return product;
}

struct UsedLayerParts {
    UsedPart thickness, ground, values;
};

// Counts are those that find_count_fault lets pass.
std::string find_part_fault(const CloudsView& clouds, const LayerRecord& layer,
                            UsedLayerParts& used) {
    const std::uint64_t values = clouds.value.size();
    if (!product_within(values, {layer.glow_angles, layer.glow_events}) ||
        !product_within(values, {layer.flux_depths, layer.flux_cosines}) ||
        !product_within(values, {layer.radiance_depths, layer.radiance_modes,
                                 layer.radiance_cosines, layer.radiance_cosines})) {
        return "a table of it is larger than all tables";
    }
    // None of the terms in value_count() is beyond 32 bits or the size of an array in memory now:
    // their sum cannot overflow. Sides and frames cannot either, see kMaxLayerSide.
    if (!used.thickness.take(layer.first_thickness, layer.thickness_count(),
                             clouds.thickness.size()) ||
        !used.ground.take(layer.first_ground, layer.ground_count(), clouds.ground.size()) ||
        !used.values.take(layer.first_value, layer.value_count(), values)) {
        return "its thickness, ground or tables lie outside their arrays, or overlap with those "
               "of another layer";
    }
    return {};
}

bool all_within(std::span<const float> values, float low, float high) {
    return std::all_of(values.begin(), values.end(),
                       [=](float x) { return lies_within(x, low, high); });
}

std::string find_table_fault(const LayerTables& tables) {
    if (!all_within(tables.log_phase, kMinLogPhase, kMaxLogPhase)) {
        return "the logarithm of its phase function is not in -100 ... 40";
    }
    if (!all_within(tables.glow, 0, kMaxLayerValue)) return "its glow is below zero or not finite";
    constexpr float kRounding = 1e-3f;  // of shares that are sums over directions
    for (const auto shares : {tables.t1, tables.t_ms, tables.r1, tables.mean_t}) {
        if (!all_within(shares, -kRounding, 1 + kRounding)) {
            return "a share of its flux is not in 0 ... 1";
        }
    }
    for (const auto radiance : {tables.reflected, tables.transmitted}) {
        if (!all_within(radiance, -kMaxLayerValue, kMaxLayerValue)) {
            return "a value of its tables of radiance is not finite, or too large";
        }
    }
    return {};
}

std::string find_layer_value_fault(const CloudsView& clouds, const LayerRecord& layer) {
    const auto ground = clouds.ground_of(layer);
    if (!std::all_of(ground.begin(), ground.end(),
                     [](const auto& color) { return color[3] == 255; })) {
        return "the last byte of a colour of the ground is not 255";
    }
    for (std::size_t band = 0; band < layer.band.size(); ++band) {
        std::string fault = find_table_fault(tables_of(clouds, layer, band));
        if (!fault.empty()) return "band " + number_in_fault(band) + ": " + fault;
    }
    return {};
}

}  // namespace

Fault find_clouds_fault(const CloudsView& clouds) {
    if (clouds.records.size() > kMaxLayers) {
        return {kCloudsSection, "it has " + number_in_fault(clouds.records.size()) +
                                    " layers; this version of " + "Opaline knows one at most"};
    }
    UsedLayerParts used;
    return find_fault_in(kLayer, clouds.records.size(), [&](std::size_t i) {
        const LayerRecord& layer = clouds.records[i];
        return find_first_fault(
            [&] { return find_place_fault(layer); }, [&] { return find_frame_fault(layer); },
            [&] { return find_band_fault(layer); }, [&] { return find_count_fault(layer); },
            [&] { return find_part_fault(clouds, layer, used); });
    });
}

Fault find_cloud_value_fault(const CloudsView& clouds) {
    return find_fault_in(kLayer, clouds.records.size(), [&](std::size_t i) {
        return find_layer_value_fault(clouds, clouds.records[i]);
    });
}

}  // namespace opaline::formats
