#pragma once

#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"
#include "bake/plan/plan_input.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

namespace transmission_knobs {
inline bool is_crossed(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, "transmission");
}
}  // namespace transmission_knobs

/// Views through a body from each receiver. Their light is spread over the sky between them.
inline constexpr KnobSpec kStraightViews{
    .name = "transmission_views",
    .option = "--transmission-views",
    .placeholder = "V",
    .help =
        "views through a medium from each receiver, along which light is followed that crosses it "
        "unscattered; default as the quality says",
    .lowest = 16,
    .highest = 65536,
    .preset = {32, 64, 256, 1024},
    .label = "%g views through bodies",
    .ladder = {16, 32, 64, 256, 1024},
    .diagonal = {32, 64, 128, 256, 512},
    .truths = {1024, 1024, 1024, 256, 256, 256},
    .theory = {.label = "views through bodies",
               .words = "the width of what a view's light is spread over",
               .rate = -0.5},
    .matters = transmission_knobs::is_crossed};

/// Rows of a receiver that say how light that crosses a body changes with the view; 0: by medium.
inline constexpr KnobSpec kStraightTerms{
    .name = "transmission_terms",
    .option = "--transmission-terms",
    .placeholder = "K",
    .help =
        "rows of a receiver for light that crosses a medium unscattered: 1, the same for all "
        "views, 4 or 9; default: as many as the body and the quality ask for",
    .lowest = 1,
    .highest = 9,
    .zero_is_auto = true,
    .allowed = {1, 4, 9},
    .preset = {0, 0, 0, 0},
    .label = "K = %g through bodies",
    .matters = transmission_knobs::is_crossed};

/// Share of even light that crosses a ball of the medium straight, as its surface shows it on
/// average over views: the mean of e^(-depth c') under F_t(c) c, c' the cosine c refracted.
/// `depth` >= 0: optical, along the diameter. It is an upper bound for every point of a body at
/// which a ball of that diameter touches the surface from inside (README.md, "Bounds").
double straight_share(double eta, double depth);

/// The share that a typical point of a body shows, in its clearest band: 1 where its thickness is
/// not known.
double typical_share(const formats::Medium& medium, const MaterialFacts& body);

/// The same of thin parts: the bound of the rule.
double thin_share(const formats::Medium& medium, const MaterialFacts& body);

/// The rules `transmission` and, after it, `transmission.view`.
PlanEntry decide_transmission(const PlanInput& input);
PlanEntry decide_straight_views(const PlanInput& input);

/// Warns where Knobs::error_target is less than rows err by, a quarter of the light that crosses at
/// least: Spot, of which 97 % crosses, errs by 24 % with 4 and with 9 rows of 384 coefficients.
/// Speaks of the decision `transmission.view` alone.
void warn_of_reach(const PlanInput& input, const PlanEntry& entry,
                   std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
