#include "formats/opal/read_opal.h"

#include <zstd.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "formats/opal/check_opal.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/layout.h"
#include "formats/opal/section_arrays.h"
#include "formats/opal/sheet_shares.h"
#include "formats/opal/slots_file.h"

namespace opaline::formats {
namespace {

bool read_basis(SectionCursor cursor, AssetView& view) {
    BasisHead head;
    if (!cursor.take_one(head) || head.kind != 1 ||
        head.pairing != static_cast<std::uint32_t>(Pairing::light_carries_solid_angle)) {
        return false;
    }
    view.cubemap_size = head.cubemap_size;
    view.pairing = Pairing::light_carries_solid_angle;
    return true;
}

bool read_primitives(SectionCursor cursor, AssetView& view) {
    PrimitivesHead head;
    return cursor.take_one(head) && head.record_size == sizeof(PrimitiveRecord) &&
           cursor.take(head.count, view.primitives) && cursor.at_end();
}

// The codes, until restore_slots.
bool read_slots(SectionCursor cursor, AssetView& view) {
    SlotsHead head;
    return cursor.take_one(head) && cursor.take(head.vertices, view.slots.slot) && cursor.at_end();
}

// As they stand in the file, until restore_slots.
bool read_mixes(SectionCursor cursor, AssetView& view) {
    MixesHead head;
    return cursor.take_one(head) && cursor.take(head.places, view.slots.mix) && cursor.at_end();
}

// Primitives without vertices, until restore_copies.
bool read_copies(SectionCursor cursor, AssetView& view) {
    CopiesHead head;
    return cursor.take_one(head) && head.record_size == sizeof(CopyRecord) &&
           cursor.take(head.count, view.copies) && cursor.at_end();
}

bool read_mesh(SectionCursor cursor, AssetView& view) {
    MeshHead head;
    if (!cursor.take_one(head)) return false;
    const std::uint32_t places = head.slots == 0 ? head.vertices : head.slots;
    return cursor.take(places, view.position) && cursor.take(places, view.normal) &&
           cursor.take(head.vertices, view.base_color) &&
           cursor.take(head.texcoords, view.texcoord) && cursor.take(head.indices, view.index) &&
           cursor.at_end();
}

bool read_images(SectionCursor cursor, AssetView& view) {
    ImagesHead head;
    std::span<const ImageSize> sizes;
    if (!cursor.take_one(head) || !cursor.take(head.count, sizes)) return false;
    for (const ImageSize size : sizes) {
        PreviewImage image{size.width, size.height, {}};
        // Below 2^16 a side the product of three cannot overflow 64 bits.
        if (size.width == 0 || size.height == 0 || size.width > 65535 || size.height > 65535 ||
            !cursor.take(std::uint64_t{size.width} * size.height * 3, image.rgb)) {
            return false;
        }
        view.images.push_back(image);
    }
    return cursor.at_end();
}

bool read_specular(SectionCursor cursor, AssetView& view) {
    SpecularHead head;
    return cursor.take_one(head) && cursor.take(head.primitives, view.roughness) &&
           cursor.take(head.vertices, view.openness) && cursor.at_end();
}

bool read_gloss(SectionCursor cursor, AssetView& view) {
    GlossHead head;
    return cursor.take_one(head) && head.record_size == sizeof(GlossRecord) &&
           cursor.take(head.primitives, view.gloss) && cursor.at_end();
}

bool read_holes(SectionCursor cursor, AssetView& view) {
    HolesHead head;
    return cursor.take_one(head) && head.record_size == sizeof(HoleRecord) &&
           cursor.take(head.count, view.holes.record) &&
           cursor.take(head.vertices, view.holes.vertex_alpha) && cursor.at_end();
}

bool read_normal_maps(SectionCursor cursor, AssetView& view) {
    NormalMapsHead head;
    return cursor.take_one(head) && head.record_size == sizeof(NormalMapRecord) &&
           cursor.take(head.count, view.normal_maps.record) &&
           cursor.take(head.vertices, view.normal_maps.tangent) && cursor.at_end();
}

bool read_added(SectionCursor cursor, AssetView& view) {
    AddedVerticesHead head;
    return cursor.take_one(head) && head.record_size == sizeof(AddedVertex) &&
           cursor.take(head.primitives, view.added.count) &&
           cursor.take(head.vertices, view.added.vertex) && cursor.at_end();
}

// A section that is read: how, its bit among those that must be there, and its versions.
struct KnownSection {
    std::uint32_t id;
    bool (*read)(SectionCursor, AssetView&);
    unsigned bit = 0;
    std::uint32_t earliest = 1, latest = 1;
};

// Reads a part of the view, to the end of the section.
template <auto kTake, class Part>
constexpr auto read_part(Part) {
    return [](SectionCursor cursor, AssetView& view) {
        return kTake(cursor, Part()(view)) && cursor.at_end();
    };
}

constexpr KnownSection kKnownSections[] = {
    {kBasiSection, read_basis, 1},
    {kPrimSection, read_primitives, 2, 1, kCopiesVersion},
    {kTranSection, read_part<take_rows>([](AssetView& v) -> auto& { return v.transport; }), 4,
     kTransportVersion, kTransportVersion},
    {kSharSection, read_slots},
    {kMixrSection, read_mixes},
    {kCopySection, read_copies},
    {kMeshSection, read_mesh, 8, 1, kSlotsMeshVersion},
    {kRefiSection, read_added},
    {kImagSection, read_images},
    {kSpecSection, read_specular, 0, 1, kSlotsSpecularVersion},
    {kGlosSection, read_gloss},
    {kHoleSection, read_holes, 0, 1, kClearHolesVersion},
    {kNormSection, read_normal_maps, 0, 1, kMappedSheetVersion},
    {kVoluSection, read_part<take_volumes>([](AssetView& v) -> auto& { return v.volumes; })},
    {kClouSection, read_part<take_clouds>([](AssetView& v) -> auto& { return v.clouds; })},
    {kEmitSection, read_part<take_emitters>([](AssetView& v) -> auto& { return v.emitters; })},
    {kGlowSection, read_part<take_glow>([](AssetView& v) -> auto& { return v.volumes.glow; })},
    {kProvSection, [](SectionCursor, AssetView&) { return true; }}};

bool has_section(std::span<const SectionEntry> sections, std::uint32_t id) {
    return std::ranges::find(sections, id, &SectionEntry::id) != sections.end();
}

// A section that is stored as beside SHAR, MIXR or COPY without it, or the other way round; empty
// where none is.
std::string find_slots_misfit(std::span<const SectionEntry> sections) {
    const bool has_slots = has_section(sections, kSharSection);
    const bool has_mixes = has_section(sections, kMixrSection);
    const bool has_copies = has_section(sections, kCopySection);
    if (has_mixes && !has_slots) return "section MIXR";
    for (const SectionEntry& entry : sections) {
        if (entry.id == kPrimSection) {
            const std::uint32_t version = has_copies  ? kCopiesVersion
                                          : has_mixes ? kMixedVersion
                                          : has_slots ? kSlotsVersion
                                                      : 0;
            const bool is_right =
                version != 0 ? entry.version == version : entry.version < kSlotsVersion;
            if (!is_right) return "section PRIM";
        }
        const std::uint32_t own = entry.id == kMeshSection   ? kSlotsMeshVersion
                                  : entry.id == kSpecSection ? kSlotsSpecularVersion
                                                             : 0;
        if (own != 0 && (entry.version == own) != has_slots) {
            return "section " + section_name(entry.id);
        }
    }
    return {};
}

}  // namespace

DecodedBytes::DecodedBytes(const Memory& memory, std::size_t size) : memory_(memory), size_(size) {
    data_ = static_cast<std::byte*>(
        memory.allocate != nullptr
            ? memory.allocate(memory.user, size, kSectionAlignment)
            : ::operator new (size, std::align_val_t{kSectionAlignment}, std::nothrow));
}

DecodedBytes::DecodedBytes(DecodedBytes&& other) noexcept
    : memory_(other.memory_), data_(std::exchange(other.data_, nullptr)), size_(other.size_) {}

DecodedBytes::~DecodedBytes() {
    if (data_ == nullptr) return;
    if (memory_.allocate != nullptr) {
        memory_.release(memory_.user, data_, size_, kSectionAlignment);
    } else {
        ::operator delete (data_, std::align_val_t{kSectionAlignment});
    }
}

Result<LoadedAsset> read_opal(std::span<const std::byte> bytes, const std::string& file,
                              Checks checks, const Memory& memory) {
    Result<std::vector<SectionEntry>> table = read_section_table(bytes, file);
    if (!table) return std::move(table).error();
    const auto damaged = [&](std::string where, std::string fault) {
        return make_error(ErrorKind::bad_input, file, std::move(where), std::move(fault),
                          "the file is damaged: bake it again, or copy it again");
    };
    const auto no_memory = [&](std::string where, std::uint64_t size) {
        return make_error(ErrorKind::resource, file, std::move(where),
                          "no memory for " + std::to_string(size) + " bytes", "free some memory");
    };
    LoadedAsset loaded;
    loaded.sections = std::move(*table);
    unsigned found = 0;
    for (const SectionEntry& entry : loaded.sections) {
        const std::string where = "section " + section_name(entry.id);
        std::span<const std::byte> content = bytes.subspan(
            static_cast<std::size_t>(entry.offset), static_cast<std::size_t>(entry.stored_size));
        if (checks == Checks::full && checksum(content) != entry.checksum) {
            return damaged(where, "its checksum does not match");
        }
        const KnownSection* const known =
            std::ranges::find(kKnownSections, entry.id, &KnownSection::id);
        if (known == std::end(kKnownSections)) {
            continue;  // of a later minor version, or somebody else's
        }
        if (entry.version > 0 && entry.version < known->earliest) {
            return make_error(
                ErrorKind::bad_input, file, where,
                "version " + std::to_string(entry.version) + " is of an earlier Opaline",
                "bake it again");
        }
        if (entry.version == 0 || entry.version > known->latest) {
            return make_error(ErrorKind::newer_file, file, where,
                              "version " + std::to_string(entry.version) + " is unknown",
                              "update Opaline");
        }
        if (entry.codec == static_cast<std::uint32_t>(Codec::zstd)) {
            if (entry.size / kMaxCompressionRatio > entry.stored_size ||
                ZSTD_getFrameContentSize(content.data(), content.size()) != entry.size) {
                return damaged(where, "its decoded size is not the one in the section table");
            }
            DecodedBytes decoded(memory, static_cast<std::size_t>(entry.size));
            if (decoded.empty()) {
                return no_memory(where, entry.size);
            }
            const std::size_t size =
                ZSTD_decompress(decoded.data(), static_cast<std::size_t>(entry.size),
                                content.data(), content.size());
            if (size != entry.size) return damaged(where, "its compressed data cannot be decoded");
            content = {decoded.data(), static_cast<std::size_t>(entry.size)};
            loaded.decoded.push_back(std::move(decoded));
        } else if (entry.codec != 0 || entry.size != entry.stored_size) {
            return damaged(where, "unknown codec, or sizes that disagree");
        }
        if (entry.id == kProvSection) {
            loaded.view.provenance = {reinterpret_cast<const char*>(content.data()),
                                      content.size()};
        } else if (!known->read(SectionCursor(content), loaded.view)) {
            return damaged(where, "its counts do not agree with its size");
        }
        found |= known->bit;
    }
    if (found != 15) return damaged("section table", "BASI, PRIM, TRAN and MESH must all be there");
    const std::string misfit = find_slots_misfit(loaded.sections);
    if (!misfit.empty()) {
        return damaged(misfit, "its version and a section SHAR, MIXR or COPY do not go together");
    }
    if (has_section(loaded.sections, kMixrSection) && loaded.view.slots.mix.empty()) {
        return damaged("section MIXR", "it has no places");
    }
    if (has_section(loaded.sections, kSharSection)) {
        DecodedBytes restored(memory, restored_size(loaded.view));
        if (restored.empty()) return no_memory("section SHAR", restored_size(loaded.view));
        if (const Fault fault =
                restore_slots(loaded.view, {restored.data(), restored_size(loaded.view)});
            !is_sound(fault)) {
            return damaged(fault.where, fault.what);
        }
        loaded.decoded.push_back(std::move(restored));
    }
    if (!loaded.view.copies.empty()) {
        if (const Fault fault = find_copies_fault(loaded.view, bytes.size()); !is_sound(fault)) {
            return damaged(fault.where, fault.what);
        }
        const std::size_t size = size_with_copies(loaded.view);
        DecodedBytes restored(memory, size);
        if (restored.empty()) return no_memory("section COPY", size);
        restore_copies(loaded.view, {restored.data(), size});
        loaded.decoded.push_back(std::move(restored));
    }
    loaded.view.transport.cubemap_size = loaded.view.cubemap_size;
    loaded.view.volumes.rows.cubemap_size = loaded.view.cubemap_size;
    if (checks == Checks::sizes) {
        if (!is_valid_cubemap_size(loaded.view.cubemap_size)) {
            return damaged("section BASI", "its cube map size is not a power of two in 8 ... 128");
        }
    } else if (const Fault fault = find_structure_fault(loaded.view); !fault.what.empty()) {
        return damaged(fault.where, fault.what);
    }
    if (checks == Checks::full) {
        if (const Fault fault = find_value_fault(loaded.view); !fault.what.empty()) {
            return damaged(fault.where, fault.what);
        }
    }
    return loaded;
}

}  // namespace opaline::formats
