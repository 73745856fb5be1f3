#include "bake/accuracy/model_lights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/environment/builtin_environment.h"
#include "bake/truth/test_lights.h"
#include "formats/opal/rgb.h"
#include "runtime/shade.h"

namespace opaline::bake {
namespace {

// Far from the point, in direction `to_eye`.
formats::Vec3 far_eye(formats::Vec3 point, glm::vec3 to_eye) {
    const float away = 1 + std::abs(point.x) + std::abs(point.y) + std::abs(point.z);
    return point + away * formats::Vec3{to_eye.x, to_eye.y, to_eye.z};
}

}  // namespace

bool has_refraction(const formats::Scene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const auto& p) {
        const auto& medium = scene.materials[p.material].medium;
        return medium && !p.index.empty() && !is_matched(medium->eta);
    });
}

formats::Result<std::vector<ModelLight>> make_model_lights(const formats::Scene& scene,
                                                           std::vector<std::string>& left_out) {
    const bool with_suns = !has_refraction(scene);
    std::vector<ModelLight> lights;
    for (const char* name : published_lights()) {
        auto environment = make_environment(name);
        if (!environment) {
            return std::move(environment).error();
        }
        ModelLight light{name, std::move(*environment)};
        if (!with_suns && !light.environment.discs.empty()) {
            left_out.emplace_back(name);
            if (light.environment.pixel.empty()) {
                continue;
            }
            light.environment.discs.clear();
            light.name += " without its sun";
        }
        lights.push_back(std::move(light));
    }
    return lights;
}

std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const FileLight& light) {
    runtime::ShadeOptions shading;
    shading.emitters = light.emitters;
    if (light.mirrored != nullptr) {
        shading.terms = TermSet::specular;
        shading.specular = light.mirrored;
    }
    std::vector<double> luminance;
    for (const ReferenceReceiver& r : receivers) {
        const std::uint32_t vertex = asset.primitives[r.primitive].first_vertex + r.vertex;
        shading.eye.reset();
        if (glm::dot(r.to_eye, r.normal) < 0) {
            shading.eye = far_eye(asset.position[vertex], r.to_eye);
        }
        formats::Rgb radiance;
        runtime::shade_range(asset, light.vector, vertex, {&radiance, 1}, shading);
        luminance.push_back(static_cast<double>(formats::luminance(radiance)));
    }
    return luminance;
}

}  // namespace opaline::bake
