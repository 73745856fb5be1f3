#pragma once

#include <vector>

#include "bake/plan/bill.h"
#include "bake/plan/row_layout.h"
#include "bake/plan/scene_facts.h"
#include "bake/plan/stage_costs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// All that the costs of one bake follow from.
struct CostedBake {
    const formats::Scene& scene;
    const SceneFacts& facts;
    std::vector<RowLayout> layouts;
    CostInput input;

    const formats::Medium& medium(std::uint32_t m) const { return *scene.materials[m].medium; }
};

/// What it costs to know how wrong the file is: one stage each.
///
/// The pilot's, as choose_knobs runs them if the first choice is met: what its receivers truly send
/// out; rows of the opaque ones, under all encodings; rows of those in media, once for each of some
/// values of the knobs, and once for all encodings.
void bill_pilot_truth(const CostedBake& bake, Bill& bill);
void bill_opaque_trials(const CostedBake& bake, Bill& bill);
void bill_media_trials(const CostedBake& bake, Bill& bill);
/// As check_rows does it.
void bill_self_check(const CostedBake& bake, Bill& bill);

}  // namespace opaline::bake
