#include "bake/lab/path_images/image_lights.h"

#include <algorithm>
#include <cmath>

#include "bake/physics/phase_series.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::Vec3;

constexpr float kLargestSun = 0.0525f;  // [rad]
constexpr double kBright = 0.05;        // share of the map's flux
constexpr std::uint32_t kPoints = 8;    // along an edge of a texel

glm::dvec3 to_dvec3(Vec3 v) {
    return {v.x, v.y, v.z};
}
glm::dvec3 to_dvec3(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

std::array<glm::dvec3, ImageSky::kCellCount> make_sky_cells() {
    constexpr std::uint32_t m = ImageSky::kCells;
    std::array<glm::dvec3, ImageSky::kCellCount> cell{};
    for (std::uint32_t i = 0; i < ImageSky::kCellCount; ++i) {
        const std::uint32_t of_face = i % (m * m);
        cell[i] = glm::normalize(
            to_dvec3(formats::texel_direction(m, i / (m * m), of_face / m, of_face % m)));
    }
    return cell;
}

// Directions of texels, no light.
ImageSky make_dark_sky() {
    constexpr std::uint32_t n = ImageSky::kTexels, m = ImageSky::kCells;
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    ImageSky sky;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t i = 0; i < n * n; ++i) {
            const std::uint32_t row = i / n, column = i % n;
            SkyTexel texel;
            texel.direction =
                glm::normalize(to_dvec3(formats::texel_direction(n, face, row, column)));
            texel.solid_angle = solid_angle[i];
            texel.cell = (face * m + row * m / n) * m + column * m / n;
            sky.texel.push_back(texel);
        }
    }
    return sky;
}

// Radiance of the map and of discs too wide for suns.
glm::dvec3 soft_radiance(const formats::Environment& light, glm::dvec3 direction) {
    const Vec3 d{static_cast<float>(direction.x), static_cast<float>(direction.y),
                 static_cast<float>(direction.z)};
    glm::dvec3 radiance =
        light.pixel.empty() ? glm::dvec3(0) : to_dvec3(formats::sample_map(light, d));
    for (const formats::DistantDisc& disc : light.discs) {
        if (disc.angular_radius > kLargestSun &&
            glm::dot(direction, to_dvec3(disc.direction)) >=
                std::cos(static_cast<double>(disc.angular_radius))) {
            radiance += to_dvec3(disc.radiance);
        }
    }
    return radiance;
}

// The flux of texel `i` of its face, and the direction that it comes from on average (not unit).
struct TexelFlux {
    glm::dvec3 irradiance{0}, centre{0};
};
TexelFlux integrate_texel(const formats::Environment& light, const glm::dmat3& light_from_world,
                          std::uint32_t face, std::uint32_t i, double solid_angle) {
    constexpr std::uint32_t n = ImageSky::kTexels;
    // Of the middle of a part of a texel along an edge of the face, in [0, 1].
    const auto place = [](std::uint32_t texel, std::uint32_t part) {
        return (static_cast<float>(texel) + (static_cast<float>(part) + 0.5f) / kPoints) / n;
    };
    TexelFlux flux;
    double weights = 0;
    for (std::uint32_t p = 0; p < kPoints * kPoints; ++p) {
        const float s = place(i % n, p % kPoints), t = place(i / n, p / kPoints);
        const glm::dvec3 at = to_dvec3(formats::cube_position({face, 2 * s - 1, 2 * t - 1}));
        const double weight = std::pow(glm::dot(at, at), -1.5);  // of the solid angle
        const glm::dvec3 direction = glm::normalize(at);
        const glm::dvec3 part = weight * soft_radiance(light, light_from_world * direction);
        flux.irradiance += part;
        flux.centre += (part.x + part.y + part.z) * direction;
        weights += weight;
    }
    flux.irradiance *= solid_angle / weights;
    return flux;
}

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

const std::array<glm::dvec3, ImageSky::kCellCount>& sky_cells() {
    static const std::array<glm::dvec3, ImageSky::kCellCount> cells = make_sky_cells();
    return cells;
}

ImageLights make_image_lights(const formats::Environment& environment,
                              const glm::mat3& world_from_light) {
    ImageLights lights;
    const glm::dmat3 rotation(world_from_light), back = glm::transpose(rotation);
    bool has_sky = !environment.pixel.empty();
    for (const formats::DistantDisc& disc : environment.discs) {
        if (disc.angular_radius > kLargestSun) {
            has_sky = true;
            continue;
        }
        lights.suns.push_back(
            {glm::normalize(rotation * to_dvec3(disc.direction)),
             formats::disc_solid_angle(disc.angular_radius) * to_dvec3(disc.radiance)});
    }
    if (!has_sky) return lights;
    lights.sky = make_dark_sky();
    constexpr std::uint32_t kOfFace = ImageSky::kTexels * ImageSky::kTexels;
    std::vector<TexelFlux> flux;
    double sum = 0;
    for (std::uint32_t i = 0; i < lights.sky.texel.size(); ++i) {
        SkyTexel& texel = lights.sky.texel[i];
        flux.push_back(
            integrate_texel(environment, back, i / kOfFace, i % kOfFace, texel.solid_angle));
        texel.irradiance = flux.back().irradiance;
        sum += texel.brightness();
    }
    for (std::size_t i = 0; i < flux.size(); ++i) {
        SkyTexel& texel = lights.sky.texel[i];
        if (texel.brightness() > kBright * sum) {
            lights.suns.push_back({glm::normalize(flux[i].centre), texel.irradiance});
            texel.irradiance = glm::dvec3(0);
        }
    }
    if (!(sum > 0)) {
        lights.sky.texel.clear();
    }
    return lights;
}

ImageSky make_even_sky() {
    ImageSky sky = make_dark_sky();
    for (SkyTexel& texel : sky.texel) {
        texel.irradiance = glm::dvec3(texel.solid_angle);
    }
    return sky;
}

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
        if (!(brightness > 0)) continue;
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
