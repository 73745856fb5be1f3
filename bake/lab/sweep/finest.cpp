#include "bake/lab/sweep/finest.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace opaline::bake {
namespace {

// What fills the rows of each material: "multiple+single".
std::vector<std::string> name_row_effects(const SweepResult& result, const EffectTable& effects,
                                          const formats::Scene& scene) {
    std::vector<std::string> names(scene.materials.size());
    for (std::uint32_t m = 0; m < names.size(); ++m) {
        const auto decisions = entries_of(result.plan, m);
        for (const EffectDescriptor& effect : effects.effects) {
            if (effect.truth.make != nullptr && acts_on(effect, decisions, {})) {
                names[m] += (names[m].empty() ? "" : "+") + std::string(effect.name);
            }
        }
    }
    return names;
}

}  // namespace

std::size_t find_finest(std::span<const PointRecord> points, std::string_view choices) {
    const auto worth = [&](const PointRecord& p) {
        return std::tuple{p.choices != choices, p.error.rms_relative, -p.seconds};
    };
    const auto finest = std::ranges::min_element(points, {}, worth);
    return static_cast<std::size_t>(finest - points.begin());
}

void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes,
                         std::span<const std::string> lights) {
    const std::vector<std::string> of_material = name_row_effects(result, effects, scene);
    std::vector<std::uint32_t> material;
    for (const formats::Primitive& p : scene.primitives) {
        material.insert(material.end(), p.position.size(), p.material);
    }
    std::vector<std::string> effect;
    for (const std::uint32_t probe : probes) {
        effect.push_back(of_material[material[probe]]);
    }
    std::map<std::string, std::size_t> count;
    for (PointRecord& record : result.points) {
        record.finest = find_finest(result.points, record.choices);
        ++count[record.choices];
    }
    const auto most = std::ranges::max_element(
        count, {}, [](const auto& choices_and_points) { return choices_and_points.second; });
    result.truth = find_finest(result.points, most->first);
    for (PointRecord& record : result.points) {
        const PointRecord& finest = result.points[record.finest];
        record.against_finest = compare_probes(record.luminance, finest.luminance, effect, lights);
        if (!record.volume_luminance.empty()) {
            const std::vector<std::string> of_volumes(record.volume_luminance.size() / kLightPlaces,
                                                      "volumes");
            take_larger(record.against_finest,
                        compare_probes(record.volume_luminance, finest.volume_luminance, of_volumes,
                                       volume_light_names()));
        }
        if (!record.layer_radiance.empty()) {
            const std::vector<std::string> of_layers(record.layer_radiance.size(), "cloud");
            const std::string light[] = {"layers"};
            take_larger(
                record.against_finest,
                compare_probes(record.layer_radiance, finest.layer_radiance, of_layers, light));
        }
        add_error_of_truth(record.against_finest, finest.error);
    }
}

}  // namespace opaline::bake
