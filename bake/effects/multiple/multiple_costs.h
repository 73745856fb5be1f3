#pragma once

#include "bake/plan/effect.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Number of samples on the surface of a medium.
double expected_samples(const formats::Medium& medium, double area, const Knobs& knobs);

/// Mean number of nodes and samples that a gather sums for a receiver: a patch over which the
/// profile changes by less than `tolerance` counts as one.
double count_weights(const formats::Medium& medium, const MaterialFacts& facts, double samples,
                     double tolerance);

/// Work of the steps of this effect (multiple.cpp).
Work profile_work(const SubjectCost& cost);
Work samples_work(const SubjectCost& cost);
Work multiple_rows_work(const SubjectCost& cost);
Work multiple_truth_work(const SubjectCost& cost, double points);
/// Of the samples and their tree, at most.
double sample_bytes(const Knobs& knobs);

}  // namespace opaline::bake
