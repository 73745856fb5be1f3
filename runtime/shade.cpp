#include "runtime/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/parallel.h"
#include "runtime/texture.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Truncated rows ring below zero where the truth is black; sums of absurd scales overflow. The
// comparison is false for NaN, which becomes black.
float displayable(float x) {
    return x > 0.0f ? std::min(x, std::numeric_limits<float>::max()) : 0.0f;
}

// Rows per block: their colours stay in the nearest cache between the dot product and the colour.
constexpr std::uint32_t kBlock = 512;

void shade_block(const formats::AssetView& asset, const formats::PrimitiveRecord& primitive,
                 const LightVector& light, std::uint32_t first_vertex, std::span<Rgb> out,
                 const ShadeOptions& options) {
    if ((options.terms & kDiffuseTerm) == 0) return;  // out is black
    dot_rows(asset.transport, primitive.rows(), light, first_vertex - primitive.first_vertex, out,
             options.path);
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        Rgb radiance = out[i];
        if (options.base_color) {
            radiance = radiance * vertex_base_color(asset, primitive, first_vertex + i);
        }
        out[i] = {displayable(radiance.r), displayable(radiance.g), displayable(radiance.b)};
    }
}

// What is still to be multiplied keeps its sign.
float finite(float x) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::isnan(x) ? 0.0f : std::clamp(x, -kLargest, kLargest);
}

Rgb shade_translucent(const formats::AssetView& asset, const formats::PrimitiveRecord& primitive,
                      std::uint32_t vertex, std::span<const Rgb> product, const SpecularLobe& lobe,
                      const ShadeOptions& options) {
    const ViewOfReceiver view =
        view_receiver(primitive, asset.position[vertex], asset.normal[vertex], options.eye);
    Rgb radiance = sum_view_terms(view, primitive, product, options.terms);
    if (options.base_color) {
        radiance = radiance * vertex_base_color(asset, primitive, vertex);
    }
    if (!options.fresnel) {
        return {finite(radiance.r), finite(radiance.g), finite(radiance.b)};
    }
    radiance = fresnel_transmittance(view.cosine, primitive.eta) * radiance;
    radiance = {displayable(radiance.r), displayable(radiance.g), displayable(radiance.b)};
    if (lobe.radiance != nullptr) {
        const formats::Openness openness = asset.openness[vertex];
        radiance = radiance + eval_specular(*options.specular, lobe, view, primitive.eta,
                                            formats::open_axis(openness),
                                            formats::open_fraction(openness));
    }
    return {displayable(radiance.r), displayable(radiance.g), displayable(radiance.b)};
}

bool wants_specular(const ShadeOptions& options) {
    return options.specular != nullptr && options.fresnel && (options.terms & kSpecularTerm) != 0;
}

// The same for rows of several terms: as many vertices at a time as fill a block.
void shade_translucent_block(const formats::AssetView& asset,
                             const formats::PrimitiveRecord& primitive, const LightVector& light,
                             std::uint32_t first_vertex, std::span<Rgb> out,
                             const ShadeOptions& options) {
    static_assert(kBlock > formats::kMaxHarmonics);
    const auto number = static_cast<std::size_t>(&primitive - asset.primitives.data());
    const SpecularLobe lobe =
        wants_specular(options) ? specular_lobe(*options.specular, asset, number) : SpecularLobe{};
    std::array<Rgb, kBlock> products;
    const std::uint32_t terms = primitive.terms, step = kBlock / terms;
    for (std::uint32_t done = 0; done < out.size(); done += step) {
        const std::uint32_t count = std::min(step, static_cast<std::uint32_t>(out.size()) - done);
        const std::span<Rgb> block = std::span<Rgb>(products).first(std::size_t{count} * terms);
        dot_rows(asset.transport, primitive.rows(), light,
                 (first_vertex + done - primitive.first_vertex) * terms, block, options.path);
        for (std::uint32_t i = 0; i < count; ++i) {
            out[done + i] =
                shade_translucent(asset, primitive, first_vertex + done + i,
                                  block.subspan(std::size_t{i} * terms, terms), lobe, options);
        }
    }
}

}  // namespace

void shade_range(const formats::AssetView& asset, const LightVector& light, std::uint32_t first,
                 std::span<Rgb> out, const ShadeOptions& options) {
    std::fill(out.begin(), out.end(), Rgb{});
    const std::uint64_t last = first + std::uint64_t{out.size()};
    for (const formats::PrimitiveRecord& primitive : asset.primitives) {
        const std::uint64_t end =
            std::min(last, std::uint64_t{primitive.first_vertex} + primitive.vertex_count);
        for (std::uint64_t v = std::max(first, primitive.first_vertex); v < end; v += kBlock) {
            const std::size_t count = std::min<std::uint64_t>(kBlock, end - v);
            (primitive.shading == formats::Shading::translucent
                 ? shade_translucent_block
                 : shade_block)(asset, primitive, light, static_cast<std::uint32_t>(v),
                                out.subspan(v - first, count), options);
        }
    }
}

void shade(const formats::AssetView& asset, const LightVector& light, std::span<Rgb> out,
           const ShadeOptions& options) {
    constexpr std::uint32_t kGrain = 2048;  // some microseconds of work for each claim of a range
    for_ranges(asset.receivers(), kGrain, options.threads,
               [&](std::uint32_t begin, std::uint32_t end) {
                   shade_range(asset, light, begin, out.subspan(begin, end - begin), options);
               });
}

std::vector<Rgb> shade_for_picture(const formats::AssetView& asset, const LightVector& light,
                                   formats::Vec3 eye, std::uint32_t terms, unsigned threads) {
    ShadeOptions options;
    options.threads = threads;
    options.base_color = options.fresnel = false;
    options.eye = eye;
    options.terms = terms;
    std::vector<Rgb> out(asset.receivers());
    shade(asset, light, out, options);
    return out;
}

}  // namespace opaline::runtime
