#include "bake/lights/true_irradiance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLanes = RayPacket::kSize;
using std::numbers::pi;

glm::vec3 direction_of(const RayPacket& packet, std::uint32_t lane) {
    return {packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]};
}

// By what volumes let through to a place from the middles of coarser cells.
void dim(const DensitySpace* between, glm::vec3 to, std::span<float> dense) {
    constexpr std::uint32_t kCells = 16;
    if (between == nullptr) return;
    const LightCells cells = make_light_cells(kCells);
    std::vector<float> share(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        share[i] = static_cast<float>(let_through(between, to, cells.direction(i)));
    }
    for (std::size_t i = 0; i < dense.size(); ++i) {
        dense[i] *= share[coarser_texel(i, kTruthCubemap, kCells)];
    }
}

}  // namespace

std::uint64_t keep_unoccluded(const RayScene& rays, RayPacket& packet, LaneMask& lanes) {
    if (rays.is_empty()) return 0;
    packet.tfar.fill(std::numeric_limits<float>::infinity());
    std::uint64_t traced = 0;
    for (const std::int32_t lane : lanes) {
        traced += static_cast<std::uint64_t>(-lane);
    }
    if (traced > 0) {
        rays.occluded(lanes, packet);
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            lanes[lane] = packet.tfar[lane] > 0 ? lanes[lane] : 0;
        }
    }
    return traced;
}

double let_through(const DensitySpace* between, glm::vec3 from, glm::vec3 direction) {
    if (between == nullptr) return 1;
    const std::array<float, 3> depth = optical_depth(*between, from, direction);
    return static_cast<double>(
        formats::luminance({std::exp(-depth[0]), std::exp(-depth[1]), std::exp(-depth[2])}));
}

SunRays make_sun_rays(std::span<const TestLight> lights, std::uint32_t per_sun,
                      const DensitySpace* between) {
    SunRays suns;
    suns.between = between;
    std::uint32_t lane = kLanes;
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
        for (const TestDisc& disc : lights[l].discs) {
            const Frame frame = make_frame(disc.direction);
            for (std::uint32_t i = 0; i < per_sun; ++i) {
                // Sunflower: equal steps in 1 - cos, the golden angle in azimuth.
                const double golden_angle = pi * (3 - std::sqrt(5.0));
                const double half = std::sin(0.5 * static_cast<double>(disc.angular_radius)) *
                                    std::sqrt((i + 0.5) / per_sun);
                const double sine = 2 * half * std::sqrt(1 - half * half);
                const glm::vec3 w =
                    frame.to_world({static_cast<float>(sine * std::cos(golden_angle * i)),
                                    static_cast<float>(sine * std::sin(golden_angle * i)),
                                    static_cast<float>(1 - 2 * half * half)});
                if (lane == kLanes) {
                    SunRays::Packet empty{};
                    empty.dir_y.fill(1.0f);
                    suns.packets.push_back(empty);
                    lane = 0;
                }
                SunRays::Packet& packet = suns.packets.back();
                packet.dir_x[lane] = w.x;
                packet.dir_y[lane] = w.y;
                packet.dir_z[lane] = w.z;
                packet.flux[lane] = static_cast<float>(disc.flux / per_sun);
                packet.light[lane] = l;
                ++lane;
            }
        }
    }
    return suns;
}

std::uint64_t add_sun_irradiance(const RayScene& rays, const SunRays& suns,
                                 const Receiver& receiver, double eta, std::span<double> irradiance,
                                 const LightFactor& factor) {
    std::uint64_t traced = 0;
    RayPacket packet = rays_from(receiver.origin);
    for (const SunRays::Packet& sun : suns.packets) {
        packet.dir_x = sun.dir_x;
        packet.dir_y = sun.dir_y;
        packet.dir_z = sun.dir_z;
        RayPacket::Lane cosine;
        LaneMask lanes;
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            cosine[lane] = glm::dot(receiver.normal, direction_of(packet, lane));
            lanes[lane] = cosine[lane] > 0 && sun.flux[lane] > 0 ? -1 : 0;
        }
        traced += keep_unoccluded(rays, packet, lanes);
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            if (lanes[lane] != 0) {
                const double c = std::min(1.0, static_cast<double>(cosine[lane]));
                irradiance[sun.light[lane]] +=
                    c * fresnel_transmittance(c, eta) * static_cast<double>(sun.flux[lane]) *
                    factor.at(direction_of(packet, lane)) *
                    let_through(suns.between, receiver.origin, direction_of(packet, lane));
            }
        }
    }
    return traced;
}

