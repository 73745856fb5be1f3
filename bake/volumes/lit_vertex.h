#pragma once

#include <cstdint>
#include <span>

#include "bake/receivers/receiver.h"
#include "bake/volumes/sent_light.h"
#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What volumes scatter to both sides of a vertex; `back` is that of a sheet, otherwise empty.
struct LitVertex {
    SentIrradiance front, back;

    std::uint64_t rays() const { return front.rays + back.rays; }
};

/// `set`: with a receiver for each vertex; `shading` that of its primitive.
LitVertex light_vertex(const SentLight& light, const ReceiverSet& set, std::size_t vertex,
                       formats::Shading shading);

/// Response of a row to the irradiance on either side of its vertex: radiance per irradiance.
struct LitRow {
    float front = 0, back = 0;
};

/// Of term `term` of a sheet's or an opaque surface's vertex in one of `bands` bands.
LitRow answer_of_surface(const formats::Material& material, std::uint32_t term, std::uint32_t band,
                         std::uint32_t bands);

/// Of a medium: the row's response to an even sky per irradiance; `texels` are the row's values
/// before volumes dim them, `solid_angles` those of a face of their cube map.
LitRow answer_of_medium(std::span<const float> texels, std::span<const double> solid_angles,
                        float open);

/// Adds that to the texel values of one band of a row, 6 n n.
void add_sent_light(const SentLight& light, const LitVertex& lit, const LitRow& answer,
                    std::uint32_t band, std::uint32_t n, std::span<float> texels);

}  // namespace opaline::bake
