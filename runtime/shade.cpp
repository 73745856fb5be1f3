#include "runtime/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/parallel.h"
#include "runtime/surface.h"
#include "runtime/texture.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;

// Rows per block: their colours stay in the nearest cache between the dot product and the colour.
constexpr std::uint32_t kBlock = 512;

// What is still to be multiplied keeps its sign.
float finite(float x) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::isnan(x) ? 0.0f : std::clamp(x, -kLargest, kLargest);
}

// Everything that blocks of a primitive share.
struct Job {
    const formats::AssetView& asset;
    const LightVector& light;
    const ShadeOptions& options;
    std::uint32_t number;  // of the primitive
    SurfaceMaterial material;

    const formats::PrimitiveRecord& primitive() const { return *material.primitive; }
    bool is_translucent() const { return primitive().shading == formats::Shading::translucent; }
    // What surfaces reflect or send out by themselves is added to what rows say.
    bool is_glossy() const { return material.gloss != nullptr && options.fresnel; }
};

Rgb base_color_of(const Job& job, std::uint32_t vertex) {
    return job.options.base_color ? vertex_base_color(job.asset, job.primitive(), vertex)
                                  : Rgb{1, 1, 1};
}

formats::Float2 texcoord_of(const Job& job, std::uint32_t vertex) {
    return job.asset.texcoord.empty() ? formats::Float2{} : job.asset.texcoord[vertex];
}

// Of a glossy primitive.
void set_openness(const Job& job, std::uint32_t vertex, SurfacePoint& point) {
    const formats::Openness openness = job.asset.openness[vertex];
    point.open_axis = formats::open_axis(openness);
    point.open_fraction = formats::open_fraction(openness);
}

ViewOfReceiver view_of(const Job& job, std::uint32_t vertex) {
    return view_receiver(job.primitive(), job.asset.position[vertex], job.asset.normal[vertex],
                         job.options.eye);
}

// <T_k, L> and the light of emitters; rows count from the primitive's first one.
void dot_and_emit(const Job& job, std::uint32_t first_row, std::span<Rgb> out) {
    dot_rows(job.asset.transport, job.asset.rows_of(job.number), job.light, first_row, out,
             job.options.path);
    add_emitters(job.asset.emitters, job.options.emitters, job.number, first_row, out);
}

// <T_0, L> of each slot; <T_1, L> of a thin-walled surface that is seen from behind.
void dot_opaque_slots(const Job& job, std::uint32_t first_slot, std::span<Rgb> out) {
    if (job.primitive().shading == formats::Shading::diffuse) {
        dot_and_emit(job, first_slot, out);
        return;
    }
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t slot = first_slot + i, vertex = job.asset.vertex_of(job.number, slot);
        const bool behind = is_seen_from_behind(job.asset.position[vertex],
                                                job.asset.normal[vertex], job.options.eye);
        dot_and_emit(job, 2 * slot + (behind ? 1 : 0), out.subspan(i, 1));
    }
}

// Calls show(i, <T_k, L> of slot first_slot + i) for i < count. Rows of several terms: as many
// slots at a time as fill a block.
template <class Show>
void dot_translucent_slots(const Job& job, std::uint32_t first_slot, std::uint32_t count,
                           const Show& show) {
    static_assert(kBlock > formats::kMaxHarmonics);
    std::array<Rgb, kBlock> products;
    const std::uint32_t terms = job.primitive().terms, step = kBlock / terms;
    for (std::uint32_t done = 0; done < count; done += step) {
        const std::uint32_t part = std::min(step, count - done);
        const std::span<Rgb> block = std::span<Rgb>(products).first(std::size_t{part} * terms);
        dot_and_emit(job, (first_slot + done) * terms, block);
        for (std::uint32_t i = 0; i < part; ++i) {
            show(done + i, block.subspan(std::size_t{i} * terms, terms));
        }
    }
}

// What rows say of consecutive slots, as their first vertices are seen.
void sum_slots(const Job& job, std::uint32_t first_slot, std::span<Rgb> out) {
    if (job.is_translucent()) {
        dot_translucent_slots(job, first_slot, static_cast<std::uint32_t>(out.size()),
                              [&](std::uint32_t i, std::span<const Rgb> product) {
                                  const std::uint32_t vertex =
                                      job.asset.vertex_of(job.number, first_slot + i);
                                  out[i] = sum_view_terms(view_of(job, vertex), job.primitive(),
                                                          product, job.options.terms);
                              });
    } else if (has_any(job.options.terms, TermSet::diffuse)) {
        dot_opaque_slots(job, first_slot, out);
    } else {
        std::fill(out.begin(), out.end(), Rgb{});
    }
}

