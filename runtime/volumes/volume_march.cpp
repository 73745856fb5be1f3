#include "runtime/volumes/volume_march.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

// A volume that the ray meets, with the brick where it is or comes to next.
struct Traveller {
    const LitVolumes::Entry* entry = nullptr;
    BrickWalk walk;
    double voxel = 0;  ///< distance in the world within which the ray crosses one voxel
    BrickSpan span;
    BrickBlock block;
    bool is_left = true;  ///< behind its last brick
    SourceWeights weight{};

    // At the eight nodes, and at the eight points of suns around the last point, which many share.
    std::uint32_t cell = formats::kNoNode, sun_box = formats::kNoNode;
    std::array<Rgb, 8> source{};
    std::array<SunSource, 8> suns{};
};

void advance(Traveller& traveller) {
    const VolumeLattice& lattice = traveller.entry->lattice;
    const auto span = next_brick(lattice, traveller.walk);
    traveller.is_left = !span;
    if (!span) return;
    traveller.span = *span;
    traveller.block = brick_block(lattice, span->cell);
    traveller.cell = traveller.sun_box = formats::kNoNode;
}

std::vector<Traveller> start(const LitVolumes& volumes, const MarchRay& ray) {
    std::vector<Traveller> travellers;
    for (const LitVolumes::Entry& entry : volumes.entry) {
        Traveller traveller;
        traveller.entry = &entry;
        traveller.walk = start_walk(entry.lattice, ray.origin, ray.direction, ray.begin, ray.end);
        if (!(traveller.walk.t < traveller.walk.end)) continue;
        const auto& d = traveller.walk.direction;
        traveller.voxel = 1 / (formats::kBrickSide * std::hypot(d[0], d[1], d[2]));
        if (!(traveller.voxel > 0) || !std::isfinite(traveller.voxel)) continue;
        advance(traveller);
        if (traveller.is_left) continue;
        traveller.weight = source_weights(*volumes.light, entry.volume, -1 * ray.direction);
        travellers.push_back(traveller);
    }
    return travellers;
}

// What suns add to J; `left` of it comes through to the eye. That counts at each point anew: where
// a ray comes into a box differs by a step between renderers that round differently.
Rgb suns_at(Traveller& traveller, const VolumeLight& light, const std::array<float, 3>& at,
            Rgb left) {
    const LitVolumes::Entry& entry = *traveller.entry;
    const VolumeLight::Part& part = light.part[entry.volume];
    const NodeCell box = box_at(part.sun_boxes, at);
    if (traveller.sun_box != box.number) {
        traveller.sun_box = box.number;
        const auto points = points_of_box(part.sun_boxes, box.number);
        for (std::size_t i = 0; i < 8; ++i) {
            traveller.suns[i] = eval_suns(light, entry.volume, traveller.block.number[0], points[i],
                                          traveller.weight);
        }
    }
    const SunThrough through =
        find_sun_through(light.sun_phase[entry.volume], entry.lattice.record->albedo, left);
    return mix_suns(traveller.suns, part.sun_terms, box.weight, through);
}

// max(0, J) at a point of the brick, trilinear between nodes.
Rgb source_at(Traveller& traveller, const VolumeLight& light, const std::array<float, 3>& at,
              Rgb left) {
    const LitVolumes::Entry& entry = *traveller.entry;
    const NodeCell cell = node_cell(entry.lattice, at);
    if (traveller.cell != cell.number) {
        traveller.cell = cell.number;
        const auto nodes = nodes_of_cell(entry.lattice, traveller.block.number[0], cell.number);
        for (std::size_t i = 0; i < 8; ++i) {
            traveller.source[i] = eval_node(light, entry.volume, nodes[i], traveller.weight);
        }
    }
    Rgb source = mix_nodes(traveller.source, cell.weight);
    if (light.part[entry.volume].suns > 0) source = source + suns_at(traveller, light, at, left);
    return tame(source, kLargestSource);
}

// Voxels from the brick's voxel (0, 0, 0), at distance t.
std::array<float, 3> place_in_brick(const Traveller& traveller, double t) {
    std::array<float, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double p = traveller.walk.origin[a] + t * traveller.walk.direction[a];
        const auto local = static_cast<float>((p - traveller.span.cell[a]) * formats::kBrickSide);
        at[a] = tame(local, formats::kBrickSide);
    }
    return at;
}

// 1 - exp(-c h).
Rgb absorbed_over(Rgb c, float h) {
    const auto absorbed = [h](float band) { return band > 0 ? -std::expm1(-band * h) : 0.0f; };
    const float r = absorbed(c.r);
    if (c.r == c.g && c.g == c.b) return {r, r, r};  // most smoke: exponentials are dear
    return {r, absorbed(c.g), absorbed(c.b)};
}

// What a step adds up in a band: extinction c [1/m], scattering times source b, own light e.
struct Coefficients {
    float c = 0, b = 0, e = 0;
};

