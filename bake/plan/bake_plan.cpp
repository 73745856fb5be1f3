#include "bake/plan/bake_plan.h"

#include <algorithm>

#include "bake/plan/plan_rules.h"

namespace opaline::bake {

std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const Knobs& knobs) {
    std::vector<PlanSubject> subjects(scene.materials.size());
    for (const formats::Primitive& primitive : scene.primitives) {
        PlanSubject& subject = subjects[primitive.material];
        subject.receivers += static_cast<double>(primitive.position.size());
        if (primitive.color.empty()) {
            subject.brightest_vertex = 1.0f;
        }
        for (const formats::Rgb c : primitive.color) {
            subject.brightest_vertex = std::max({subject.brightest_vertex, c.r, c.g, c.b});
        }
        if (scene.materials[primitive.material].medium) {
            subject.area += formats::surface_area(primitive);
            for (const glm::vec3 x : primitive.position) {
                subject.low = glm::min(subject.low, x);
                subject.high = glm::max(subject.high, x);
            }
        }
    }
    std::vector<PlanEntry> plan;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (subjects[m].receivers == 0) {
            continue;
        }
        const PlanInput input{scene.materials[m], subjects[m], knobs};
        for (const auto& rule : kPlanRules) {
            if (rule.applies(input)) {
                PlanEntry entry = rule.decide(input);
                entry.effect = rule.effect;
                entry.subject = "material '" + input.material.name + "'";
                entry.material = m;
                plan.push_back(std::move(entry));
            }
        }
    }
    return plan;
}

const PlanEntry* find_entry(const std::vector<PlanEntry>& plan, std::string_view effect,
                            std::uint32_t material) {
    const auto entry = std::find_if(plan.begin(), plan.end(), [&](const PlanEntry& e) {
        return e.effect == effect && e.material == material;
    });
    return entry == plan.end() ? nullptr : &*entry;
}

}  // namespace opaline::bake
