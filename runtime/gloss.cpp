#include "runtime/gloss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr float kLeastGlossCosine = 1e-3f;

// The view in the plane of incidence: eye = sine * tangent + cosine * normal.
struct Frame {
    Vec3 tangent, bitangent, normal;
    float cosine = 1, sine = 0;

    Vec3 eye() const { return sine * tangent + cosine * normal; }
};

Frame frame_of(const ViewOfReceiver& view) {
    Frame frame;
    frame.normal = view.normal;
    frame.cosine = std::clamp(view.cosine, kLeastGlossCosine, 1.0f);
    frame.sine = std::sqrt((1 - frame.cosine) * (1 + frame.cosine));
    const Vec3 n = view.normal, flat = view.to_eye - dot(n, view.to_eye) * n;
    const float norm = length(flat);
    frame.tangent = norm > 1e-5f
                        ? (1 / norm) * flat
                        : normalize(cross(n, std::abs(n.x) < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    frame.bitangent = cross(n, frame.tangent);
    return frame;
}

// Sums of weights and of weighted light, for both parts of Schlick's term.
struct LobeSum {
    Rgb light_f0, light_f90;
    float weight_f0 = 0, weight_f90 = 0;

    void add(float weight, float schlick, Rgb radiance) {
        const float grazing = weight * schlick, rest = weight - grazing;
        weight_f0 += rest;
        weight_f90 += grazing;
        light_f0 = light_f0 + rest * radiance;
        light_f90 = light_f90 + grazing * radiance;
    }
};

LobeIntegral scaled(const LobeSum& sum, const formats::GgxAlbedo& table) {
    LobeIntegral integral;
    if (sum.weight_f0 > 0) integral.of_f0 = (table.of_f0 / sum.weight_f0) * sum.light_f0;
    if (sum.weight_f90 > 0) integral.of_f90 = (table.of_f90 / sum.weight_f90) * sum.light_f90;
    return integral;
}

LobeIntegral mixed(const LobeIntegral& a, const LobeIntegral& b, float share) {
    return {(1 - share) * a.of_f0 + share * b.of_f0, (1 - share) * a.of_f90 + share * b.of_f90};
}

Rgb sample_level(const GlossLight& light, Vec3 direction, float level) {
    const auto last = static_cast<float>(light.map.size() - 1);
    const float nearest = std::floor(std::clamp(level, 0.0f, last) + 0.5f);
    return formats::sample_map(light.map[static_cast<std::size_t>(nearest)], direction);
}

// sqrt(alpha^2 + (1 - alpha^2) c^2): c times the root in Smith's Lambda.
float smith_root(float cosine, float alpha_squared) {
    return std::sqrt(alpha_squared + (1 - alpha_squared) * cosine * cosine);
}

// Filtered importance sampling. The golden angle between taps is turned step by step, so that CPU
// and GPU do the same products.
LobeIntegral sum_taps(const GlossLight& light, const formats::GgxAlbedo& table, float alpha,
                      const Frame& f) {
    constexpr float kCosGolden = -0.73736888f, kSinGolden = 0.67549029f;
    // Half a level and a bit finer than the tap's share: bilinear samples are wider than a texel.
    // The least error of those tried.
    constexpr float kLevelBias = -0.7f;
    const float a2 = alpha * alpha, c = f.cosine, s = f.sine;
    const float stretch = std::sqrt(a2 * s * s + c * c);
    const float vx = alpha * s / stretch, vz = c / stretch;
    const float root_v = smith_root(c, a2) / c;
    const auto n = static_cast<float>(light.map.front().width);
    LobeSum sum;
    float cos_phi = 1, sin_phi = 0;
    for (int i = 0; i < kLobeTaps; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / kLobeTaps;
        const float z = (1 - u) * (1 + vz) - vz;
        const float r = std::sqrt(std::max(1 - z * z, 0.0f));
        const Vec3 h = normalize(Vec3{alpha * (r * cos_phi + vx), alpha * r * sin_phi, z + vz});
        const float turned = cos_phi * kCosGolden - sin_phi * kSinGolden;
        sin_phi = sin_phi * kCosGolden + cos_phi * kSinGolden;
        cos_phi = turned;
        const float v_h = s * h.x + c * h.z;
        const Vec3 local{2 * v_h * h.x - s, 2 * v_h * h.y, 2 * v_h * h.z - c};
        if (!(local.z > 0)) continue;
        const Vec3 l = local.x * f.tangent + local.y * f.bitangent + local.z * f.normal;
        const float root_l = smith_root(local.z, a2) / local.z;
        // The tap's share of solid angle beside that of the texel it falls into.
        const float pdf = formats::ggx_distribution(h.z, alpha) / (2 * c * (1 + root_v));
        const float major = std::max({std::abs(l.x), std::abs(l.y), std::abs(l.z)});
        const float texel = 4 * major * major * major / (n * n);
        const float level = 0.5f * std::log2(1 / (kLobeTaps * pdf * texel)) + kLevelBias;
        sum.add((1 + root_v) / (root_v + root_l), formats::schlick_weight(v_h),
                sample_level(light, l, level));
    }
    return scaled(sum, table);
}

// One lane of the blocks below.
struct Lanes {
    std::array<float, kCellBlock> value{};

    float sum() const {
        float total = 0;
        for (const float x : value) {
            total += x;
        }
        return total;
    }
};

// Straight sums over cells, a block at a time: independent lanes, which compilers vectorise without
// changing any sum.
LobeIntegral sum_cells(const GlossLight& light, const formats::GgxAlbedo& table, float alpha,
                       const Frame& f) {
    const GlossLight::Cells& cells = light.cells;
    const float a2 = alpha * alpha, c = f.cosine, root_v = smith_root(c, a2);
    const Vec3 n = f.normal, eye = f.eye();
    Lanes weight_0, weight_90, r_0, g_0, b_0, r_90, g_90, b_90;
    for (std::size_t first = 0; first < cells.size(); first += kCellBlock) {
        for (std::size_t k = 0; k < kCellBlock; ++k) {
            const std::size_t i = first + k;
            const float n_l = n.x * cells.x[i] + n.y * cells.y[i] + n.z * cells.z[i];
            const float lit = std::max(n_l, 0.0f);
            const float v_l = eye.x * cells.x[i] + eye.y * cells.y[i] + eye.z * cells.z[i];
            const float h_h = std::max(2 + 2 * v_l, 1e-12f);  // |v + l|^2
            const float n_h = c + n_l, n_h_squared = n_h * n_h / h_h;
            const float wide = a2 + cells.widening[i];
            const float d = std::max(1 - n_h_squared, 0.0f) + wide * n_h_squared;
            const float root_l = std::sqrt(a2 + (1 - a2) * lit * lit);
            const float lobe =
                wide * lit / (2 * std::numbers::pi_v<float> * d * d * (lit * root_v + c * root_l));
            const float missing = std::max(1 - 0.5f * std::sqrt(h_h), 0.0f);
            const float squared = missing * missing, schlick = squared * squared * missing;
            const float grazing = lobe * schlick, rest = lobe - grazing;
            weight_0.value[k] += rest * cells.solid_angle[i];
            weight_90.value[k] += grazing * cells.solid_angle[i];
            r_0.value[k] += rest * cells.r[i];
            g_0.value[k] += rest * cells.g[i];
            b_0.value[k] += rest * cells.b[i];
            r_90.value[k] += grazing * cells.r[i];
            g_90.value[k] += grazing * cells.g[i];
            b_90.value[k] += grazing * cells.b[i];
        }
    }
    LobeSum sum;
    sum.weight_f0 = weight_0.sum();
    sum.weight_f90 = weight_90.sum();
    sum.light_f0 = {r_0.sum(), g_0.sum(), b_0.sum()};
    sum.light_f90 = {r_90.sum(), g_90.sum(), b_90.sum()};
    return scaled(sum, table);
}

void add_suns(const GlossLight& light, float alpha, const Frame& f, LobeIntegral& integral) {
    const Vec3 eye = f.eye();
    for (const formats::DistantDisc& sun : light.suns) {
        const float n_l = dot(f.normal, sun.direction);
        if (!(n_l > 0)) continue;
        const Vec3 half = eye + sun.direction, h = normalize(half);
        // A mirror's lobe widened like this shows the sun's own radiance at its centre.
        const float wide =
            std::sqrt(alpha * alpha + 0.25f * sun.angular_radius * sun.angular_radius);
        const float lobe = formats::ggx_distribution(dot(f.normal, h), wide) *
                           formats::smith_visibility(f.cosine, n_l, wide) * n_l *
                           static_cast<float>(formats::disc_solid_angle(sun.angular_radius));
        const float schlick = formats::schlick_weight(dot(eye, h));
        integral.of_f0 = integral.of_f0 + (lobe * (1 - schlick)) * sun.radiance;
        integral.of_f90 = integral.of_f90 + (lobe * schlick) * sun.radiance;
    }
}

float storable(float x) {
    return x > 0 ? std::min(x, 1e35f) : 0.0f;
}

}  // namespace

LobeIntegral integrate_lobe(const GlossLight& light, const formats::GgxAlbedo& table,
                            float roughness, const ViewOfReceiver& view) {
    const Frame frame = frame_of(view);
    const float alpha = formats::ggx_alpha(roughness);
    const float wide = std::clamp(
        (roughness - kNarrowRoughness) / (kWideRoughness - kNarrowRoughness), 0.0f, 1.0f);
    LobeIntegral integral;
    if (wide < 1) integral = sum_taps(light, table, alpha, frame);
    if (wide > 0) integral = mixed(integral, sum_cells(light, table, alpha, frame), wide);
    add_suns(light, alpha, frame, integral);
    return integral;
}

Rgb eval_gloss(const GlossLight& light, const Rotation& rotation,
               const formats::GlossSurface& surface, const ViewOfReceiver& view) {
    constexpr float kFade = 0.2f;
    if (light.map.empty() || !(dot(view.normal, view.normal) > 0) || !(view.cosine > -kFade)) {
        return {};
    }
    const float fade = 1 + std::min(view.cosine, 0.0f) / kFade;
    const ViewOfReceiver in_light{rotation.light_from_world(view.normal),
                                  rotation.light_from_world(view.to_eye), view.cosine,
                                  view.is_turned};
    const formats::GlossAlbedo albedo =
        formats::eval_gloss_albedo(surface, std::clamp(view.cosine, kLeastGlossCosine, 1.0f));
    const LobeIntegral lobe = integrate_lobe(light, albedo.table, surface.roughness, in_light);
    const Rgb sum =
        fade * albedo.compensation * (surface.f0 * lobe.of_f0 + surface.f90 * lobe.of_f90);
    return {storable(sum.r), storable(sum.g), storable(sum.b)};
}

float gloss_visibility(const ViewOfReceiver& view, float roughness, Vec3 axis, float open) {
    const float c = std::clamp(view.cosine, kLeastGlossCosine, 1.0f);
    const Vec3 mirrored = 2 * c * view.normal - view.to_eye;
    const float norm = length(mirrored);
    if (!(norm > 0)) return 0;
    if (view.is_turned) axis = axis - 2 * dot(axis, view.normal) * view.normal;
    return specular_visibility(axis, open, (1 / norm) * mirrored,
                               lobe_of_alpha(formats::ggx_alpha(roughness)));
}

float gloss_cosine(float cosine) {
    return std::clamp(std::abs(cosine), kLeastGlossCosine, 1.0f);
}

}  // namespace opaline::runtime
