#pragma once

#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/plan/effect.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Seconds of a sample: its place (blue noise); a texel of its transform and truncation.
inline constexpr double kPlaceSample = 1e-5, kTruncateTexel = 5.1e-9;

/// Coefficients that a sample or node keeps; those below its horizon vanish.
double kept_by_samples(const Knobs& knobs);

/// Where walks are expected to start.
SitePlan expected_sites(const formats::Medium& medium, const MaterialFacts& body,
                        const Knobs& knobs);

/// Scatterings and reflections of a walk through a body, on average: at albedo 1 eta^2 4 V / (S
/// mean_free_path escape) (walks/README.md, "The estimator"), fewer where walks end by absorption.
/// A body without a volume is taken for a ball of its area.
double count_body_events(const formats::Medium& medium, const MaterialFacts& body);

/// Work of walks from sites, and of the rows of receivers between them.
Work walks_work(const SubjectCost& cost);
Work walked_rows_work(const SubjectCost& cost);

/// Number of samples on the surface of a medium, `area` [m^2], for so many receivers.
double expected_samples(const formats::Medium& medium, double area, double receivers,
                        const Knobs& knobs);

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
