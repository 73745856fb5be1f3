#pragma once

#include <vector>

#include "bake/effects/volumes/volume_work.h"
#include "bake/pipeline/costed_bake.h"

namespace opaline::bake {

/// The cost of measuring the error of the file, one stage each.
///
/// The pilot's, as choose_knobs runs them if the first choice is met: the truth of its receivers;
/// rows of those that depend on no trial, under all encodings; rows of the others, once for each of
/// some values of the knobs, and once for all encodings.
void bill_pilot_truth(const CostedBake& bake, Bill& bill);
void bill_fixed_trials(const CostedBake& bake, Bill& bill);
void bill_other_trials(const CostedBake& bake, Bill& bill);
/// The self-check's stages, as in check_rows.
void bill_self_check(const CostedBake& bake, Bill& bill);

/// The volumes of a bake, with their work.
struct CostedVolumes {
    std::vector<VolumeLayout> layouts;
    std::vector<VolumeWork> works;

    bool empty() const { return layouts.empty(); }
};
CostedVolumes make_costed_volumes(const CostRequest& request);

/// Light of surfaces that volumes alone see (find_surface_light).
void bill_surface_light(const CostRequest& request, const CostedVolumes& volumes, Bill& bill);

/// The stages of bake_and_measure in order, without those of qualities that a target error tries
/// first.
void bill_volumes(const CostRequest& request, const CostedVolumes& volumes, Bill& bill);

/// What volumes add to the stage of `rows` of `receivers` (complete_rows.h).
void bill_completion(const CostRequest& request, const CostedVolumes& volumes, double receivers,
                     double rows, Bill& bill);

}  // namespace opaline::bake