SmoothLights make_smooth_lights(std::span<const TestLight> lights, const DensitySpace* between) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(kTruthCubemap);
    const std::size_t texels = formats::cubemap_texels(kTruthCubemap);
    SmoothLights smooth{lights.size(), std::vector<float>(texels * lights.size()), between};
    for (std::size_t l = 0; l < lights.size(); ++l) {
        for (std::size_t j = 0; j < texels; ++j) {
            smooth.radiance[j * lights.size() + l] = static_cast<float>(
                static_cast<double>(lights[l].smooth[j]) / solid_angle[j % solid_angle.size()]);
        }
    }
    return smooth;
}

const float* SmoothLights::towards(glm::vec3 d) const {
    return &radiance[formats::texel_index(kTruthCubemap, {d.x, d.y, d.z}) * lights];
}

std::uint64_t add_smooth_irradiance(const RayScene& rays, const SmoothLights& lights,
                                    const Receiver& receiver, double eta, glm::vec2 u,
                                    std::span<double> irradiance) {
    constexpr std::uint32_t kSide = 4;
    const Frame frame = make_frame(receiver.normal);
    RayPacket packet = rays_from(receiver.origin);
    RayPacket::Lane cosine;
    LaneMask lanes;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t ring = lane / kSide;
        const std::uint32_t sector = lane % kSide;
        const float r2 = (static_cast<float>(ring) + u.x) / kSide;
        const float phi = 2 * static_cast<float>(pi) * (static_cast<float>(sector) + u.y) / kSide;
        const float r = std::sqrt(r2);
        cosine[lane] = std::sqrt(std::max(0.0f, 1 - r2));
        const glm::vec3 w = frame.to_world({r * std::cos(phi), r * std::sin(phi), cosine[lane]});
        packet.dir_x[lane] = w.x;
        packet.dir_y[lane] = w.y;
        packet.dir_z[lane] = w.z;
        lanes[lane] = cosine[lane] > 0 ? -1 : 0;
    }
    const std::uint64_t traced = keep_unoccluded(rays, packet, lanes);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        if (lanes[lane] != 0) {
            const double weight =
                pi / kLanes * fresnel_transmittance(static_cast<double>(cosine[lane]), eta) *
                let_through(lights.between, receiver.origin, direction_of(packet, lane));
            const float* radiance = lights.towards(direction_of(packet, lane));
            for (std::size_t l = 0; l < lights.lights; ++l) {
                irradiance[l] += weight * static_cast<double>(radiance[l]);
            }
        }
    }
    return traced;
}

std::uint64_t add_smooth_radiance(const RayScene& rays, const SmoothLights& lights,
                                  const Receiver& receiver, glm::vec3 direction, double factor,
                                  std::span<double> radiance) {
    RayPacket packet = rays_from(receiver.origin);
    LaneMask lanes{-1};
    packet.dir_x[0] = direction.x;
    packet.dir_y[0] = direction.y;
    packet.dir_z[0] = direction.z;
    const std::uint64_t traced = keep_unoccluded(rays, packet, lanes);
    if (lanes[0] != 0) {
        const float* from = lights.towards(direction);
        factor *= let_through(lights.between, receiver.origin, direction);
        for (std::size_t l = 0; l < lights.lights; ++l) {
            radiance[l] += factor * static_cast<double>(from[l]);
        }
    }
    return traced;
}

ReflectionTruth make_reflection_truth(std::span<const TestLight> lights,
                                      const DensitySpace* between) {
    constexpr std::uint32_t kRaysPerSun = 16;
    return {make_texel_directions(kTruthCubemap), make_sun_rays(lights, kRaysPerSun, between),
            lights};
}

TwoEstimates eval_reflection(const ReflectionTruth& truth, const RayScene& rays,
                             const Receiver& receiver, std::uint64_t& traced) {
    Luminance reflected(truth.lights.size());
    if (receiver.normal != glm::vec3(0)) {
        std::vector<float> dense(truth.lights.front().smooth.size());
        traced += gather_irradiance(rays, truth.directions, receiver, dense);
        dim(truth.suns.between, receiver.origin, dense);
        traced += add_sun_irradiance(rays, truth.suns, receiver, 1, reflected);
        for (std::size_t l = 0; l < truth.lights.size(); ++l) {
            reflected[l] =
                std::numbers::inv_pi * (reflected[l] + relit(dense, truth.lights[l].smooth));
        }
    }
    return {reflected, reflected};
}

}  // namespace opaline::bake
