// Specular reflection against the integral of BRDF times environment, by brute force: one term for
// each of some 400 000 directions, from D, V and Schlick's term.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "bake/lights/builtin_environment.h"
#include "formats/opal/cubemap.h"
#include "runtime/gloss.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

struct LightSample {
    Vec3 direction;
    Rgb flux;
};

std::vector<LightSample> sample_everywhere(const Environment& environment) {
    constexpr std::uint32_t kSide = 256;
    std::vector<LightSample> samples;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < kSide; ++row) {
            for (std::uint32_t column = 0; column < kSide; ++column) {
                const Vec3 d = formats::texel_direction(kSide, face, row, column);
                const float major = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
                const float solid_angle = 4 * major * major * major / (kSide * kSide);
                samples.push_back({d, solid_angle * formats::sample_map(environment, d)});
            }
        }
    }
    for (const formats::DistantDisc& disc : environment.discs) {  // far smaller than the lobes here
        samples.push_back(
            {disc.direction,
             static_cast<float>(formats::disc_solid_angle(disc.angular_radius)) * disc.radiance});
    }
    return samples;
}

Rgb sum_everything(const std::vector<LightSample>& samples, const formats::GlossSurface& surface,
                   Vec3 n, Vec3 v) {
    const float alpha = formats::ggx_alpha(surface.roughness), c = dot(n, v);
    double r = 0, g = 0, b = 0;
    for (const LightSample& light : samples) {
        const float n_l = dot(n, light.direction);
        if (!(n_l > 0)) continue;
        const Vec3 h = normalize(v + light.direction);
        const float lobe = formats::ggx_distribution(dot(n, h), alpha) *
                           formats::smith_visibility(c, n_l, alpha) * n_l;
        const float schlick = formats::schlick_weight(dot(v, h));
        const Rgb fresnel =
            (1 - schlick) * surface.f0 +
            Rgb{surface.f90 * schlick, surface.f90 * schlick, surface.f90 * schlick};
        const Rgb radiance = lobe * (fresnel * light.flux);
        r += radiance.r, g += radiance.g, b += radiance.b;
    }
    const Rgb k = formats::eval_gloss_albedo(surface, c).compensation;
    return k * Rgb{static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

struct Look {
    Vec3 normal, to_eye;
};

// A sphere seen from afar: every part of its disc alike.
std::vector<Look> look_at_sphere(int count) {
    const Vec3 v = normalize(Vec3{0.5f, 0.3f, 0.8f}), right = normalize(cross({0, 1, 0}, v)),
               up = cross(v, right);
    std::vector<Look> looks;
    for (int i = 0; i < count; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const float phi = 2.399963f * static_cast<float>(i), r = std::sqrt(t);
        looks.push_back(
            {normalize(r * std::cos(phi) * right + r * std::sin(phi) * up + std::sqrt(1 - t) * v),
             v});
    }
    return looks;
}

// A floor, from steep to grazing views all around.
std::vector<Look> look_at_floor(int count) {
    std::vector<Look> looks;
    for (int i = 0; i < count; ++i) {
        const float c = 0.05f + 0.95f * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const float phi = 2.399963f * static_cast<float>(i), s = std::sqrt(1 - c * c);
        looks.push_back({{0, 1, 0}, {s * std::cos(phi), c, s * std::sin(phi)}});
    }
    return looks;
}

double relative_rms(const GlossLight& light, const std::vector<LightSample>& samples,
                    const formats::GlossSurface& surface, const std::vector<Look>& looks) {
    double error = 0, truth = 0;
    for (const Look& look : looks) {
        const Rgb expected = sum_everything(samples, surface, look.normal, look.to_eye);
        const Rgb found = eval_gloss(
            light, {}, surface, {look.normal, look.to_eye, dot(look.normal, look.to_eye), false});
        for (const auto& [a, b] : {std::pair{found.r, expected.r}, std::pair{found.g, expected.g},
                                   std::pair{found.b, expected.b}}) {
            error += static_cast<double>((a - b) * (a - b));
            truth += static_cast<double>(b * b);
        }
    }
    return std::sqrt(error / truth);
}

TEST(GlossAccuracy, MetalSphereAndGlossyFloorStayWithinTwoPerCentOfTheIntegral) {
    for (const char* name : {"studio", "sky:3,35"}) {
        const Environment environment = bake::make_environment(name).value();
        const GlossLight light = make_gloss_light(environment, 0);
        const std::vector<LightSample> samples = sample_everywhere(environment);
        for (const float roughness : {0.3f, 0.4f, 0.45f, 0.55f, 0.8f, 1.0f}) {
            formats::GlossRecord record;
            record.f0 = {0.04f, 0.04f, 0.04f};
            const auto metal =
                formats::make_gloss_surface(record, {0.9f, 0.7f, 0.4f}, 1, roughness);
            const auto lacquer = formats::make_gloss_surface(record, {0, 0, 0}, 0, roughness);
            const double sphere = relative_rms(light, samples, metal, look_at_sphere(60));
            const double floor = relative_rms(light, samples, lacquer, look_at_floor(40));
            std::cout << "[ error    ] " << name << ", roughness " << roughness << ": metal sphere "
                      << sphere << ", glossy floor " << floor << "\n";
            EXPECT_LT(sphere, 0.02) << name << ' ' << roughness;
            EXPECT_LT(floor, 0.02) << name << ' ' << roughness;
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
