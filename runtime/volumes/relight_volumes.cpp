#include "runtime/volumes/relight_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "formats/opal/half.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/parallel.h"
#include "runtime/volumes/moment_lights.h"
#include "runtime/volumes/sun_light.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/texel_integrals.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;
using formats::VolumeRecord;

// Nodes per block: a light vector stays in the cache while it meets all of them.
constexpr std::uint32_t kBlock = 256;

constexpr float kMostReach = 2;  // shares of light are 1 at most; rows err

float finite(float x) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::isnan(x) ? 0.0f : std::clamp(x, -kLargest, kLargest);
}
Rgb finite(Rgb c) {
    return {finite(c.r), finite(c.g), finite(c.b)};
}

// What is shown of a volume.
struct Shown {
    std::uint32_t single = 0, multiple = 0;  ///< K_s and K_m

    Shown(const VolumeRecord& record, TermSet terms)
        : single(has_any(terms, TermSet::volume_single) ? record.single_terms : 0),
          multiple(has_any(terms, TermSet::volume_multiple) ? record.multiple_terms : 0) {}
};

// The most terms of light of emitters that are not switched off.
std::uint32_t glow_terms(std::span<const formats::GlowRecord> glow, const EmitterLight& emitters) {
    std::uint32_t most = 0;
    for (const formats::GlowRecord& each : glow) {
        if (emitters.color_of(each.emitter) != Rgb{}) most = std::max(most, each.terms);
    }
    return most;
}

// The light in the forms that volumes need: moments of the rest for volumes with suns, of the whole
// for others.
struct Lights {
    const LightVector& whole;
    std::vector<LightVector> moment, moment_of_rest;
    struct SunLight {
        LightVector vector;
        Rgb whole;                // unattenuated light: <V, vector> is a share of it
        std::uint32_t joint = 0;  // its number among those of other directions
    };
    std::vector<SunLight> sun;

    std::span<const LightVector> moments(const VolumeLight::Part& part) const {
        return part.suns > 0 ? moment_of_rest : moment;
    }
};

// Which volumes meet suns, and the light for all of them; fills `result`, coefficients with 0.
Lights prepare(const formats::VolumesView& volumes, const LightVector& light,
               const RelightVolumesOptions& options, VolumeLight& result) {
    Lights lights{light, {}, {}, {}};
    std::vector<char> meets_suns;
    std::uint32_t moments = 0, moments_of_rest = 0;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const VolumeRecord& record = volumes.records[v];
        const Shown shown(record, options.terms);
        meets_suns.push_back(shown.single > 0 && needs_suns(record, volumes.phase_of(v)) ? 1 : 0);
        std::uint32_t& most = meets_suns.back() != 0 ? moments_of_rest : moments;
        most = std::max(most, shown.single);
    }
    if (moments + moments_of_rest > 0) {
        const std::vector<double> integral = texel_integrals(light);
        SplitLight split;
        if (moments_of_rest > 0) split = split_suns(integral, light.n);
        // Without suns the rest is the whole.
        if (split.sun.empty()) moments = std::max(moments, std::exchange(moments_of_rest, 0));
        lights.moment = make_moment_lights(integral, light.n, moments, options.threads);
        lights.moment_of_rest =
            make_moment_lights(split.rest, light.n, moments_of_rest, options.threads);
        for (const Sun& sun : split.sun) {
            const auto same = std::ranges::find_if(result.sun, [&](formats::Vec3 d) {
                return d.x == sun.direction.x && d.y == sun.direction.y && d.z == sun.direction.z;
            });
            lights.sun.push_back(
                {make_sun_light(sun, light.n),
                 {static_cast<float>(sun.light[0]), static_cast<float>(sun.light[1]),
                  static_cast<float>(sun.light[2])},
                 static_cast<std::uint32_t>(same - result.sun.begin())});
            if (same == result.sun.end()) result.sun.push_back(sun.direction);
        }
    }
    std::size_t size = 0;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const Shown shown(volumes.records[v], options.terms);
        const auto glow = volumes.glow.of_volume(v);
        const formats::GlowRecord* const own = volumes.glow.own_of(v);
        const bool shows_own = own != nullptr && options.emitters.shows_own;
        result.glow.push_back(shows_own ? options.emitters.color_of(own->emitter) : Rgb{});
        VolumeLight::Part part{
            std::max({shown.single, shown.multiple, glow_terms(glow, options.emitters)}), 0, size};
        result.sun_phase.emplace_back();
        if (meets_suns[v] != 0 && !result.sun.empty()) {
            part.suns = static_cast<std::uint32_t>(result.sun.size());
            result.sun_phase.back() = make_sun_phase(volumes.records[v], volumes.phase_of(v));
            part.sun_terms = result.sun_phase.back().terms;
            part.sun_power = result.sun_phase.back().power;
        }
        part.sun_boxes = sun_boxes(volumes.records[v]);
        part.first += part.suns + volumes.records[v].brick_count * part.brick_stride();
        size = part.first + std::size_t{volumes.records[v].node_count} * part.terms;
        result.part.push_back(part);
    }
    result.coefficient.resize(size);
    for (const VolumeLight::Part& part : result.part) {
        if (part.suns == 0) continue;
        for (const Lights::SunLight& sun : lights.sun) {
            Rgb& all = result.coefficient[part.first - part.suns + sun.joint];
            all = finite(all + sun.whole);
        }
    }
    return lights;
}

