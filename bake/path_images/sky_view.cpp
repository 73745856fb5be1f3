#include "bake/path_images/sky_view.h"

#include <algorithm>
#include <cmath>

#include "bake/scattering/phase_series.h"

namespace opaline::bake {
namespace {

// So many degrees that what is left out of the phase function squared is below 1e-12.
unsigned degrees_of(const formats::PhaseFunction& phase) {
    using Type = formats::PhaseFunction::Type;
    constexpr unsigned kFewest = 32, kMost = 1500, kOfTable = 400;
    double degrees = kOfTable;
    if (phase.type == Type::henyey_greenstein) {
        degrees = 13.8 / -std::log(std::max(0.1, std::abs(static_cast<double>(phase.g))));
    } else if (phase.type == Type::gaussian) {
        degrees = 7.4 / static_cast<double>(phase.rms_angle);
    } else if (phase.type != Type::tabulated) {
        degrees = kFewest;
    }
    return std::clamp(static_cast<unsigned>(std::min(degrees, 1e6)), kFewest, kMost);
}

void add_row(ZonalRow& sum, const ZonalRow& row, double weight) {
    sum.kernel = row.kernel;
    sum.nodes_per_log = row.nodes_per_log;
    for (std::size_t i = 0; i < sum.value.size(); ++i) {
        sum.value[i] += static_cast<float>(weight) * row.value[i];
    }
}

}  // namespace

ImagePhase make_image_phase(const formats::PhaseFunction& phase, bool paper) {
    const unsigned degrees = degrees_of(phase);
    if (paper) {
        return {make_phase_density(phase),
                make_power_table(PathKernel::ray, phase, degrees),
                {},
                make_power_table(PathKernel::boundary, phase, degrees)};
    }
    const PhaseSeries series = expand_phase(phase, degrees);
    return {make_phase_density(phase),
            make_zonal_table(PathKernel::ray, series),
            make_zonal_table(PathKernel::source, series),
            {}};
}

SkyView view_sky(const ImageSky& sky, const PhaseDensity& phase, const ZonalTable& table,
                 glm::dvec3 onward) {
    SkyView view;
    std::array<glm::dvec3, ImageSky::kCellCount + 1> irradiance{};
    const double ahead = std::cos(kAheadAngle);
    double total = 0;
    for (const SkyTexel& texel : sky.texel) {
        const double cosine = std::clamp(glm::dot(onward, texel.direction), -1.0, 1.0);
        const double p = eval_phase(phase, cosine);
        total += p * texel.solid_angle;
        const double brightness = texel.brightness();
        if (!(brightness > 0)) {
            continue;
        }
        const std::size_t number = cosine > ahead ? SkyView::kAhead : std::size_t{texel.cell};
        SkyPart& part = view.part[number];
        part.is_dark = false;
        part.once += p * texel.irradiance;
        irradiance[number] += texel.irradiance;
        add_row(part.often, interpolate_row(table, cosine), brightness);
    }
    for (std::size_t i = 0; i < view.part.size(); ++i) {
        SkyPart& part = view.part[i];
        if (!part.is_dark) {
            part.once /= total;
            const glm::dvec3 e = irradiance[i];
            part.color = e / ((e.x + e.y + e.z) / 3);
        }
    }
    return view;
}

}  // namespace opaline::bake
