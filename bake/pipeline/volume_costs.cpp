#include "bake/pipeline/volume_costs.h"

#include <algorithm>
#include <utility>

#include "bake/pipeline/volume_stages.h"
#include "bake/volumes/volume_effects.h"
#include "bake/volumes/volume_knobs.h"
#include "bake/volumes/volume_parts.h"

namespace opaline::bake {
namespace {

// The entry of a volume with a name that is on; null where there is none.
PlanEntry* payer_of(std::span<PlanEntry> plan, std::uint32_t volume, std::string_view name) {
    const auto found = std::ranges::find_if(plan, [&](const PlanEntry& entry) {
        return entry.on && entry.subject.kind == Subject::Kind::volume &&
               entry.subject.index == volume && entry.name == name;
    });
    return found == plan.end() ? nullptr : &*found;
}

// Walks of a volume that gather light of volumes: they fly as the others do, and sum emission along
// their flights: through half of the volume as a guess, three channels at twice the time of one.
Work glow_work(const VolumeWork& work, const VolumeLayout& layout) {
    constexpr double kShortWalk = 2, kGlowing = 0.5 * 2;
    if (!(work.nodes > 0) || layout.glow_walks == 0) {
        return {};
    }
    const double flights =
        work.walks > 0 && work.flights > 0 ? work.flights / (work.nodes * work.walks) : kShortWalk;
    const double steps = work.depth_steps / (work.nodes * work.cells);
    return {0, work.nodes * layout.glow_walks * work.tracks *
                   (flights * kVolumeFlight + kGlowing * steps * kDensityStep)};
}

// Three halves a term, four bytes a voxel of the bricks that glow: half of them as a guess.
double glow_bytes(const VolumeWork& work, const VolumeLayout& layout) {
    return 6 * work.nodes * layout.glow_terms + (layout.glows ? 2 * work.voxels : 0);
}

}  // namespace

CostedVolumes make_costed_volumes(const CostRequest& request) {
    CostedVolumes volumes;
    VolumeParts parts = part_volumes(
        request.scene, plan_volumes(request.scene, request.knobs).layouts, request.knobs);
    volumes.works = count_volume_work(parts.scene_or(request.scene), parts.layouts, request.knobs);
    volumes.layouts = std::move(parts.layouts);
    return volumes;
}

void bill_volumes(const CostRequest& request, const CostedVolumes& volumes, double row_count,
                  std::span<PlanEntry> volume_plan, Bill& bill) {
    for (PlanEntry& entry : volume_plan) {
        entry.predicted_seconds = 0;
        entry.predicted_bytes = 0;
    }
    if (volumes.empty()) {
        return;
    }
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    const auto for_each = [&](std::string_view name, auto&& visit) {
        for (std::size_t i = 0; i < volumes.works.size(); ++i) {
            visit(volumes.works[i], payer_of(volume_plan, volumes.layouts[i].whole, name));
        }
    };
    bill.open("light in volumes");
    for_each(kOnceInVolumes, [&](const VolumeWork& work, PlanEntry* payer) {
        bill.add(attenuation_work(input, work), payer);
        bill.add_bytes(volume_density_bytes(work));
        bill.add_bytes(attenuated_row_bytes(work, request.knobs), payer);
    });
    if (sees_surfaces(volumes.layouts)) {
        bill.open("surfaces that volumes see");
        const auto first = std::ranges::find(volumes.layouts, true, &VolumeLayout::sees_surfaces);
        bill.add(seen_surfaces_work(input, volumes.works, request.facts.receivers, row_count),
                 payer_of(volume_plan, first->whole, kSurfacesToVolumes));
    }
    bill.open(scattering_stage(volumes.layouts));
    for (std::size_t i = 0; i < volumes.works.size(); ++i) {
        // Walks and rows that light of the sky does not need are those of surfaces.
        const VolumeLayout& layout = volumes.layouts[i];
        PlanEntry* const payer = payer_of(volume_plan, layout.whole,
                                          layout.sees_sky ? kOftenInVolumes : kSurfacesToVolumes);
        bill.add(scattering_work(input, volumes.works[i]), payer);
        bill.add_bytes(scattered_row_bytes(volumes.works[i], request.knobs), payer);
    }
    if (std::ranges::any_of(volumes.layouts, &VolumeLayout::has_nodes)) {
        const VolumeCheckOptions check =
            volume_check_effort(volumes.works, volumes.layouts, request.knobs);
        double entries = 0;  // of all rows, once for each light
        for (const VolumeWork& work : volumes.works) {
            entries +=
                work.nodes * work.bands * request.knobs[kVolumeCoefficients] * (check.probes + 1);
        }
        bill.open("self-check of volumes");
        bill.add(
            {0, static_cast<double>(check.max_events) * kTracedCollision + entries * kGatherEntry});
    }
    if (count_glowing(volumes.layouts) > 0) {
        bill.open("light of volumes");
        for (std::size_t i = 0; i < volumes.works.size(); ++i) {
            PlanEntry* const payer = payer_of(volume_plan, volumes.layouts[i].whole, kEmitters);
            bill.add(glow_work(volumes.works[i], volumes.layouts[i]), payer);
            bill.add_bytes(glow_bytes(volumes.works[i], volumes.layouts[i]), payer);
        }
        bill.open("self-check of light of volumes");
        const VolumeCheckOptions check =
            volume_check_effort(volumes.works, volumes.layouts, request.knobs);
        bill.add({0, static_cast<double>(check.max_events) * kTracedCollision});
    }
    if (request.facts.receivers > 0) {
        bill.open("shadows of volumes");
        bill.add(dimming_work(input, volumes.works, request.facts.receivers, row_count));
        for (std::size_t i = 0; i < volumes.works.size(); ++i) {
            const VolumeLayout& layout = volumes.layouts[i];
            bill.add(sent_light_work(input, volumes.works[i], layout, request.facts.receivers),
                     payer_of(volume_plan, layout.whole, kVolumesToSurfaces));
        }
    }
}

}  // namespace opaline::bake
