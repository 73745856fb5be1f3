#include "bake/exchange/true_lobe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/physics/path_differentials/lobe.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

constexpr float kGrazing = 1e-3f;

glm::vec3 into(const Frame& frame, glm::vec3 normal, glm::vec3 d) {
    return {glm::dot(frame.u, d), glm::dot(frame.v, d), glm::dot(normal, d)};
}

formats::Rgb facet_reflectance(const TrueLobe& lobe, float cosine) {
    const formats::Rgb& f0 = lobe.surface.f0;
    const float s = formats::schlick_weight(cosine), grazing = s * lobe.surface.f90;
    return lobe.albedo.compensation * ((1 - s) * f0 + formats::Rgb{grazing, grazing, grazing});
}

}  // namespace

TrueLobe make_true_lobe(const formats::GlossSurface& surface, glm::vec3 normal, glm::vec3 flat,
                        glm::vec3 origin, glm::vec3 direction) {
    TrueLobe lobe{.surface = surface, .frame = make_frame(normal), .origin = origin, .flat = flat};
    lobe.to_eye = into(lobe.frame, normal, -direction);
    lobe.to_eye.z = std::max(lobe.to_eye.z, kGrazing);
    lobe.to_eye = glm::normalize(lobe.to_eye);
    lobe.albedo = formats::eval_gloss_albedo(surface, lobe.to_eye.z);
    return lobe;
}

std::optional<TrueLobeSample> sample_true_lobe(const TrueLobe& lobe, float u, float v) {
    const float alpha = formats::ggx_alpha(lobe.surface.roughness);
    const glm::vec3 m(sample_visible_normal(glm::dvec3(lobe.to_eye), {double{alpha}, double{alpha}},
                                            double{u}, double{v})
                          .m);
    const float cosine = glm::dot(lobe.to_eye, m);
    const glm::vec3 l = 2 * cosine * m - lobe.to_eye;
    const glm::vec3 direction = glm::normalize(lobe.frame.to_world(l));
    if (!(cosine > 0) || !(l.z > 0) || !(glm::dot(direction, lobe.flat) > 0)) return std::nullopt;
    // G2 / G1 of the correlated Smith term, by V = G2 / (4 n.v n.l).
    const float c = lobe.to_eye.z;
    const float one_sided = 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)));
    const float both = 4 * c * l.z * formats::smith_visibility(c, l.z, alpha);
    return TrueLobeSample{direction, both / one_sided * facet_reflectance(lobe, cosine)};
}

std::uint64_t add_mirrored_suns(const RayScene& rays, const SunRays& suns, const TrueLobe& lobe,
                                formats::Rgb weight, std::span<double> luminance) {
    constexpr float kNarrowest = 0.05f;
    const float alpha = std::max(formats::ggx_alpha(lobe.surface.roughness), kNarrowest);
    const glm::vec3 normal = lobe.frame.to_world({0, 0, 1});
    std::uint64_t traced = 0;
    RayPacket packet = rays_from(lobe.origin);
    for (const SunRays::Packet& sun : suns.packets) {
        packet.dir_x = sun.dir_x;
        packet.dir_y = sun.dir_y;
        packet.dir_z = sun.dir_z;
        RayPacket::Lane radiance{};
        LaneMask lanes{};
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::vec3 d{sun.dir_x[lane], sun.dir_y[lane], sun.dir_z[lane]};
            const glm::vec3 l = into(lobe.frame, normal, d);
            if (!(sun.flux[lane] > 0) || !(l.z > 0) || !(glm::dot(d, lobe.flat) > 0)) continue;
            const glm::vec3 h = glm::normalize(l + lobe.to_eye);
            const float response = formats::ggx_distribution(h.z, alpha) *
                                   formats::smith_visibility(lobe.to_eye.z, l.z, alpha) * l.z;
            radiance[lane] =
                response * sun.flux[lane] *
                formats::luminance(weight * facet_reflectance(lobe, glm::dot(lobe.to_eye, h)));
            lanes[lane] = radiance[lane] > 0 ? -1 : 0;
        }
        traced += keep_unoccluded(rays, packet, lanes);
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] == 0) continue;
            luminance[sun.light[lane]] +=
                static_cast<double>(radiance[lane]) *
                let_through(suns.between, lobe.origin,
                            {sun.dir_x[lane], sun.dir_y[lane], sun.dir_z[lane]});
        }
    }
    return traced;
}

}  // namespace opaline::bake
