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
    dot_rows(job.asset.transport, job.primitive().rows(), job.light, first_row, out,
             job.options.path);
    add_emitters(job.asset.emitters, job.options.emitters, job.number, first_row, out);
}

// <T_0, L> of each vertex; <T_1, L> of a thin-walled surface that is seen from behind.
void dot_opaque_block(const Job& job, std::uint32_t first_vertex, std::span<Rgb> out) {
    const formats::PrimitiveRecord& primitive = job.primitive();
    const std::uint32_t first = first_vertex - primitive.first_vertex;
    if (primitive.shading == formats::Shading::diffuse) {
        dot_and_emit(job, first, out);
        return;
    }
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t vertex = first_vertex + i;
        const bool behind = is_seen_from_behind(job.asset.position[vertex],
                                                job.asset.normal[vertex], job.options.eye);
        dot_and_emit(job, 2 * (first + i) + (behind ? 1 : 0), out.subspan(i, 1));
    }
}

void shade_opaque_block(const Job& job, std::uint32_t first_vertex, std::span<Rgb> out) {
    const bool is_glossy = job.material.gloss != nullptr && job.options.fresnel;
    if (has_any(job.options.terms, TermSet::diffuse)) {
        dot_opaque_block(job, first_vertex, out);
    } else if (!is_glossy && job.material.own == nullptr) {
        return;  // out is black
    }
    if (!is_glossy && job.material.own == nullptr) {
        // As shade_surface() does it, without its cost: the rows take no longer than that.
        for (std::uint32_t i = 0; i < out.size(); ++i) {
            out[i] = displayable(out[i] * base_color_of(job, first_vertex + i));
        }
        return;
    }
    SurfaceMaterial material = job.material;
    if (!is_glossy) material.gloss = nullptr;
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t vertex = first_vertex + i;
        SurfacePoint point;
        point.radiance = out[i];
        point.base_color = base_color_of(job, vertex);
        set_own_light(job.asset, material, texcoord_of(job, vertex), point);
        if (is_glossy) {
            point.view = view_of(job, vertex);
            set_gloss_factors(job.asset, material, texcoord_of(job, vertex), point);
            set_openness(job, vertex, point);
        }
        out[i] = shade_surface(material, point);
    }
}

Rgb shade_translucent(const Job& job, std::uint32_t vertex, std::span<const Rgb> product) {
    SurfacePoint point;
    point.view = view_of(job, vertex);
    point.radiance = sum_view_terms(point.view, job.primitive(), product, job.options.terms);
    point.base_color = base_color_of(job, vertex);
    if (!job.options.fresnel) {
        const Rgb radiance = point.radiance * point.base_color;
        return {finite(radiance.r), finite(radiance.g), finite(radiance.b)};
    }
    if (job.material.lobe.is_glossy) set_openness(job, vertex, point);
    set_own_light(job.asset, job.material, texcoord_of(job, vertex), point);
    return shade_surface(job.material, point);
}

// Rows of several terms: as many vertices at a time as fill a block.
void shade_translucent_block(const Job& job, std::uint32_t first_vertex, std::span<Rgb> out) {
    static_assert(kBlock > formats::kMaxHarmonics);
    std::array<Rgb, kBlock> products;
    const std::uint32_t terms = job.primitive().terms, step = kBlock / terms;
    for (std::uint32_t done = 0; done < out.size(); done += step) {
        const std::uint32_t count = std::min(step, static_cast<std::uint32_t>(out.size()) - done);
        const std::span<Rgb> block = std::span<Rgb>(products).first(std::size_t{count} * terms);
        dot_and_emit(job, (first_vertex + done - job.primitive().first_vertex) * terms, block);
        for (std::uint32_t i = 0; i < count; ++i) {
            out[done + i] = shade_translucent(job, first_vertex + done + i,
                                              block.subspan(std::size_t{i} * terms, terms));
        }
    }
}

// What of emitters is shaded with the surface itself: renderers add their own light per pixel.
EmitterLight own_lights(const ShadeOptions& options) {
    return options.base_color && options.fresnel ? options.emitters : dark_emitters();
}

}  // namespace

void shade_range(const formats::AssetView& asset, const PartLights& light, std::uint32_t first,
                 std::span<Rgb> out, const ShadeOptions& options) {
    std::fill(out.begin(), out.end(), Rgb{});
    const std::uint64_t last = first + std::uint64_t{out.size()};
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const std::uint64_t end =
            std::min(last, std::uint64_t{primitive.first_vertex} + primitive.vertex_count);
        if (first >= end) continue;
        const SpecularLight* const specular = options.fresnel ? options.specular : nullptr;
        const Job job{asset, light.light[light.number(p)], options, static_cast<std::uint32_t>(p),
                      surface_material(asset, p, options.terms, specular, own_lights(options))};
        for (std::uint64_t v = std::max(first, primitive.first_vertex); v < end; v += kBlock) {
            const std::size_t count = std::min<std::uint64_t>(kBlock, end - v);
            (primitive.shading == formats::Shading::translucent ? shade_translucent_block
                                                                : shade_opaque_block)(
                job, static_cast<std::uint32_t>(v), out.subspan(v - first, count));
        }
    }
}

void shade(const formats::AssetView& asset, const PartLights& light, std::span<Rgb> out,
           const ShadeOptions& options) {
    constexpr std::uint32_t kGrain = 2048;  // some microseconds of work for each claim of a range
    for_ranges(asset.receivers(), kGrain, options.threads,
               [&](std::uint32_t begin, std::uint32_t end) {
                   shade_range(asset, light, begin, out.subspan(begin, end - begin), options);
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
