#include "bake/effects/emitters/bake_emitters.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/interrupted.h"
#include "bake/effects/emitters/cross_media.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/emitters/immersed_lamps.h"
#include "bake/effects/emitters/lamp_rows.h"
#include "bake/effects/emitters/lit_media.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "bake/physics/medium_flight.h"
#include "bake/scene/lobe_record.h"

namespace opaline::bake {
namespace {

// Elements at most: as many as a quarter of the particles, which some four reach each.
double finest_area(const formats::Scene& scene, std::uint32_t particles) {
    const double area = reflecting_area(scene);
    return area > 0 ? 4 * area / particles : 1;
}

// Receivers read a caustic at one place each, and its particles end soon.
std::uint32_t caustic_particles(std::uint32_t particles) {
    constexpr std::uint32_t kTimes = 16, kMost = 2000000;
    return std::max(particles,
                    std::min(kMost, particles > kMost / kTimes ? kMost : kTimes * particles));
}

double sum_of_weights(std::span<const ElementDeposit> deposits) {
    double sum = 0;
    for (const ElementDeposit& deposit : deposits)
        sum += deposit.weight;
    return sum;
}

// Whether caustics get particles of their own.
bool is_bright(const ParticleLight& light) {
    return sum_of_weights(light.caustic) > sum_of_weights(light.all) / 128;
}

void subtract(std::span<const ElementDeposit> part, std::span<ElementDeposit> all) {
    for (std::size_t i = 0; i < part.size(); ++i) {
        all[i].power -= part[i].power;
        all[i].weight -= part[i].weight;
        all[i].weight_squares -= part[i].weight_squares;
    }
}

glm::dvec3 extinction_of(const formats::Medium& medium) {
    const std::array<float, 3> s = isotropic_scattering(medium);
    const formats::Rgb& a = medium.sigma_a;
    return glm::dvec3(s[0], s[1], s[2]) + glm::dvec3(a.r, a.g, a.b);
}

// In deep media each is followed for long: fewer, by the flights of some of them. 0 where these
// hardly come out.
std::uint32_t particles_inside(const EmitterJob& job, const LampSources& lamp,
                               const ElementLayout& layout, ParticleRun run,
                               const Context& context) {
    constexpr double kFlights = 4e6, kLeast = 2000;
    constexpr std::uint32_t kSome = 256;
    run.particles = kSome;
    std::uint64_t rays = 0;
    trace_particles(job.scene, job.rays, lamp, layout, run, context, rays);
    const double flights = static_cast<double>(rays) / kSome;
    if (!(flights < kMostFlightsInside / 4.0)) return 0;
    const double fitting = kFlights / std::max(1.0, flights);
    return static_cast<std::uint32_t>(
        std::clamp(fitting, kLeast, std::max(kLeast, job.knobs[kEmitterParticles])));
}

/// What particles bring to surfaces before it is scattered.
struct TracedLamps {
    std::optional<ElementLayout> layout;  // of caustics, where there are any
    std::vector<ElementLight> caustics;   // of each lamp, as receivers read them
    std::vector<ArrivedParticles> arrived;
    std::optional<ElementLayout> coarse;  // of what leaves media around lamps
    std::vector<ElementLight> leaving;    // of each lamp
    std::vector<std::uint32_t> immersed;  // lamps whose light stays in the medium around them
};

// Groups of elements have so many particles of what leaves a medium, or more.
constexpr JoinRule kLeavingElements{1, 256};

// Whether particles are followed in it: not where walks join several media, where it varies, or
// where what scatters often is left out.
bool is_followed(const EmitterJob& job, std::uint32_t material) {
    if (material == formats::kNone) return false;
    const formats::Medium& medium = *job.scene.materials[material].medium;
    return !medium.variation && !(medium.thickness > 0) && !job.media.layouts.empty() &&
           job.media.layouts[material].constant && !job.media.layouts[material].layered;
}

// `sources` get the extinction of media that particles are followed in.
TracedLamps trace_lamps(const EmitterJob& job, std::span<LampSources> sources,
                        const DensitySpace* volumes, const Context& context, std::uint64_t& rays) {
    const std::uint32_t particles = whole(job.knobs, kEmitterParticles);
    const std::uint32_t more = caustic_particles(particles);
    TracedLamps traced;
    const ElementLayout& coarse =
        traced.coarse.emplace(job.scene, finest_area(job.scene, particles));
    const auto make_cells = [&](const ElementLayout& layout) {
        const std::size_t count =
            job.surfaces != nullptr ? job.surfaces->transfer.scatterers.size() : 0;
        return count == 0 ? std::nullopt
                          : std::optional<CellsOfElements>(std::in_place, job.scene,
                                                           job.surfaces->tree, count, layout);
    };
    const std::optional<CellsOfElements> cells = make_cells(coarse);
    std::optional<CellsOfElements> caustic_cells;
    traced.caustics.resize(sources.size());
    traced.leaving.resize(sources.size());
    traced.arrived.resize(sources.size());
    for (std::uint32_t e = 0; e < sources.size() && !context.cancelled(); ++e) {
        ParticleRun run{particles, e, job.knobs.seed, 0, job.textures};
        run.volumes = volumes;
        run.ends_diffuse = true;
        const std::uint32_t around = medium_around(job.scene, job.rays, sources[e]);
        if (is_followed(job, around)) {
            run.medium = around;
            run.particles = particles_inside(job, sources[e], coarse, run, context);
            if (run.particles == 0) {
                run.medium = formats::kNone;
                run.particles = particles;
            }
        }
        if (run.medium != formats::kNone) {
            sources[e].extinction = extinction_of(*job.scene.materials[around].medium);
        } else if (around != formats::kNone) {
            traced.immersed.push_back(e);
        }
        ParticleLight first =
            trace_particles(job.scene, job.rays, sources[e], coarse, run, context, rays);
        const bool has_caustic = has_light(first.caustic), has_more = is_bright(first);
        subtract(first.caustic, first.all);
        if (cells && job.lamps[e].volume == formats::kNone) {
            traced.arrived[e].straight = cells->sum(first.all);
        }
        if (has_light(first.leaving)) {
            traced.leaving[e] = coarse.join(first.leaving, kLeavingElements);
            if (cells) traced.arrived[e].leaving = cells->sum(first.leaving);
        }
        if (!has_caustic) continue;
        if (!traced.layout) {
            traced.layout.emplace(job.scene, finest_area(job.scene, more));
            caustic_cells = make_cells(*traced.layout);
        }
        if (has_more && run.medium == formats::kNone) run.particles = more;
        const std::vector<ElementDeposit> caustic =
            trace_particles(job.scene, job.rays, sources[e], *traced.layout, run, context, rays)
                .caustic;
        traced.caustics[e] = traced.layout->join(caustic, kCausticElements);
        if (caustic_cells) traced.arrived[e].caustic = caustic_cells->sum(caustic);
    }
    return traced;
}

std::vector<std::optional<GlowLight>> make_glow_lights(const EmitterJob& job, unsigned threads) {
    std::vector<std::optional<GlowLight>> glow;
    for (std::uint32_t e = 0; e < job.lamps.size(); ++e) {
        const Lamp& lamp = job.lamps[e];
        const bool glows = lamp.volume != formats::kNone;
        glow.push_back(make_glow_light(job.scene, lamp.volume, job.volumes,
                                       glows ? lamp.glow : job.first_scattered + e, threads));
    }
    return glow;
}

void append_own_light(const formats::Scene& scene, std::span<const Lamp> lamps,
                      formats::Emitters& emitters) {
    for (std::uint32_t e = 0; e < lamps.size(); ++e) {
        for (const std::uint32_t p : lamps[e].primitives) {
            const formats::Material& material = scene.materials[scene.primitives[p].material];
            const bool has_image =
                material.emission_image != formats::kNone && !scene.primitives[p].texcoord.empty();
            emitters.own.push_back({p, e, material.emission,
                                    has_image ? material.emission_image : formats::kNoImage,
                                    has_image ? material.emission_wrap_u : formats::Wrap::repeat,
                                    has_image ? material.emission_wrap_v : formats::Wrap::repeat});
        }
    }
    std::ranges::sort(emitters.own, {}, &formats::OwnLight::primitive);
}

}  // namespace

formats::Result<BakedEmitters> bake_emitters(const EmitterJob& job, const Context& context,
                                             StageLog& log) {
    std::vector<LampSources> sources;
    sources.reserve(job.lamps.size());
    for (const Lamp& lamp : job.lamps) {
        sources.push_back(make_lamp_sources(job.scene, lamp, job.textures));
    }
    std::optional<DensitySpace> space;
    if (!job.scene.volumes.empty()) space = make_density_space(job.scene);
    const DensitySpace* const volumes = space ? &*space : nullptr;
    const auto glow = make_glow_lights(job, context.threads);
    const TracedLamps traced = run_stage(log, "particles of emitters", [&](std::uint64_t& rays) {
        return trace_lamps(job, sources, volumes, context, rays);
    });
    const LampLight lamps{job.scene,
                          job.rays,
                          sources,
                          whole(job.knobs, kEmitterRays),
                          job.knobs.seed,
                          traced.caustics,
                          traced.layout ? &*traced.layout : nullptr,
                          volumes,
                          glow,
                          traced.leaving,
                          &*traced.coarse,
                          job.textures};
    const LampBounces light = run_stage(log, "surfaces lit by emitters", [&](std::uint64_t& rays) {
        return find_lamp_bounces(lamps, job.surfaces, traced.arrived, context, rays);
    });
    BakedEmitters baked;
    LampRowsOfMedia of_media(job.primitives.size());
    if (job.media.finished != nullptr) {
        of_media = run_stage(log, "media lit by emitters", [&](std::uint64_t& rays) {
            LampRowsOfMedia rows =
                light_media(job.media, light, job.receivers, job.primitives, context, rays);
            for (std::uint32_t p = 0; p < rows.size() && !context.cancelled(); ++p) {
                if (job.primitives[p].shading != formats::Shading::translucent) continue;
                add_crossing_light(*job.media.finished, job.receivers[p], light, rows[p], context,
                                   rays);
                add_leaving_light(lamps, job.receivers[p],
                                  job.media.layouts[job.receivers[p].material], rows[p], rays);
            }
            return rows;
        });
    }
    for (const Lamp& lamp : job.lamps) {
        append_emitter(baked.emitters, lamp.name);
    }
    append_own_light(job.scene, job.lamps, baked.emitters);
    run_stage(log, "light of emitters", [&](std::uint64_t& rays) {
        for (std::uint32_t p = 0; p < job.primitives.size() && !context.cancelled(); ++p) {
            const formats::PrimitiveRecord& record = job.primitives[p];
            const ReceiverSet& set = job.receivers[p];
            if (set.size() == 0) continue;
            const auto rows = record.shading == formats::Shading::translucent
                                  ? std::move(of_media[p])
                                  : make_lamp_rows(light, set, record.terms, context, rays);
            for (std::uint32_t e = 0; e < rows.size(); ++e) {
                append_block(baked.emitters, e, p, rows[e]);
            }
        }
        return true;
    });
    if (context.cancelled()) return interrupted();
    baked.error = run_stage(log, "self-check of emitters", [&](std::uint64_t& rays) {
        std::vector<std::uint32_t> glowing;
        for (const Lamp& lamp : job.lamps) {
            if (lamp.volume != formats::kNone) glowing.push_back(lamp.volume);
        }
        const std::vector<GlowingGrid> grids = make_glowing_grids(job.scene, glowing);
        const bool scatters =
            std::ranges::any_of(job.volumes.glow.record, [&](const formats::GlowRecord& record) {
                return record.emitter >= job.first_scattered && record.terms > 0;
            });
        return check_emitters({job.scene, job.rays, job.receivers, job.primitives, sources,
                               baked.emitters.view(), &light, volumes, grids, scatters},
                              job.knobs.seed, context, rays);
    });
    if (context.cancelled()) return interrupted();
    for (const std::uint32_t e : traced.immersed) {
        baked.immersed.push_back(job.lamps[e].name);
    }
    return baked;
}

}  // namespace opaline::bake
