#include "runtime/clouds/layer_field.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace opaline::runtime {
namespace {

// How far the wind has moved the layer [m]. Endless layers look the same after every period.
double wind_offset(double speed, double time, double period, bool repeats) {
    const double offset = speed * time;
    if (!std::isfinite(offset)) return 0;
    return repeats ? std::remainder(offset, period) : offset;
}

}  // namespace

float LayerField::level_of(double length) const {
    return static_cast<float>(std::log2(std::max(length, 1e-30) / cell));
}

LayerField make_layer_field(const formats::LayerRecord& record,
                            std::span<const std::uint16_t> codes, double time) {
    std::vector<float> thickness;
    thickness.reserve(codes.size());
    for (const std::uint16_t code : codes) {
        thickness.push_back(record.highest * (static_cast<float>(code) / 65535.0f));
    }
    LayerField field;
    field.thickness = make_pyramid(record.columns, record.rows, std::move(thickness),
                                   record.repeats() ? MipBorder::repeat : MipBorder::zero);
    field.size_x = static_cast<double>(record.size[0]);
    field.size_z = static_cast<double>(record.size[1]);
    field.low_x =
        static_cast<double>(record.center[0]) - field.size_x / 2 +
        wind_offset(static_cast<double>(record.wind[0]), time, field.size_x, record.repeats());
    field.low_z =
        static_cast<double>(record.center[1]) - field.size_z / 2 +
        wind_offset(static_cast<double>(record.wind[1]), time, field.size_z, record.repeats());
    field.base = record.base;
    field.highest = record.highest;
    field.cell = std::max(field.size_x / record.columns, field.size_z / record.rows);
    return field;
}

float sample_thickness(const LayerField& field, double x, double z, float level) {
    return sample_pyramid(field.thickness, (x - field.low_x) / field.size_x,
                          (z - field.low_z) / field.size_z, level);
}

LayerSlope sample_slope(const LayerField& field, double x, double z, float level) {
    const double last = static_cast<double>(field.thickness.level.size() - 1);
    const double step = field.cell * std::exp2(std::clamp(static_cast<double>(level), 0.0, last));
    const auto at = [&](double dx, double dz) {
        return sample_thickness(field, x + dx, z + dz, level);
    };
    const float per_metre = static_cast<float>(0.5 / step);
    return {per_metre * (at(step, 0) - at(-step, 0)), per_metre * (at(0, step) - at(0, -step))};
}

}  // namespace opaline::runtime