// Everything that the blocks of a volume share.
struct Job {
    const formats::VolumesView& volumes;
    const VolumeRecord& record;
    const VolumeLight::Part& part;
    const Lights& lights;
    Shown shown;
    DotPath path;
    std::span<const formats::GlowRecord> glow;
    EmitterLight emitters;
    std::span<const Rgb> sent;  // by each sun
};

// Coefficients of the nodes from `first` to `end`, and shares of suns' light that reach them.
struct Block {
    std::uint32_t first, end;
    std::span<Rgb> coefficient;
    std::span<Rgb> reach;
};

// (-1)^l m_l by k.
std::array<float, formats::kMaxHarmonics> phase_factors(const VolumeRecord& record) {
    std::array<float, formats::kMaxHarmonics> factor{};
    for (std::size_t l = 0, k = 0; l < formats::kMaxVolumeMoments; ++l) {
        for (std::size_t m = 0; m < 2 * l + 1; ++m) {
            factor[k++] = (l % 2 == 0 ? 1.0f : -1.0f) * record.moment[l];
        }
    }
    return factor;
}

// factor <V, light> to coefficient j of each node.
void add_attenuated(const Job& job, const Block& block, const LightVector& light, float factor,
                    std::uint32_t j) {
    for (std::uint32_t node = block.first; node < block.end; ++node) {
        Rgb product;
        dot_rows(job.volumes.rows, job.record.rows(), light, node * job.record.terms(),
                 {&product, 1}, job.path);
        Rgb& c = block.coefficient[std::size_t{node - block.first} * job.part.terms + j];
        c = c + factor * product;
    }
}

// Shares of suns' light that reach nodes, as rows have them: parts of a sun together.
void find_reach(const Job& job, const Block& block) {
    const std::size_t suns = job.part.suns;
    if (suns == 0) return;
    const auto share = [](float e, float sent) { return sent > 0 ? e / sent : 0.0f; };
    for (const Lights::SunLight& sun : job.lights.sun) {
        const Rgb sent = job.sent[sun.joint];
        for (std::uint32_t node = block.first; node < block.end; ++node) {
            Rgb e;
            dot_rows(job.volumes.rows, job.record.rows(), sun.vector, node * job.record.terms(),
                     {&e, 1}, job.path);
            Rgb& sum = block.reach[(node - block.first) * suns + sun.joint];
            sum = sum + Rgb{share(e.r, sent.r), share(e.g, sent.g), share(e.b, sent.b)};
        }
    }
    std::ranges::transform(block.reach, block.reach.begin(),
                           [](Rgb c) { return tame(c, kMostReach); });
}