// Of what rows say of opaque vertices, what they show.
void finish_opaque(const Job& job, std::uint32_t first_vertex, std::span<Rgb> out) {
    if (!job.is_glossy() && job.material.own == nullptr) {
        // As shade_surface() does it, without its cost: the rows take no longer than that.
        for (std::uint32_t i = 0; i < out.size(); ++i) {
            out[i] = displayable(out[i] * base_color_of(job, first_vertex + i));
        }
        return;
    }
    SurfaceMaterial material = job.material;
    if (!job.is_glossy()) material.gloss = nullptr;
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t vertex = first_vertex + i;
        SurfacePoint point;
        point.radiance = out[i];
        point.base_color = base_color_of(job, vertex);
        set_own_light(job.asset, material, texcoord_of(job, vertex), point);
        if (job.is_glossy()) {
            point.view = view_of(job, vertex);
            set_gloss_factors(job.asset, material, texcoord_of(job, vertex), point);
            set_openness(job, vertex, point);
        }
        out[i] = shade_surface(material, point);
    }
}

Rgb finish_translucent(const Job& job, std::uint32_t vertex, const ViewOfReceiver& view,
                       Rgb radiance) {
    SurfacePoint point;
    point.view = view;
    point.radiance = radiance;
    point.base_color = base_color_of(job, vertex);
    if (!job.options.fresnel) {
        const Rgb shown = point.radiance * point.base_color;
        return {finite(shown.r), finite(shown.g), finite(shown.b)};
    }
    if (job.material.lobe.is_glossy) set_openness(job, vertex, point);
    set_own_light(job.asset, job.material, texcoord_of(job, vertex), point);
    return shade_surface(job.material, point);
}

// Vertices that share no rows, a block of them. Each is a slot.
void shade_block(const Job& job, std::uint32_t first_vertex, std::span<Rgb> out) {
    const std::uint32_t first_slot = first_vertex - job.primitive().first_vertex;
    if (!job.is_translucent()) {
        sum_slots(job, first_slot, out);
        finish_opaque(job, first_vertex, out);
        return;
    }
    dot_translucent_slots(
        job, first_slot, static_cast<std::uint32_t>(out.size()),
        [&](std::uint32_t i, std::span<const Rgb> product) {
            const ViewOfReceiver view = view_of(job, first_vertex + i);
            out[i] = finish_translucent(
                job, first_vertex + i, view,
                sum_view_terms(view, job.primitive(), product, job.options.terms));
        });
}

// Vertices begin .. end - 1, and the results of those from `first` on.
struct ShadedPart {
    std::uint32_t begin, end, first;
    std::span<Rgb> out;

    bool has(std::uint32_t vertex) const { return vertex >= first && vertex - first < out.size(); }
    Rgb& at(std::uint32_t vertex) const { return out[vertex - first]; }
    std::span<Rgb> from(std::uint32_t vertex, std::uint32_t count) const {
        return out.subspan(vertex - first, count);
    }
};

void shade_vertices(const Job& job, const ShadedPart& part) {
    for (std::uint32_t v = part.begin; v < part.end;) {
        const std::uint32_t count = std::min(kBlock, part.end - v);
        shade_block(job, v, part.from(v, count));
        v += count;
    }
}

// Vertices that share rows, in three steps, since what a vertex shows is seen at other ones.
// Each step may be taken for all vertices before the next one.

// The first vertices of slots. Their slots are consecutive: they are numbered as they appear.
void sum_first_vertices(const Job& job, const ShadedPart& part) {
    const formats::SlotsView& slots = job.asset.slots;
    const auto own = slots.vertex.subspan(slots.offset[job.number], slots.count(job.number));
    const auto number_before = [&](std::uint32_t vertex) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(own, vertex) - own.begin());
    };
    std::array<Rgb, kBlock> sums;
    const std::uint32_t last = number_before(part.end);
    for (std::uint32_t slot = number_before(part.begin); slot < last;) {
        const std::span<Rgb> block = std::span(sums).first(std::min(kBlock, last - slot));
        sum_slots(job, slot, block);
        for (const Rgb& sum : block) {
            part.at(own[slot++]) = sum;
        }
    }
}

