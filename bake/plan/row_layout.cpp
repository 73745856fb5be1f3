#include "bake/plan/row_layout.h"

#include <algorithm>
#include <numbers>

#include "bake/plan/effect.h"

namespace opaline::bake {

double RowLayout::view_of_constant() const {
    // Y_00 where the row is one of several harmonics, 1 where it stands alone.
    return !separate && all_harmonics() > 1 ? 0.5 * std::numbers::inv_sqrtpi : 1.0;
}

RowLayout layout_material(const EffectTable& effects, const formats::Material& material,
                          std::span<const PlanEntry> decisions, const Knobs& knobs) {
    RowLayout layout;
    layout.translucent = material.medium.has_value();
    layout.sheet = material.sheet.has_value();
    for (const PlanEntry& entry : decisions) {
        rule_of(effects, entry).lay_out(entry, layout);
    }
    if (knobs.separate_terms || layout.at_entry || !layout.constant) {
        layout.view_harmonics = layout.straight_harmonics = 0;
    }
    // A row for all views that stands alone is marked as such in the file, unless it holds what
    // both of them would.
    const bool stands_alone = layout.all_harmonics() == 0 ? !(layout.constant && layout.all_orders)
                                                          : knobs.separate_terms;
    layout.separate = layout.translucent && stands_alone;
    layout.at_entry = layout.at_entry && layout.translucent && layout.has_rows();
    layout.coloured = layout.coloured && layout.constant;
    layout.grey = layout.grey && !layout.coloured && (layout.translucent || layout.sheet);
    return layout;
}

std::vector<RowLayout> layout_rows(const EffectTable& effects, const formats::Scene& scene,
                                   std::span<const PlanEntry> plan, const Knobs& knobs) {
    std::vector<RowLayout> layouts;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        layouts.push_back(layout_material(effects, scene.materials[m], entries_of(plan, m), knobs));
    }
    return layouts;
}

bool needs_hierarchy(std::span<const RowLayout> layouts) {
    return std::any_of(layouts.begin(), layouts.end(), [](const RowLayout& l) {
        return (l.translucent && l.has_rows()) || (l.occluded && (l.constant || l.mirrors));
    });
}

}  // namespace opaline::bake
