#include "formats/opal/check_opal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/opal/asset.h"
#include "formats/opal/check_clouds.h"
#include "formats/opal/check_emitters.h"
#include "formats/opal/check_rows.h"
#include "formats/opal/check_volumes.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/fault.h"
#include "formats/opal/sheet_shares.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::formats {
namespace {

// Halves in 0 ... 1, and 0 where nothing is thin-walled.
bool are_shares_sound(const NormalMapRecord& map, bool is_sheet) {
    for (const std::uint32_t pair : map.reserved) {
        if ((pair & 0xffffu) > (is_sheet ? kHalfOfOne : 0u) ||
            (pair >> 16) > (is_sheet ? kHalfOfOne : 0u)) {
            return false;
        }
    }
    return true;
}

const char* find_map_fault(const AssetView& asset) {
    const NormalMapsView& maps = asset.normal_maps;
    if (!maps.empty() && maps.tangent.size() != asset.position.size()) {
        return "it does not have a tangent for each vertex";
    }
    std::uint64_t next = 0;
    for (const NormalMapRecord& map : maps.record) {
        if (map.primitive < next || map.primitive >= asset.primitives.size()) {
            return "a primitive does not exist, is out of order, or stands twice";
        }
        next = std::uint64_t{map.primitive} + 1;
        if (map.image >= asset.images.size() || asset.texcoord.empty()) {
            return "it uses an image or texture coordinates that are not there";
        }
        if (!is_known(map.wrap_u) || !is_known(map.wrap_v) ||
            !(std::abs(map.scale) <= kMostNormalScale) ||
            !are_shares_sound(map, asset.primitives[map.primitive].shading == Shading::sheet)) {
            return "a texture wrap mode, a scale or a value is not one of this version";
        }
    }
    return nullptr;
}

// What a reader of normal maps relies on without further checks: records of primitives and images
// that exist, in their order, none twice; tangents, which may have any value, of all vertices. No
// maps are fine.
// Precondition: primitives are sound.
Fault find_normal_maps_fault(const AssetView& asset) {
    const char* const fault = find_map_fault(asset);
    return fault == nullptr ? Fault{} : Fault{"section NORM", fault};
}

std::string primitive_name(std::size_t i) {
    return "section PRIM, primitive " + std::to_string(i);
}

bool has_possible_terms(const PrimitiveRecord& p) {
    return p.is_separate() ? p.terms == 1 || (p.terms > 1 && is_harmonic_count(p.terms - 1))
                           : is_harmonic_count(p.terms);
}

// Empty where all is well. `!(>=)` refuses NaN too.
std::string find_shading_fault(const PrimitiveRecord& p) {
    const auto number = [](auto value) { return std::to_string(value); };
    switch (p.shading) {
        case Shading::diffuse:
        case Shading::sheet: {
            const std::string kind =
                p.shading == Shading::sheet ? "thin-walled shading" : "diffuse shading";
            const std::uint32_t terms = p.shading == Shading::sheet ? 2 : 1;
            if (p.terms != terms || (p.bands != 1 && p.bands != 3) || p.eta != 0.0f) {
                return kind + " with " + number(p.terms) + " terms, " + number(p.bands) +
                       " bands and index of refraction " + number(p.eta) + "; expected " +
                       number(terms) + (terms == 1 ? " term" : " terms") +
                       ", 1 or 3 bands and index 0";
            }
            return p.is_separate() || p.is_single_only() ? kind + " with separate scattering"
                                                         : std::string();
        }
        case Shading::translucent:
            if (p.is_separate() && p.is_single_only()) {
                return "rows of single scattering alone with multiple scattering in a row of its "
                       "own";
            }
            if (!has_possible_terms(p) || (p.bands != 1 && p.bands != 3) || !(p.eta >= kMinEta) ||
                !(p.eta <= kMaxEta)) {
                return "translucent shading with " + number(p.terms) + " terms, " +
                       number(p.bands) + " bands and index of refraction " + number(p.eta) +
                       "; expected 1, 4, 9, 16 or 25 terms (with separate multiple scattering 1, "
                       "or one more than these), 1 or 3 bands and an index in 1/3 ... 3";
            }
            return {};
    }
    return "unknown shading " + number(static_cast<std::uint32_t>(p.shading));
}

Fault find_primitive_fault(const AssetView& asset, std::size_t i) {
    const PrimitiveRecord& p = asset.primitives[i];
    const SparseRowsView& rows = asset.transport;
    if (std::string fault = find_shading_fault(p); !fault.empty()) {
        return {primitive_name(i), std::move(fault)};
    }
    const std::uint64_t row_count = std::uint64_t{asset.slot_count(i)} * p.terms;
    if (!lies_inside(p.first_vertex, p.vertex_count, asset.position.size()) ||
        !lies_inside(p.first_index, p.index_count, asset.index.size()) || p.index_count % 3 != 0 ||
        !lies_inside(p.first_row, row_count, rows.rows()) ||
        !lies_inside(p.first_band_row, row_count * p.bands, rows.detail_scale.size())) {
        return {primitive_name(i), "its vertices, indices or rows lie outside their arrays"};
    }
    if (!lies_inside(p.first_code, codes_of_rows(rows, p.first_row, row_count, p.bands),
                     rows.code8.size() + rows.code16.size())) {
        return {primitive_name(i), "its codes lie outside their array"};
    }
    const auto triangles = asset.index.subspan(p.first_index, p.index_count);
    if (std::any_of(triangles.begin(), triangles.end(),
                    [&p](std::uint32_t v) { return v >= p.vertex_count; })) {
        return {primitive_name(i), "a triangle refers to a vertex it does not have"};
    }
    return {primitive_name(i), find_image_fault(asset, p.base_color_image, p.wrap_u, p.wrap_v)};
}

const char* find_vertex_fault(const PrimitiveRecord& p, std::uint32_t added,
                              std::span<const AddedVertex> vertices) {
    const std::uint32_t given = p.vertex_count - added;
    for (const AddedVertex& at : vertices) {
        if (std::ranges::any_of(at.corner, [&](std::uint32_t v) { return v >= given; })) {
            return "a vertex lies between vertices that the scene does not have";
        }
        if (!std::ranges::all_of(at.weights(), [](float w) { return w >= 0 && w <= 1; })) {
            return "a vertex's weights are not those of a point of a triangle";
        }
    }
    return nullptr;
}

Fault find_added_fault(const AssetView& asset) {
    const AddedVerticesView& added = asset.added;
    if (added.empty() && added.vertex.empty()) return {};
    if (added.count.size() != asset.primitives.size()) {
        return {"section REFI", "it does not have a number for each primitive"};
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < added.count.size(); ++i) {
        const std::uint32_t count = added.count[i];
        if (count > asset.primitives[i].vertex_count || count > added.vertex.size() - next) {
            return {"section REFI", "more vertices were added than there are"};
        }
        if (const char* fault =
                find_vertex_fault(asset.primitives[i], count, added.vertex.subspan(next, count))) {
            return {"section REFI, primitive " + std::to_string(i), fault};
        }
        next += count;
    }
    return next == added.vertex.size() ? Fault{}
                                       : Fault{"section REFI", "vertices belong to no primitive"};
}

// Roughness decides what a renderer allocates: part of the structure.
Fault find_specular_fault(const AssetView& asset) {
    if (asset.roughness.empty() && asset.openness.empty()) {
        return {};
    }
    if (asset.roughness.size() != asset.primitives.size() ||
        asset.openness.size() != asset.position.size()) {
        return {"section SPEC", "it has " + std::to_string(asset.roughness.size()) +
                                    " primitives and " + std::to_string(asset.openness.size()) +
                                    " vertices, not " + std::to_string(asset.primitives.size()) +
                                    " and " + std::to_string(asset.position.size())};
    }
    return find_fault_in("section SPEC, primitive", asset.roughness.size(), [&](std::size_t i) {
        const float roughness = asset.roughness[i];
        const bool is_possible =
            roughness == kNotGlossy || (asset.primitives[i].shading == Shading::translucent &&
                                        roughness >= 0.0f && roughness <= 1.0f);
        return is_possible ? std::string()
                           : "roughness " + std::to_string(roughness) +
                                 "; expected 0 ... 1, or -1 for none, as diffuse primitives must "
                                 "have";
    });
}

// Records decide which images are sampled: part of the structure.
std::string find_gloss_record_fault(const AssetView& asset, std::size_t i) {
    const GlossRecord& g = asset.gloss[i];
    const auto share = [](float x) { return x >= 0.0f && x <= 1.0f; };
    if (g.roughness == kNotGlossy) return {};
    if (!asset.primitives[i].is_opaque()) return "it is not opaque: its roughness must be -1";
    if (!share(g.roughness) || !share(g.metallic) || !share(g.f90) || !share(g.f0.r) ||
        !share(g.f0.g) || !share(g.f0.b)) {
        return "a roughness, metallic factor or reflectance is not in 0 ... 1";
    }
    return find_image_fault(asset, g.image, g.wrap_u, g.wrap_v);
}

Fault find_gloss_fault(const AssetView& asset) {
    if (asset.gloss.empty()) return {};
    if (asset.gloss.size() != asset.primitives.size() ||
        asset.openness.size() != asset.position.size()) {
        return {"section GLOS", "it has " + std::to_string(asset.gloss.size()) +
                                    " primitives, expected " +
                                    std::to_string(asset.primitives.size()) +
                                    " and a section SPEC with the openness of every vertex"};
    }
    return find_fault_in("section GLOS, primitive", asset.gloss.size(),
                         [&](std::size_t i) { return find_gloss_record_fault(asset, i); });
}

bool finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

std::string find_image_fault(const AssetView& asset, std::uint32_t image, Wrap wrap_u,
                             Wrap wrap_v) {
    if (image != kNoImage && (image >= asset.images.size() || asset.texcoord.empty())) {
        return "it uses an image or texture coordinates that are not there";
    }
    return is_known(wrap_u) && is_known(wrap_v) ? "" : "unknown texture wrap mode";
}

Fault find_structure_fault(const AssetView& asset) {
    if (!is_valid_cubemap_size(asset.cubemap_size)) {
        return {"section BASI", "cube map size " + std::to_string(asset.cubemap_size) +
                                    " is not a power of two in 8 ... 128"};
    }
    if (!asset.texcoord.empty() && asset.texcoord.size() != asset.position.size()) {
        return {"section MESH", "texture coordinates and positions differ in number"};
    }
    return find_first_fault(
        [&] { return find_rows_fault(asset.transport, "section TRAN"); },
        [&] { return find_specular_fault(asset); }, [&] { return find_gloss_fault(asset); },
        [&] {
            Fault fault;
            for (std::size_t i = 0; is_sound(fault) && i < asset.primitives.size(); ++i) {
                fault = find_primitive_fault(asset, i);
            }
            return fault;
        },
        [&] { return find_added_fault(asset); }, [&] { return find_holes_fault(asset); },
        [&] { return find_normal_maps_fault(asset); },
        [&] { return find_volumes_fault(asset.volumes); },
        [&] { return find_clouds_fault(asset.clouds); }, [&] { return find_emitters_fault(asset); },
        [&] { return find_glow_fault(asset); });
}

Fault find_value_fault(const AssetView& asset) {
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const auto where = [v] { return "section MESH, vertex " + std::to_string(v); };
        if (!finite(asset.position[v])) {
            return {where(), "its position is not finite"};
        }
        const float norm = length(asset.normal[v]);
        if (norm != 0.0f && !(std::abs(norm - 1.0f) < 1e-3f)) {
            return {where(), "its normal is neither of unit length nor zero"};
        }
        const Rgb c = asset.base_color[v];
        if (!(c.r >= 0 && c.g >= 0 && c.b >= 0 && std::isfinite(c.r + c.g + c.b))) {
            return {where(), "its base colour is below zero or not finite"};
        }
    }
    for (const Float2 uv : asset.texcoord) {
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
            return {"section MESH", "a texture coordinate is not finite"};
        }
    }
    return find_first_fault([&] { return find_row_value_fault(asset.transport, "section TRAN"); },
                            [&] { return find_hole_value_fault(asset.holes); },
                            [&] { return find_volume_value_fault(asset.volumes); },
                            [&] { return find_cloud_value_fault(asset.clouds); },
                            [&] { return find_emitter_value_fault(asset.emitters); },
                            [&] { return find_glow_value_fault(asset.volumes.glow); });
}

}  // namespace opaline::formats