// What a slot shows, which its first vertex has where it is among the results.
Rgb shown_by(const Job& job, const ShadedPart& part, std::uint32_t slot) {
    const std::uint32_t shown = job.asset.vertex_of(job.number, slot);
    if (part.has(shown)) return part.at(shown);
    Rgb sum;
    sum_slots(job, slot, std::span(&sum, 1));
    return sum;
}

void sum_other_vertices(const Job& job, const ShadedPart& part) {
    const formats::SlotsView& slots = job.asset.slots;
    for (std::uint32_t v = part.begin; v < part.end; ++v) {
        const std::uint32_t slot = job.asset.slot_of(job.number, v);
        if (!slots.is_mixed(v)) {
            if (job.asset.vertex_of(job.number, slot) != v) part.at(v) = shown_by(job, part, slot);
            continue;
        }
        Rgb sum;
        for (std::size_t k = 0; k < std::size(slots.mix[v].slot); ++k) {
            const float weight = static_cast<float>(slots.mix[v].weight[k]) / 255;
            if (weight == 0) continue;
            sum = sum + weight * displayable(shown_by(
                                     job, part, slots.mix[v].slot[k] - slots.offset[job.number]));
        }
        part.at(v) = sum;
    }
}

void finish_vertices(const Job& job, const ShadedPart& part) {
    if (!job.is_translucent()) {
        finish_opaque(job, part.begin, part.from(part.begin, part.end - part.begin));
        return;
    }
    for (std::uint32_t v = part.begin; v < part.end; ++v) {
        part.at(v) = finish_translucent(job, v, view_of(job, v), part.at(v));
    }
}

// What of emitters is shaded with the surface itself: renderers add their own light per pixel.
EmitterLight own_lights(const ShadeOptions& options) {
    return options.base_color && options.fresnel ? options.emitters : dark_emitters();
}

using Step = void (*)(const Job&, const ShadedPart&);

// Takes a step for the vertices of a part, primitive by primitive.
void take_step(const formats::AssetView& asset, const PartLights& light, const ShadedPart& part,
               const ShadeOptions& options, Step step) {
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const auto end = static_cast<std::uint32_t>(std::min<std::uint64_t>(
            part.end, std::uint64_t{primitive.first_vertex} + primitive.vertex_count));
        const std::uint32_t begin = std::max(part.begin, primitive.first_vertex);
        if (begin >= end) continue;
        const SpecularLight* const specular = options.fresnel ? options.specular : nullptr;
        const Job job{asset, light.light[light.number(p)], options, static_cast<std::uint32_t>(p),
                      surface_material(asset, p, options.terms, specular, own_lights(options))};
        step(job, {begin, end, part.first, part.out});
    }
}

// Calls take(step) for each step in turn; where no vertices share rows there is one.
template <class Take>
void for_steps(const formats::AssetView& asset, const Take& take) {
    if (asset.slots.empty()) {
        take(shade_vertices);
        return;
    }
    for (const Step step : {sum_first_vertices, sum_other_vertices, finish_vertices}) {
        take(step);
    }
}

}  // namespace

void shade_range(const formats::AssetView& asset, const PartLights& light, std::uint32_t first,
                 std::span<Rgb> out, const ShadeOptions& options) {
    std::fill(out.begin(), out.end(), Rgb{});
    const ShadedPart all{first, first + static_cast<std::uint32_t>(out.size()), first, out};
    for_steps(asset, [&](Step step) { take_step(asset, light, all, options, step); });
}

void shade(const formats::AssetView& asset, const PartLights& light, std::span<Rgb> out,
           const ShadeOptions& options) {
    constexpr std::uint32_t kGrain = 2048;  // some microseconds of work for each claim of a range
    std::fill(out.begin(), out.end(), Rgb{});
    for_steps(asset, [&](Step step) {
        for_ranges(asset.receivers(), kGrain, options.threads,
                   [&](std::uint32_t begin, std::uint32_t end) {
                       take_step(asset, light, {begin, end, 0, out}, options, step);
                   });
    });
}

std::vector<Rgb> shade_for_picture(const formats::AssetView& asset, const PartLights& light,
                                   formats::Vec3 eye, TermSet terms, unsigned threads,
                                   const EmitterLight& emitters) {
    ShadeOptions options;
    options.emitters = emitters;
    options.threads = threads;
    options.base_color = options.fresnel = false;
    options.eye = eye;
    options.terms = terms;
    std::vector<Rgb> out(asset.receivers());
    shade(asset, light, out, options);
    return out;
}

}  // namespace opaline::runtime
