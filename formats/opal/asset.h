#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/added_vertices.h"
#include "formats/opal/clouds.h"
#include "formats/opal/copies.h"
#include "formats/opal/emitters.h"
#include "formats/opal/gloss_model.h"
#include "formats/opal/holes.h"
#include "formats/opal/normal_maps.h"
#include "formats/opal/openness.h"
#include "formats/opal/preview_image.h"
#include "formats/opal/rgb.h"
#include "formats/opal/slots.h"
#include "formats/opal/sparse_rows.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"

namespace opaline::formats {

/// What an `.opal` file holds; formats/README.md specifies the bytes.

inline constexpr std::uint32_t kOpalVersion = 1;

/// The side of <T, L> that carries the solid angle (formats/README.md, "Pairing"). Only A is
/// defined.
enum class Pairing : std::uint32_t { light_carries_solid_angle = 1 };

/// Relative indices of refraction of a translucent primitive; outside them the exact hemispherical
/// moments and the fits that bakers use lose their digits (bake/physics/README.md, "Fresnel").
inline constexpr float kMinEta = 1.0f / 3.0f, kMaxEta = 3.0f;

/// What row values mean and how a receiver is shaded from them.
enum class Shading : std::uint32_t {
    /// L_o = base_color * <T_0, L>; T_0 = V max(0, n.w) / pi, one term, grey or RGB. With gloss
    /// (GlossRecord) the diffuse part shrinks and a specular part is added: gloss_model.h.
    diffuse = 1,
    /// L_o = base_color * Ft(eta, n.w_o) * sum_k h_k(w_o') <T_k, L> (formats/README.md,
    /// "Translucent shading"), with w_o' the direction to the eye refracted into the medium and h_k
    /// = Y_lm(w_o'), the real orthonormal spherical harmonics, k = l (l + 1) + m; terms = 1, 4, 9,
    /// 16 or 25. With one term h_0 = 1, so T_0 carries the factor. Grey or RGB. Separate
    /// (PrimitiveRecord::kSeparate): row 0 is multiple scattering by itself, with h = 1; the other
    /// terms - 1, none or any of the numbers above, are single scattering with the h_k of that
    /// number.
    translucent = 2,
    /// A thin-walled surface, seen from either side: L_o = base_color * <T_0, L> where the eye is
    /// in
    /// front, n.w_o >= 0, and base_color * <T_1, L> where it is behind. T_0 = V (r max(0, n.w) +
    /// t max(0, -n.w)) / pi, T_1 the same with r and t exchanged: r and t are the shares reflected
    /// and transmitted. Two terms, grey or RGB. Gloss as with `diffuse`.
    sheet = 3,
};

/// One glTF primitive of one node instance. Receivers and vertices are the same thing: row
/// s * terms + k is T_k of a vertex with slot s of the primitive (AssetView::slot_of), which is
/// v - first_vertex where no vertices share rows; a mixed vertex (SlotsView::mix) has no row of its
/// own. Fixed size, stored as is.
struct PrimitiveRecord {
    std::uint32_t node = 0, mesh = 0, primitive = 0, material = 0;  ///< indices in the source file
    std::uint32_t first_vertex = 0, vertex_count = 0;
    std::uint32_t first_index = 0, index_count = 0;  ///< triangles; indices count from first_vertex
    std::uint32_t terms = 1;                         ///< K, rows per receiver
    std::uint32_t bands = 1;                         ///< 1 grey, 3 RGB
    std::uint32_t first_row = 0, first_band_row = 0;
    std::uint64_t first_code = 0;
    Shading shading = Shading::diffuse;
    std::uint32_t base_color_image = kNoImage;  ///< index into images
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    std::uint32_t flags = 0;  ///< kDoubleSided, kSeparate, kSingleOnly
    float eta = 0;            ///< translucent: index of refraction in [1/3, 3]; else 0

    static constexpr std::uint32_t kDoubleSided = 1;
    static constexpr std::uint32_t kSeparate = 2;  ///< translucent: multiple scattering in row 0
    /// Translucent, not separate: its rows hold single scattering alone.
    static constexpr std::uint32_t kSingleOnly = 4;

    /// Whether pictures show it from behind: as glTF says of double-sided surfaces, and bodies of
    /// a medium.
    bool shows_back() const { return shading != Shading::diffuse || (flags & kDoubleSided) != 0; }
    bool is_opaque() const { return shading != Shading::translucent; }
    bool is_separate() const { return (flags & kSeparate) != 0; }
    bool is_single_only() const { return (flags & kSingleOnly) != 0; }