// One step of one band, of length h [m].
void step_band(const Coefficients& sum, float h, float absorbed, float& radiance,
               float& transmittance) {
    constexpr float kThin = 1e-6f;  // depth below which 1 - exp(-c h) is c h
    if (sum.e > 0) {
        const float way = sum.c * h > kThin ? absorbed / sum.c : h;
        radiance =
            std::min(radiance + transmittance * sum.e * way, std::numeric_limits<float>::max());
    }
    if (!(sum.c > 0)) return;
    radiance += transmittance * (sum.b / sum.c) * absorbed;
    transmittance *= 1 - absorbed;
}

void step(Rgb extinction, Rgb scattered, Rgb emitted, float h, MarchResult& result) {
    const Rgb absorbed = absorbed_over(extinction, h);
    Rgb& radiance = result.radiance;
    Rgb& transmittance = result.transmittance;
    step_band({extinction.r, scattered.r, emitted.r}, h, absorbed.r, radiance.r, transmittance.r);
    step_band({extinction.g, scattered.g, emitted.g}, h, absorbed.g, radiance.g, transmittance.g);
    step_band({extinction.b, scattered.b, emitted.b}, h, absorbed.b, radiance.b, transmittance.b);
}

// Everything that the segments of a ray share.
struct March {
    const VolumeLight& light;
    std::vector<Traveller> travellers;
    double step = 0.5;
    float least_transmittance = 0;
    MarchResult result;

    bool is_opaque() const {
        const Rgb t = result.transmittance;
        return std::max({t.r, t.g, t.b}) < least_transmittance;
    }
};

// From begin to end lies no face of a brick: the same volumes all along.
void march_segment(March& march, double begin, double end) {
    double voxel = HUGE_VAL;
    for (const Traveller& traveller : march.travellers) {
        if (traveller.span.begin <= begin) voxel = std::min(voxel, traveller.voxel);
    }
    // A brick's diagonal is 8 sqrt(3) voxels; where distances are rounded to more, that is enough.
    const double most = std::ceil(14 / march.step);
    const double count = std::clamp(std::ceil((end - begin) / (march.step * voxel)), 1.0, most);
    const double h = (end - begin) / count;
    for (double i = 0; i < count && !march.is_opaque(); ++i) {
        Rgb extinction, scattered, emitted;
        for (Traveller& traveller : march.travellers) {
            if (traveller.span.begin > begin) continue;
            const VolumeLattice& lattice = traveller.entry->lattice;
            const auto at = place_in_brick(traveller, begin + (i + 0.5) * h);
            const float density = density_at(lattice, traveller.block, at);
            const Rgb glow = march.light.glow[traveller.entry->volume];
            if (glow != Rgb{} && !traveller.entry->glow.empty()) {
                emitted = emitted + tame(glow * glow_at(traveller.entry->glow, traveller.block, at),
                                         kLargestSource);
            }
            if (!(density > 0)) continue;
            const Rgb c = tame(density * lattice.record->sigma_t, kLargestExtinction);
            extinction = extinction + c;
            scattered =
                scattered + c * lattice.record->albedo *
                                source_at(traveller, march.light, at, march.result.transmittance);
        }
        step(extinction, scattered, emitted, static_cast<float>(std::min(h, 1e30)), march.result);
    }
}

// Along the whole ray.
void follow(March& march) {
    for (double t = -HUGE_VAL; !march.travellers.empty();) {
        // The next stretch with at least one brick, up to where one of them ends or another begins.
        double begin = HUGE_VAL, end = HUGE_VAL;
        for (const Traveller& traveller : march.travellers) {
            begin = std::min(begin, std::max(t, traveller.span.begin));
        }
        for (const Traveller& traveller : march.travellers) {
            end = std::min(
                end, traveller.span.begin <= begin ? traveller.span.end : traveller.span.begin);
        }
        march_segment(march, begin, end);
        if (march.is_opaque()) return;
        t = end;
        for (Traveller& traveller : march.travellers) {
            if (traveller.span.end <= t) advance(traveller);
        }
        std::erase_if(march.travellers, [](const Traveller& each) { return each.is_left; });
    }
}

}  // namespace

LitVolumes light_volumes(const formats::VolumesView& volumes, const VolumeLight& light) {
    LitVolumes lit;
    lit.light = &light;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        if (const auto lattice = make_lattice(volumes, volumes.records[v])) {
            lit.entry.push_back({*lattice, v, make_glow(volumes, v)});
        }
    }
    return lit;
}

MarchResult march_volumes(const LitVolumes& volumes, const MarchRay& ray,
                          const MarchOptions& options) {
    March march{.light = *volumes.light,
                .travellers = start(volumes, ray),
                .step = static_cast<double>(std::clamp(options.step, 1.0f / 64, 8.0f)),
                .least_transmittance = options.least_transmittance,
                .result = {}};
    if (march.travellers.empty()) return march.result;
    follow(march);
    if (march.is_opaque()) march.result.transmittance = {};
    return march.result;
}

MarchSpan volumes_span(const LitVolumes& volumes, const MarchRay& ray) {
    MarchSpan span{ray.end, ray.begin};
    for (const LitVolumes::Entry& entry : volumes.entry) {
        const BrickWalk walk =
            start_walk(entry.lattice, ray.origin, ray.direction, ray.begin, ray.end);
        if (walk.t < walk.end) {
            span = {std::min(span.begin, walk.t), std::max(span.end, walk.end)};
        }
    }
    return span;
}

}  // namespace opaline::runtime
