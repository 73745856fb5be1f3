#pragma once

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

}  // namespace opaline::bake
