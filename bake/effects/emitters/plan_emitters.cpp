#include "bake/effects/emitters/plan_emitters.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

#include "bake/effects/volumes/largest_light.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/exchange/lamps/point_box.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {
namespace {

// Between any two of their points, at least.
double distance_of(const PointBox& a, const PointBox& b) {
    return glm::length(glm::max(glm::dvec3(0), glm::max(a.low - b.high, b.low - a.high)));
}

// Upper bound on the share of light that a surface sends on; 1 with metals, thin walls or media.
double largest_albedo(const formats::Scene& scene) {
    float most = 0;
    for (const formats::Primitive& primitive : scene.primitives) {
        const formats::Material& material = scene.materials[primitive.material];
        const bool is_wall = !material.sheet || (material.sheet->transmit == formats::Rgb{} &&
                                                 material.sheet->clear == 0);
        if (material.medium || !is_wall || diffuse_share(material) < 1) return 1;
        const formats::Rgb c = material.base_color;
        most = std::max({most, c.r, c.g, c.b});
    }
    return std::min(1.0, static_cast<double>(most));
}

// Light that arrives where no volume scatters it, over pi: all voxels at the least distance.
double largest_far_light(const formats::Scene& scene, const formats::Volume& volume) {
    PointBox glow;
    formats::SparseGrid<glm::vec3> placed = volume.emission;
    placed.to_scene = volume.density.to_scene;
    for (const glm::dvec3& corner : placed.corners())
        glow.include(corner);
    glm::dvec3 sum(0);
    for (const glm::vec3& q : placed.value)
        sum += glm::dvec3(q);
    const double voxel = std::abs(glm::determinant(glm::dmat3(placed.to_scene)));
    const double distance = distance_of(box_of_surfaces(scene), glow);
    return distance > 0
               ? voxel * std::max({sum.x, sum.y, sum.z}) / (std::numbers::pi * distance * distance)
               : std::numeric_limits<double>::infinity();
}

double bound_on_surfaces(const formats::Scene& scene, const formats::Volume& volume) {
    const double glow = largest_glow(volume), seen = largest_scattered_glow(scene, volume);
    const double arriving = seen > glow ? seen : std::min(seen, largest_far_light(scene, volume));
    const double albedo = largest_albedo(scene);
    return albedo < 1 ? arriving / (1 - albedo) : std::numeric_limits<double>::infinity();
}

PlanEntry decide_volume(const formats::Scene& scene, const formats::Volume& volume,
                        const Subject& subject, bool has_surfaces, const Knobs& knobs) {
    constexpr std::size_t kDecisions = 2;  // on it and on its own light (plan_volumes)
    PlanEntry entry = decide_by_bound(
        kEmitters, subject, has_surfaces ? bound_on_surfaces(scene, volume) : 0, kDecisions, knobs);
    entry.has_bands = true;
    explain(entry, "a volume glows: surfaces have rows of its light",
            has_surfaces ? "too far from surfaces to be seen on them"
                         : "there is no surface that it could light");
    tell_forced(entry);
    return entry;
}

// Of a lamp's lights: its flux into the ball around all surfaces over that of a sky of radiance 1,
// which is pi times the ball's surface. Exporters write lux and candela: often hundreds of times as
// much.
double times_sky(const formats::Scene& scene, const Lamp& lamp, double radius) {
    const double sky = 4 * std::numbers::pi * std::numbers::pi * radius * radius;
    double flux = 0;
    for (const std::uint32_t index : lamp.lights) {
        const formats::Light& light = scene.lights[index];
        using enum formats::Light::Type;
        const double reach =
            light.type == directional ? std::numbers::pi * radius * radius
            : light.type == point
                ? 4 * std::numbers::pi
                : 2 * std::numbers::pi * (1 - std::cos(static_cast<double>(light.outer_cone)));
        flux += reach * static_cast<double>(formats::luminance(light.intensity));
    }
    return sky > 0 ? flux / sky : 0;
}

// [m] Of the ball around all surfaces; without any, around all volumes.
double radius_of(const formats::Scene& scene) {
    PointBox box = box_of_surfaces(scene);
    if (box.low.x > box.high.x) {
        for (const formats::Volume& volume : scene.volumes) {
            for (const glm::dvec3& corner : volume.density.corners()) {
                box.include(corner);
            }
        }
    }
    return box.low.x <= box.high.x ? box.radius() : 0;
}

std::string describe_light(const formats::Scene& scene, const Lamp& lamp, double radius) {
    char text[128];
    if (!lamp.lights.empty()) {
        std::snprintf(text, sizeof text,
                      "it sends out light, %.3g times that of a sky of radiance 1: rows of its own",
                      times_sky(scene, lamp, radius));
        return text;
    }
    float most = 0;
    for (const std::uint32_t p : lamp.primitives) {
        most = std::max(most,
                        formats::luminance(scene.materials[scene.primitives[p].material].emission));
    }
    std::snprintf(text, sizeof text,
                  "its surfaces glow, %.3g times as bright as a sky of radiance 1: rows of its own",
                  static_cast<double>(most));
    return text;
}

}  // namespace

EmitterPlan plan_emitters(const formats::Scene& scene, const Knobs& knobs) {
    EmitterPlan plan;
    const bool has_surfaces =
        std::ranges::any_of(scene.primitives, [](const auto& p) { return !p.index.empty(); });
    const bool is_scattered = std::ranges::any_of(scene.volumes, [](const formats::Volume& volume) {
        return brightest(volume).once >= kLeastBound;
    });
    const bool is_lit = has_surfaces || is_scattered;
    std::uint32_t number = 0;
    std::vector<Lamp> lamps = list_lamps(scene);
    const double radius = lamps.empty() ? 0 : radius_of(scene);
    for (const Lamp& lamp : lamps) {
        PlanEntry entry;
        entry.name = kEmitters;
        entry.subject = {Subject::Kind::emitter, number++, "emitter '" + lamp.name + "'"};
        entry.has_bands = true;
        entry.bound = is_lit ? std::numeric_limits<double>::quiet_NaN() : 0;
        entry.on = is_lit && is_wanted(knobs, entry.name);
        entry.reason = entry.on ? describe_light(scene, lamp, radius) +
                                      (is_scattered ? "; volumes scatter it" : "")
                       : is_lit ? "left out by --effects"
                                : "there is nothing that it could light";
        if (entry.on) plan.lamps.push_back(lamp);
        plan.entries.push_back(std::move(entry));
    }
    std::uint32_t glow = 0;
    for (std::uint32_t v = 0; v < scene.volumes.size(); ++v) {
        const formats::Volume& volume = scene.volumes[v];
        if (!is_seen_to_glow(volume, knobs)) continue;
        Lamp lamp{.name = free_emitter_name(volume.emitter, names_of(lamps)),
                  .primitives = {},
                  .lights = {},
                  .volume = v,
                  .glow = glow++};
        const Subject subject{Subject::Kind::emitter, number++, "emitter '" + lamp.name + "'"};
        PlanEntry entry = decide_volume(scene, volume, subject, has_surfaces, knobs);
        if (entry.on) plan.lamps.push_back(lamp);
        lamps.push_back(std::move(lamp));
        plan.entries.push_back(std::move(entry));
    }
    return plan;
}

}  // namespace opaline::bake
