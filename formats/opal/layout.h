#pragma once

#include <cstddef>
#include <cstdint>

namespace opaline::formats {

/// The fixed heads of the sections, shared by reader and writer (formats/README.md).

inline constexpr std::size_t kArrayAlignment = 16;  ///< every array of a section is padded to this

struct BasisHead {
    std::uint32_t kind = 1;  ///< 1: orthonormal Haar per face (haar.h)
    std::uint32_t cubemap_size = 0;
    std::uint32_t pairing = 0;
    std::uint32_t reserved = 0;
};
static_assert(sizeof(BasisHead) == 16);

/// Section version of PRIM where a translucent primitive has one band, which readers that knew only
/// three refuse by name; 1 where none has.
inline constexpr std::uint32_t kGreyMediaVersion = 2;

/// Section version of PRIM where a primitive has the flag kSingleOnly: earlier readers would take
/// its rows for multiple and single scattering together.
inline constexpr std::uint32_t kSingleOnlyVersion = 3;

/// Section version of PRIM where a primitive has Shading::sheet, which earlier readers do not know.
inline constexpr std::uint32_t kSheetVersion = 4;

/// Section version of PRIM beside SHAR: earlier readers would take rows of slots for rows of
/// vertices.
inline constexpr std::uint32_t kSlotsVersion = 5;
/// Section versions of MESH and SPEC there: positions, normals and openness are those of slots, and
/// indices differences (slots_file.h).
inline constexpr std::uint32_t kSlotsMeshVersion = 2, kSlotsSpecularVersion = 2;

/// Section version of TRAN: 8-bit detail codes stand for their squares (detail_codes.h). Files of
/// version 1, where they stood for themselves, are refused.
inline constexpr std::uint32_t kTransportVersion = 2;

/// Section version of PRIM beside MIXR: earlier readers would take rows of slots for rows of
/// places.
inline constexpr std::uint32_t kMixedVersion = 6;

/// Section version of PRIM beside COPY: earlier readers would find no vertices in copies.
inline constexpr std::uint32_t kCopiesVersion = 7;

struct PrimitivesHead {
    std::uint32_t count = 0, record_size = 0;
    std::uint64_t reserved = 0;
};
static_assert(sizeof(PrimitivesHead) == 16);

struct SlotsHead {
    std::uint32_t vertices = 0, reserved[3] = {};
};
static_assert(sizeof(SlotsHead) == 16);

struct MixesHead {
    std::uint32_t places = 0, reserved[3] = {};
};
static_assert(sizeof(MixesHead) == 16);

struct CopiesHead {
    std::uint32_t count = 0, record_size = 0, reserved[2] = {};
};
static_assert(sizeof(CopiesHead) == 16);

struct MeshHead {
    std::uint32_t vertices = 0, indices = 0, texcoords = 0;
    std::uint32_t slots = 0;  ///< kSlotsMeshVersion: as many positions and normals
};
static_assert(sizeof(MeshHead) == 16);

struct ImagesHead {
    std::uint32_t count = 0, reserved[3] = {};
};
static_assert(sizeof(ImagesHead) == 16);

struct ImageSize {
    std::uint32_t width = 0, height = 0;
};

struct SpecularHead {
    std::uint32_t primitives = 0, vertices = 0, reserved[2] = {};
};
static_assert(sizeof(SpecularHead) == 16);

struct GlossHead {
    std::uint32_t primitives = 0, record_size = 0, reserved[2] = {};
};
static_assert(sizeof(GlossHead) == 16);

struct HolesHead {
    std::uint32_t count = 0, record_size = 0, vertices = 0, reserved = 0;
};
static_assert(sizeof(HolesHead) == 16);

struct AddedVerticesHead {
    std::uint32_t primitives = 0, record_size = 0, vertices = 0, reserved = 0;
};
static_assert(sizeof(AddedVerticesHead) == 16);

struct NormalMapsHead {
    std::uint32_t count = 0, record_size = 0, vertices = 0, reserved = 0;
};
static_assert(sizeof(NormalMapsHead) == 16);

struct TransportHead {
    std::uint32_t rows = 0, code_bits = 0, index_bytes = 0, reserved = 0;
    std::uint64_t band_rows = 0, details = 0, codes = 0, reserved_wide = 0;
};
static_assert(sizeof(TransportHead) == 48);

/// Density codes: kBrickVoxels a brick.
struct VolumesHead {
    std::uint32_t count = 0, record_size = 0;
    std::uint64_t cells = 0, bricks = 0, corners = 0, nodes = 0, reserved = 0;
};
static_assert(sizeof(VolumesHead) == 48);

struct CloudsHead {
    std::uint32_t count = 0, record_size = 0;
    std::uint64_t thickness = 0, ground = 0, values = 0, reserved[2] = {};
};
static_assert(sizeof(CloudsHead) == 48);

struct EmittersHead {
    std::uint32_t count = 0, text = 0, own = 0, own_size = 0;
    std::uint64_t blocks = 0, values = 0;
    std::uint32_t block_size = 0, reserved[3] = {};
};
static_assert(sizeof(EmittersHead) == 48);

struct GlowHead {
    std::uint32_t count = 0, record_size = 0;
    std::uint64_t bricks = 0, values = 0, reserved[3] = {};
};
static_assert(sizeof(GlowHead) == 48);

/// Largest ratio of decoded to stored size that a reader accepts and a writer makes: bounds what a
/// hostile file can make a reader allocate.
inline constexpr std::uint64_t kMaxCompressionRatio = 1024;

}  // namespace opaline::formats
