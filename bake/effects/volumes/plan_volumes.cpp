#include "bake/effects/volumes/plan_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "bake/effects/volumes/choose_method.h"
#include "bake/effects/volumes/coarse_volume.h"
#include "bake/effects/volumes/lamp_spacing.h"
#include "bake/effects/volumes/largest_light.h"
#include "bake/effects/volumes/node_albedo.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_parts.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/plan/plan_input.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/density/scaled_phase.h"

namespace opaline::bake {
namespace {

// On a volume: they share what may be left out.
constexpr std::size_t kDecisions = 3;

// Light that was scattered before reaches a node nearly evenly from all around, except at the
// volume's edge: degree l of the newly scattered light is at most lambda_l of it.
std::uint32_t choose_terms(const ScaledPhase& phase, const Knobs& knobs) {
    if (const double given = knobs[kVolumeTerms]; given > 0) {
        return std::min(static_cast<std::uint32_t>(given), phase.harmonics());
    }
    constexpr std::array<double, 4> kTolerance{0.3, 0.2, 0.05, 0.0};
    const double tolerance = kTolerance[static_cast<std::size_t>(knobs.quality)];
    std::uint32_t degree = 0;
    for (unsigned l = 1; l <= phase.degree; ++l) {
        degree = std::abs(phase.lambda[l]) > tolerance ? l : degree;
    }
    return (degree + 1) * (degree + 1);
}

// Walks leave a node in all directions alike, and J(w_o) weighs each by p' between the two: of W
// walks as many count as W / (4 pi int p'^2 dw), the integral being a sum over degrees of those
// moments that the rows have.
std::uint32_t choose_walks(const ScaledPhase& phase, std::uint32_t terms, const Knobs& knobs) {
    double spread = 0;
    for (unsigned l = 0; l * l < terms; ++l) {
        spread += (2 * l + 1) * phase.lambda[l] * phase.lambda[l];
    }
    return static_cast<std::uint32_t>(std::lround(knobs[kVolumeWalks] * spread));
}

std::uint32_t spacing_of(const formats::Scene& scene, const formats::Volume& volume,
                         const DensityVolume& own, const Knobs& knobs) {
    if (const double given = knobs[kVolumeSpacing]; given > 0) {
        return static_cast<std::uint32_t>(given);
    }
    const auto quality = static_cast<std::size_t>(knobs.quality);
    std::uint32_t spacing =
        choose_spacing(own.grid->value, volume.density.to_scene,
                       static_cast<double>(std::ranges::max(own.sigma_t)), spacing_depth(knobs));
    spacing = typical_spacing(lamp_spacings(scene, volume.density, knobs), volume.density, spacing);
    // Where albedos differ, they are known at nodes alone.
    constexpr std::array<double, 4> kDetail{0.2, 0.1, 0.05, 0.02};
    while (lost_albedo_detail(own, spacing) > kDetail[quality]) {
        spacing /= 2;
    }
    return spacing;
}

// Joins voxels until the nodes are as few as the quality bakes.
void join_for_quality(const formats::Scene& scene, const formats::Volume& volume,
                      const Knobs& knobs, VolumeLayout& layout) {
    constexpr std::uint32_t kMostJoined = 64;
    const auto has_too_many = [&](const formats::Volume& own) {
        return count_nodes_of_parts(scene, own, layout, knobs) > most_nodes(knobs.quality);
    };
    if (knobs[kVolumeSpacing] > 0 || !has_too_many(volume)) return;
    formats::Scene alone;
    do {
        layout.joined *= 2;
        alone.volumes = {join_voxels(volume, static_cast<int>(layout.joined))};
        layout.spacing =
            spacing_of(scene, alone.volumes[0], make_density_space(alone).volumes[0], knobs);
    } while (has_too_many(alone.volumes[0]) && layout.joined < kMostJoined);
}

std::string tell_joined(const VolumeLayout& layout) {
    const std::string edge = std::to_string(layout.joined);
    return layout.joined == 1 ? ""
                              : "; its voxels are joined to means of " + edge + " x " + edge +
                                    " x " + edge + ", as this quality has too few points for more";
}

PlanEntry decide(std::string_view name, const Subject& subject, double bound, const Knobs& knobs) {
    return decide_by_bound(name, subject, bound, kDecisions, knobs);
}

// What is known of a volume whose density is the same in places; "" where it is nowhere.
std::string tell_evenness(const DensityVolume& volume) {
    const double share = even_share(volume);
    char text[128] = "";
    if (share > 0) {
        std::snprintf(
            text, sizeof text,
            "; density is even in %.3g %% of its cells: depths and flights in closed form",
            100 * share);
    }
    return text;
}

// Of all volumes together: those that glow are seen through each other.
double all_glow(const formats::Scene& scene, const Knobs& knobs) {
    double sum = 0;
    for (const formats::Volume& volume : scene.volumes) {
        sum += is_wanted(knobs, kEmitters) ? largest_glow(volume) : 0;
    }
    return sum;
}

// Of light E of volumes a line scatters at most s E, s = alpha d; that of s E again s^2 E, and so
// on.
double scattered_glow(double glow, double once) {
    return once < 1 ? glow * once / (1 - once) : std::numeric_limits<double>::max();
}

PlanEntry decide_glow(const formats::Volume& volume, const Subject& subject, const Knobs& knobs) {
    PlanEntry entry = decide(kEmitters, subject, largest_glow(volume), knobs);
    entry.has_bands = true;
    explain(entry, "it sends out light by itself, as an emitter",
            "what it sends out by itself is too dark to be seen beside light of radiance 1");
    return entry;
}

// `scatters`: nodes of the volume have light.
PlanEntry decide_sent(const formats::Scene& scene, const formats::Volume& volume, bool scatters,
                      const Subject& subject, const Knobs& knobs) {
    PlanEntry entry = decide(kVolumesToSurfaces, subject, largest_sent_light(scene, volume), knobs);
    if (entry.on && !scatters) {
        entry.on = entry.forced = false;
        entry.reason = "what the volume scatters is left out";
    }
    explain(entry, "surfaces receive what the volume scatters",
            "what it scatters is too dark, or surfaces are too far away");
    return entry;
}

// Of light 1, surfaces send at most their share to a volume, which scatters at most `once` of it.
PlanEntry decide_seen(const SentShare& share, double once, const Subject& subject,
                      const Knobs& knobs) {
    PlanEntry entry = decide(kSurfacesToVolumes, subject, share.all * once, knobs);
    entry.has_bands = !share.is_grey;
    explain(entry, "the volume scatters what surfaces send to it",
            "so thin or dark that what surfaces send to it is not seen");
    return entry;
}

// Rows of multiple scattering: light of the sky that the volume scattered before, and of surfaces.
void lay_out_often(const PlanEntry& often, const PlanEntry& seen, const ScaledPhase& phase,
                   const Knobs& knobs, VolumeLayout& layout) {
    layout.sees_sky = often.on;
    layout.sees_surfaces = seen.on;
    if (often.on || seen.on) {
        layout.often_terms = choose_terms(phase, knobs);
        layout.walks = choose_walks(phase, layout.often_terms, knobs);
        // Rows of degree l need as many views as they are, twice for good measure.
        layout.views = std::max(whole(knobs, kVolumePaths), 2 * layout.often_terms);
    }
}

// What nodes of a volume scatter of the light of all volumes, and of lamps, which may be as bright
// as they like.
void scatter_glow_of_all(double glow, bool has_lamps, double once, const ScaledPhase& phase,
                         const Knobs& knobs, VolumeLayout& layout) {
    const double bound = has_lamps ? once : scattered_glow(glow, once);
    if (bound >= least_bound(knobs, kDecisions) || (knobs.simulate_all && bound > 0)) {
        layout.glow_terms = phase.harmonics();
        layout.glow_walks = choose_walks(phase, layout.glow_terms, knobs);
    }
}

std::string why_dark(const VolumeBrightness& most) {
    return most.albedo <= 0          ? "the volume absorbs and does not scatter"
           : most.seen < kLeastBound ? "the volume is so thin that it is not seen"
                                     : "hardly any light is scattered: thin, or its albedo is low";
}

}  // namespace

formats::Status check_bakeable(const formats::Scene& scene) {
    for (const formats::Volume& volume : scene.volumes) {
        if (volume.paper) {
            return formats::make_error(
                formats::ErrorKind::bad_input, volume.name, "fidelity",
                "bakes of volumes are physical: the formulas of [Premoze2003] as printed are for "
                "pictures alone",
                "leave fidelity out, or draw it: opaline reference --method path-integration");
        }
    }
    return formats::ok_status();
}

bool is_seen_to_glow(const formats::Volume& volume, const Knobs& knobs) {
    return !volume.emission.empty() && decide_glow(volume, {}, knobs).on;
}

bool lights_surfaces(std::span<const PlanEntry> plan) {
    return is_on(plan, kVolumesToSurfaces);
}

bool sees_surfaces(std::span<const PlanEntry> plan) {
    return is_on(plan, kSurfacesToVolumes);
}

const char* scattering_stage(std::span<const VolumeLayout> layouts) {
    const auto goes_by_paths = [](const VolumeLayout& layout) {
        return layout.method == VolumeMethod::path_integration;
    };
    return std::ranges::any_of(layouts, goes_by_paths) ? "paths through volumes"
                                                       : "walks through volumes";
}

double spacing_depth(const Knobs& knobs) {
    constexpr std::array<double, 4> kDepth{2, 1, 0.5, 0.25};
    return kDepth[static_cast<std::size_t>(knobs.quality)];
}

VolumePlan plan_volumes(const formats::Scene& scene, const Knobs& knobs) {
    VolumePlan plan;
    const DensitySpace space = make_density_space(scene);
    const double glow = all_glow(scene, knobs);
    const bool has_lamps = is_wanted(knobs, kEmitters) && !list_lamps(scene).empty();
    const SentShare share = largest_share_of_surfaces(scene);
    for (std::uint32_t v = 0; v < scene.volumes.size(); ++v) {
        const formats::Volume& volume = scene.volumes[v];
        const VolumeBrightness most = brightest(volume);
        const Subject subject{Subject::Kind::volume, v, volume.name};
        const ScaledPhase phase = scale_phase(volume.phase);
        PlanEntry once = decide(kOnceInVolumes, subject, most.once, knobs);
        PlanEntry often = decide(kOftenInVolumes, subject, most.once * most.once, knobs);
        VolumeLayout layout{.volume = v,
                            .spacing = spacing_of(scene, volume, space.volumes[v], knobs)};
        layout.whole = v;
        layout.once_terms = once.terms = once.on ? phase.harmonics() : 0;
        explain(once,
                (once.terms == 1
                     ? "light is scattered alike in all directions: one view term"
                     : "light is scattered once: " + std::to_string(once.terms) + " view terms") +
                    tell_evenness(space.volumes[v]),
                why_dark(most));
        explain(often, "",
                once.on ? "so thin or dark that light is scattered once at most" : why_dark(most));
        PlanEntry seen = decide_seen(share, most.once, subject, knobs);
        lay_out_often(often, seen, phase, knobs, layout);
        often.terms = often.on ? layout.often_terms : 0;
        seen.terms = seen.on ? layout.often_terms : 0;
        if (glow > 0 || has_lamps) {
            scatter_glow_of_all(glow, has_lamps, most.once, phase, knobs, layout);
        }
        if (layout.has_nodes()) join_for_quality(scene, volume, knobs, layout);
        once.reason += tell_joined(layout);
        std::vector<PlanEntry> entries{std::move(once), std::move(often)};
        if (!volume.emission.empty()) {
            entries.push_back(decide_glow(volume, subject, knobs));
            layout.glows = entries.back().on;
        }
        if (!scene.primitives.empty()) {
            const bool scatters = layout.once_terms > 0 || layout.often_terms > 0;
            entries.push_back(decide_sent(scene, volume, scatters, subject, knobs));
            layout.lights_surfaces = entries.back().on;
            entries.push_back(std::move(seen));
        }
        for (PlanEntry& entry : entries) {
            plan.entries.push_back(std::move(entry));
        }
        if (most.seen >= kLeastBound || layout.has_nodes() || layout.glows) {
            plan.layouts.push_back(layout);
        }
    }
    const bool coloured = !share.is_grey && sees_surfaces(plan.layouts);
    for (VolumeLayout& layout : plan.layouts) {
        layout.coloured = coloured;
    }
    plan_methods(scene, knobs, plan.layouts, plan.entries);
    for (PlanEntry& entry : plan.entries) {
        tell_forced(entry);
    }
    return plan;
}

}  // namespace opaline::bake
