#pragma once

#include <span>
#include <vector>

#include "bake/pipeline/bill.h"
#include "bake/volumes/volume_work.h"

namespace opaline::bake {

/// The volumes of a bake, with their work.
struct CostedVolumes {
    std::vector<VolumeLayout> layouts;
    std::vector<VolumeWork> works;

    bool empty() const { return layouts.empty(); }
};
CostedVolumes make_costed_volumes(const CostRequest& request);

/// The stages of add_volumes in order, without those of qualities that a target error tries first.
/// `volume_plan`: as plan_volumes made it for the same knobs; its entries pay and get their
/// predictions. Empty: all share the costs. `row_count`: rows of all vertices.
void bill_volumes(const CostRequest& request, const CostedVolumes& volumes, double row_count,
                  std::span<PlanEntry> volume_plan, Bill& bill);

}  // namespace opaline::bake
