#include "runtime/light_vector.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"

namespace opaline::runtime {

using formats::Environment;
using formats::Rgb;

Rotation rotation_about_y(float radians) {
    const float c = std::cos(radians), s = std::sin(radians);
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}

bool is_rotation(const Rotation& r, float tolerance) {
    const auto near = [tolerance](float value, float expected) {
        return std::abs(value - expected) <= tolerance;  // false for NaN
    };
    return near(dot(r.x, r.x), 1) && near(dot(r.y, r.y), 1) && near(dot(r.z, r.z), 1) &&
           near(dot(r.x, r.y), 0) && near(dot(r.y, r.z), 0) && near(dot(r.z, r.x), 0) &&
           dot(cross(r.x, r.y), r.z) > 0;
}

LightVector project_environment(const Environment& environment, std::uint32_t n,
                                const Rotation& rotation, unsigned threads) {
    assert(formats::is_valid_cubemap_size(n));
    assert(environment.pixel.empty() ||
           environment.pixel.size() == std::size_t{environment.width} * environment.height);
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    integrate_map(environment, n, rotation, threads, integral);
    integrate_discs(environment.discs, n, rotation, integral);
    return make_light_vector(integral, n);
}

LightVector project_cubemap(std::span<const Rgb> radiance, std::uint32_t n) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    for (std::size_t j = 0; j < radiance.size(); ++j) {
        const double weight = solid_angle[j % solid_angle.size()];
        integral[3 * j] = weight * static_cast<double>(radiance[j].r);
        integral[3 * j + 1] = weight * static_cast<double>(radiance[j].g);
        integral[3 * j + 2] = weight * static_cast<double>(radiance[j].b);
    }
    return make_light_vector(integral, n);
}

LightVector make_light_vector(std::span<const double> integral, std::uint32_t n) {
    LightVector light{n, std::vector<float>(std::size_t{4} * formats::cubemap_texels(n))};
    std::vector<double> scratch(std::size_t{2} * n * n);
    fill_light_vector(integral, scratch, light);
    return light;
}

void fill_light_vector(std::span<const double> integral, std::span<double> scratch,
                       LightVector& light) {
    const std::uint32_t n = light.n;
    const std::size_t face_size = std::size_t{n} * n;
    const std::span<double> face = scratch.first(face_size), rest = scratch.subspan(face_size);
    for (std::size_t f = 0; f < formats::kCubeFaces; ++f) {
        for (std::size_t b = 0; b < 3; ++b) {
            for (std::size_t j = 0; j < face_size; ++j) {
                face[j] = integral[3 * (f * face_size + j) + b];
            }
            formats::haar_forward(face, n, rest);
            for (std::size_t k = 0; k < face_size; ++k) {
                // Light beyond the range of float stays finite, so that no sum of it becomes NaN
                // here.
                constexpr double kLargest = std::numeric_limits<float>::max();
                light.rgba[4 * (f * face_size + k) + b] =
                    static_cast<float>(std::clamp(face[k], -kLargest, kLargest));
            }
        }
    }
}

}  // namespace opaline::runtime
