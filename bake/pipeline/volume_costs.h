#pragma once

#include <vector>

#include "bake/pipeline/costed_bake.h"
#include "bake/volumes/volume_work.h"

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

/// The stages of add_volumes in order, without those of qualities that a target error tries first.
/// `row_count`: rows of all vertices.
void bill_volumes(const CostRequest& request, const CostedVolumes& volumes, double row_count,
                  Bill& bill);

}  // namespace opaline::bake