    /// Of so many slots, or vertices where they share none.
    RowRange rows(std::uint32_t slots) const {
        return {first_row, slots * terms, bands, first_band_row, first_code};
    }
};
static_assert(sizeof(PrimitiveRecord) == 80);

struct Float2 {
    float x = 0, y = 0;
};

/// The whole asset as spans, into the bytes of a file or into an `Asset`. Immutable.
struct AssetView {
    std::string_view provenance;  ///< JSON text, for people and tools
    std::uint32_t cubemap_size = 0;
    Pairing pairing = Pairing::light_carries_solid_angle;
    std::span<const PrimitiveRecord> primitives;
    SparseRowsView transport;
    /// Primitives that have the rows of others; ascending. As a file is read these have vertices of
    /// their own as well; of an `Asset` and in its file they have none.
    std::span<const CopyRecord> copies;
    SlotsView slots;                   ///< which vertices share rows, or mix them; empty: none
    std::span<const Vec3> position;    ///< [m], world
    std::span<const Vec3> normal;      ///< unit
    std::span<const Rgb> base_color;   ///< factor times vertex colour; the image comes on top
    std::span<const Float2> texcoord;  ///< empty, or one per vertex
    std::span<const std::uint32_t> index;
    std::vector<PreviewImage> images;
    /// Specular reflection: both empty (none), or GGX roughness in [0, 1] per translucent primitive
    /// (kNotGlossy where it has none, and for opaque primitives), and openness per vertex.
    std::span<const float> roughness;
    std::span<const Openness> openness;
    /// Gloss of opaque primitives: empty (none), or one per primitive; needs `openness`.
    std::span<const GlossRecord> gloss;
    AddedVerticesView added;     ///< which vertices no scene file has
    HolesView holes;             ///< where opaque and thin-walled surfaces are not there
    NormalMapsView normal_maps;  ///< empty without any
    VolumesView volumes;         ///< smoke, clouds; empty without any
    CloudsView clouds;           ///< cloud layers; empty without any
    EmittersView emitters;       ///< light that is not the environment's; empty without any

    std::uint32_t receivers() const { return static_cast<std::uint32_t>(position.size()); }
    std::uint32_t slot_count(std::size_t primitive) const {
        return slots.empty() ? primitives[primitive].vertex_count : slots.count(primitive);
    }
    RowRange rows_of(std::size_t primitive) const {
        return primitives[primitive].rows(slot_count(primitive));
    }
    /// Slot of a vertex of that primitive, counted from the primitive's first one.
    std::uint32_t slot_of(std::size_t primitive, std::uint32_t vertex) const {
        return slots.empty() ? vertex - primitives[primitive].first_vertex
                             : slots.slot[vertex] - slots.offset[primitive];
    }
    /// The first vertex that has a slot of that primitive.
    std::uint32_t vertex_of(std::size_t primitive, std::uint32_t slot) const {
        return slots.empty() ? primitives[primitive].first_vertex + slot
                             : slots.vertex[slots.offset[primitive] + slot];
    }
};

/// The primitive that a receiver belongs to. Precondition: receiver < asset.receivers().
const PrimitiveRecord& primitive_of(const AssetView& asset, std::uint32_t receiver);

/// Owning twin of `AssetView`: what the baker builds.
struct Asset {
    std::string provenance;
    std::vector<PrimitiveRecord> primitives;
    SparseRows transport;
    std::vector<CopyRecord> copies;  ///< of primitives without vertices
    Slots slots;                     ///< empty: no vertices share rows, and none are mixed
    std::vector<Vec3> position, normal;
    std::vector<Rgb> base_color;
    std::vector<Float2> texcoord;
    std::vector<std::uint32_t> index;
    std::vector<PreviewImageData> images;
    std::vector<float> roughness;    ///< empty, or one per primitive; kNotGlossy for opaque ones
    std::vector<Openness> openness;  ///< empty, or one per vertex; where `roughness` is not empty
    std::vector<GlossRecord> gloss;  ///< empty, or one per primitive; kNotGlossy if translucent
    AddedVertices added;             ///< empty without any
    Holes holes;                     ///< empty without any
    NormalMaps normal_maps;          ///< empty without any
    Volumes volumes;                 ///< empty without any
    Clouds clouds;                   ///< empty without any
    Emitters emitters;               ///< empty without any

    AssetView view() const;
};

}  // namespace opaline::formats
