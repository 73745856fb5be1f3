#include "bake/plan/row_layout.h"

#include <algorithm>
#include <numbers>

namespace opaline::bake {

double RowLayout::view_of_multiple() const {
    // Y_00 where the row is one of several harmonics, 1 where it stands alone.
    return !separate && single_terms > 1 ? 0.5 * std::numbers::inv_sqrtpi : 1.0;
}

std::vector<RowLayout> layout_rows(const formats::Scene& scene, const std::vector<PlanEntry>& plan,
                                   const Knobs& knobs) {
    std::vector<RowLayout> layouts(scene.materials.size());
    for (std::uint32_t m = 0; m < layouts.size(); ++m) {
        RowLayout& layout = layouts[m];
        const auto is_on = [&](const char* effect) {
            const PlanEntry* const entry = find_entry(plan, effect, m);
            return entry != nullptr && entry->on;
        };
        layout.direct = is_on("direct");
        layout.occluded = is_on("light.visibility");
        layout.translucent = scene.materials[m].medium.has_value() && !layout.direct;
        layout.multiple = is_on("multiple");
        layout.single_terms = !is_on("single")        ? 0
                              : is_on("single.terms") ? find_entry(plan, "single.terms", m)->terms
                                                      : 1;
        // Multiple scattering alone in its row is told to be so.
        layout.separate = layout.translucent && (knobs.separate_terms || layout.single_terms == 0);
        layout.local = layout.translucent && (layout.multiple || layout.single_terms > 0) &&
                       !is_on("multiple.spread");
        layout.glossy = layout.translucent && is_on("specular");
        layout.grey = layout.translucent && !is_on("light.colour");
    }
    return layouts;
}

bool needs_hierarchy(std::span<const RowLayout> layouts) {
    return std::any_of(layouts.begin(), layouts.end(), [](const RowLayout& l) {
        return l.multiple || l.single_terms > 0 || (l.occluded && (l.direct || l.glossy));
    });
}

}  // namespace opaline::bake