void add_single(const Job& job, const Block& block) {
    const auto factor = phase_factors(job.record);
    for (std::uint32_t k = 0; k < job.shown.single; ++k) {
        add_attenuated(job, block, job.lights.moments(job.part)[k], factor[k], k);
    }
    find_reach(job, block);
}

void add_multiple(const Job& job, const Block& block) {
    if (job.shown.multiple == 0) return;
    std::array<Rgb, formats::kMaxHarmonics> product;
    const auto own = std::span<Rgb>(product).first(job.shown.multiple);
    const float scale = job.shown.multiple == 1 ? std::sqrt(4 * std::numbers::pi_v<float>) : 1.0f;
    for (std::uint32_t node = block.first; node < block.end; ++node) {
        dot_rows(job.volumes.rows, job.record.rows(), job.lights.whole,
                 node * job.record.terms() + 1, own, job.path);
        for (std::uint32_t k = 0; k < job.shown.multiple; ++k) {
            Rgb& c = block.coefficient[std::size_t{node - block.first} * job.part.terms + k];
            c = c + scale * own[k];
        }
    }
}

// What nodes scatter of one emitter's light.
void add_glow(const Job& job, const Block& block, const formats::GlowRecord& glow) {
    const Rgb color = job.emitters.color_of(glow.emitter);
    if (color == Rgb{}) return;
    const std::size_t terms = glow.terms;
    const Rgb scale = glow.value_scale * color;
    const auto value = job.volumes.glow.value.subspan(glow.first_value);
    for (std::uint32_t node = block.first; node < block.end; ++node) {
        for (std::size_t k = 0; k < terms; ++k) {
            const std::size_t i = 3 * (node * terms + k);
            Rgb& c = block.coefficient[std::size_t{node - block.first} * job.part.terms + k];
            c = c + scale * Rgb{formats::float_from_half(value[i]),
                                formats::float_from_half(value[i + 1]),
                                formats::float_from_half(value[i + 2])};
        }
    }
}

}  // namespace

VolumeLight relight_volumes(const formats::VolumesView& volumes, const LightVector& light,
                            const RelightVolumesOptions& options) {
    VolumeLight result;
    const Lights lights = prepare(volumes, light, options, result);
    std::vector<std::vector<Rgb>> reach(volumes.records.size());
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const VolumeRecord& record = volumes.records[v];
        const VolumeLight::Part& part = result.part[v];
        const Job job{
            volumes,
            record,
            part,
            lights,
            {record, options.terms},
            options.path,
            volumes.glow.of_volume(v),
            options.emitters,
            std::span<const Rgb>(result.coefficient).subspan(part.first - part.suns, part.suns)};
        reach[v].resize(std::size_t{record.node_count} * part.suns);
        const auto own = std::span<Rgb>(result.coefficient).subspan(part.first);
        for_ranges(record.node_count, kBlock, options.threads,
                   [&](std::uint32_t first, std::uint32_t end) {
                       const Block block{
                           first, end,
                           own.subspan(std::size_t{first} * part.terms,
                                       std::size_t{end - first} * part.terms),
                           std::span(reach[v]).subspan(std::size_t{first} * part.suns,
                                                       std::size_t{end - first} * part.suns)};
                       add_single(job, block);
                       add_multiple(job, block);
                       for (const formats::GlowRecord& glow : job.glow) {
                           add_glow(job, block, glow);
                       }
                       std::ranges::transform(block.coefficient, block.coefficient.begin(),
                                              [](Rgb c) { return finite(c); });
                   });
    }
    light_sun_points(volumes, reach, options.threads, result);
    return result;
}

}  // namespace opaline::runtime
