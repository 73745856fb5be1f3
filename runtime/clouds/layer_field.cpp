#include "runtime/clouds/layer_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace opaline::runtime {
namespace {

// How far the wind has moved the layer [m]. Endless layers look the same after every period.
double wind_offset(double speed, double time, double period, bool repeats) {
    const double offset = speed * time;
    if (!std::isfinite(offset)) return 0;
    return repeats ? std::remainder(offset, period) : offset;
}

// [m]
std::vector<float> blend_thickness(const formats::LayerRecord& record,
                                   std::span<const std::uint16_t> codes, const FrameBlend& blend) {
    const auto metres = [&](std::uint16_t code) {
        return record.highest * (static_cast<float>(code) / 65535.0f);
    };
    const std::size_t count = record.frame_count();
    const auto first = codes.subspan(blend.first * count, count);
    const auto second = codes.subspan(blend.second * count, count);
    std::vector<float> thickness;
    thickness.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float now = metres(first[i]);
        thickness.push_back(now + blend.share * (metres(second[i]) - now));
    }
    return thickness;
}

}  // namespace

FrameBlend blend_frames(const formats::LayerRecord& record, double time) {
    const std::uint32_t last = record.frames - 1;
    if (last == 0 || !std::isfinite(time)) return {};
    const auto step = static_cast<double>(record.frame_seconds);
    // Within a period before it is divided: frames are short, times may be endless.
    const double period = step * record.frames;
    const double within =
        record.loops() ? std::fmod(time, period) : std::clamp(time, 0.0, last * step);
    const double at = (within < 0 ? within + period : within) / step;
    const auto first = static_cast<std::uint32_t>(std::min(std::floor(at), last * 1.0));
    const std::uint32_t next = first < last ? first + 1 : record.loops() ? 0 : last;
    const auto share = static_cast<float>(std::clamp(at - first, 0.0, 1.0));
    return {first, next, next == first ? 0 : share};
}

float LayerField::level_of(double length) const {
    return static_cast<float>(std::log2(std::max(length, 1e-30) / cell));
}

LayerField make_layer_field(const formats::LayerRecord& record,
                            std::span<const std::uint16_t> codes, double time) {
    LayerField field;
    field.frames = blend_frames(record, time);
    field.thickness =
        make_pyramid(record.columns, record.rows, blend_thickness(record, codes, field.frames),
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
