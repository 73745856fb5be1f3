#include "formats/opal/write_opal.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "formats/opal/layout.h"
#include "formats/opal/receiver_errors.h"
#include "formats/opal/section.h"
#include "formats/opal/section_arrays.h"
#include "formats/opal/sheet_shares.h"
#include "formats/opal/slots_file.h"

namespace opaline::formats {
namespace {

// Of PRIM: the earliest version that has all of it.
std::uint32_t version_of(const AssetView& asset) {
    const std::span<const PrimitiveRecord> primitives = asset.primitives;
    if (!asset.copies.empty()) return kCopiesVersion;
    if (!asset.slots.mix.empty()) return kMixedVersion;
    if (!asset.slots.empty()) return kSlotsVersion;
    const auto any = [&](auto has) {
        return std::any_of(primitives.begin(), primitives.end(), has);
    };
    if (any([](const PrimitiveRecord& p) { return p.shading == Shading::sheet; })) {
        return kSheetVersion;
    }
    if (any([](const PrimitiveRecord& p) { return p.is_single_only(); })) {
        return kSingleOnlyVersion;
    }
    return any([](const PrimitiveRecord& p) {
        return p.shading == Shading::translucent && p.bands == 1;
    })
               ? kGreyMediaVersion
               : 1;
}

// What is written before the arrays of an asset and is not part of it. Sections point into it.
struct SectionHeads {
    BasisHead basis;
    PrimitivesHead primitives;
    TransportHead transport;
    SlotsHead slots;
    MixesHead mixes;
    CopiesHead copies;
    StoredSlots of_slots;  // empty where no vertices share rows
    MeshHead mesh;
    ImagesHead images;
    std::vector<ImageSize> image_sizes;
    SpecularHead specular;
    GlossHead gloss;
    HolesHead holes;
    AddedVerticesHead added;
    NormalMapsHead normal_maps;
    VolumesHead volumes;
    TransportHead volume_rows;
    CloudsHead clouds;
    EmittersHead emitters;
    GlowHead glow;
    ReceiverErrorsHead receiver_errors;
};

SectionHeads make_heads(const AssetView& asset, std::span<const float> receiver_errors) {
    assert(std::ranges::all_of(asset.copies, [&](const CopyRecord& copy) {
        return copy.primitive >= asset.primitives.size() ||
               asset.primitives[copy.primitive].vertex_count == 0;
    }));
    const auto count = [](auto span) { return static_cast<std::uint32_t>(span.size()); };
    SectionHeads heads;
    heads.basis = {1, asset.cubemap_size, static_cast<std::uint32_t>(asset.pairing), 0};
    heads.primitives = {count(asset.primitives), sizeof(PrimitiveRecord), 0};
    heads.transport = rows_head(asset.transport);
    if (!asset.slots.empty()) heads.of_slots = store_slots(asset);
    heads.slots.vertices = count(asset.slots.slot);
    heads.mixes.places = count(std::span(heads.of_slots.mix));
    heads.copies = {count(asset.copies), sizeof(CopyRecord), {}};
    heads.mesh = {asset.receivers(), count(asset.index), count(asset.texcoord),
                  count(std::span(heads.of_slots.position))};
    heads.images.count = static_cast<std::uint32_t>(asset.images.size());
    for (const PreviewImage& image : asset.images) {
        heads.image_sizes.push_back({image.width, image.height});
    }
    heads.specular = {
        count(asset.roughness),
        asset.slots.empty() ? count(asset.openness) : count(std::span(heads.of_slots.openness)),
        {}};
    heads.gloss = {count(asset.gloss), sizeof(GlossRecord), {}};
    heads.holes = {count(asset.holes.record), sizeof(HoleRecord), count(asset.holes.vertex_alpha),
                   0};
    heads.added = {count(asset.added.count), sizeof(AddedVertex), count(asset.added.vertex), 0};
    heads.normal_maps = {count(asset.normal_maps.record), sizeof(NormalMapRecord),
                         count(asset.normal_maps.tangent), 0};
    heads.volumes = volumes_head(asset.volumes);
    heads.volume_rows = rows_head(asset.volumes.rows);
    heads.clouds = clouds_head(asset.clouds);
    heads.emitters = emitters_head(asset.emitters);
    heads.glow = glow_head(asset.volumes.glow);
    heads.receiver_errors.receivers = count(receiver_errors);
    return heads;
}

// Of meshes and what else every reader decodes.
constexpr int kSmallLevel = 6;

int level_of(Compression compression) {
    switch (compression) {
        case Compression::none:
            break;
        case Compression::fast:
            return 3;
        case Compression::best:
            return 19;
    }
    return kNotCompressed;
}

using Arrays = std::vector<std::span<const std::byte>>;

StoredSection store_mesh(const AssetView& asset, const SectionHeads& heads) {
    const StoredSlots& slots = heads.of_slots;
    const bool shares = !asset.slots.empty();
    const Arrays arrays{
        bytes_of(heads.mesh),
        std::as_bytes(shares ? std::span<const Vec3>(slots.position) : asset.position),
        std::as_bytes(shares ? std::span<const Vec3>(slots.normal) : asset.normal),
        std::as_bytes(asset.base_color),
        std::as_bytes(asset.texcoord),
        std::as_bytes(shares ? std::span<const std::uint32_t>(slots.index) : asset.index)};
    StoredSection section = store_arrays(kMeshSection, kSmallLevel, arrays);
    section.entry.version = shares ? kSlotsMeshVersion : 1;
    return section;
}

// Images compress well or are small.
StoredSection store_images(const AssetView& asset, const SectionHeads& heads) {
    Arrays arrays{bytes_of(heads.images), std::as_bytes(std::span(heads.image_sizes))};
    for (const PreviewImage& image : asset.images) {
        arrays.push_back(std::as_bytes(image.rgb));
    }
    return store_arrays(kImagSection, kSmallLevel, arrays);
}

// In the order of the file.
std::vector<StoredSection> store_sections(const AssetView& asset,
                                          std::span<const float> receiver_errors,
                                          Compression compression, const SectionHeads& heads) {
    const int level = level_of(compression);
    const bool shares = !asset.slots.empty();
    std::vector<StoredSection> sections;
    const auto add = [&](std::uint32_t id, int zstd_level, const auto& arrays) {
        sections.push_back(store_arrays(id, zstd_level, arrays));
    };
    if (!asset.provenance.empty()) {
        sections.push_back(store_text(kProvSection, asset.provenance));
    }
    add(kBasiSection, kNotCompressed, Arrays{bytes_of(heads.basis)});
    add(kPrimSection, kNotCompressed,
        Arrays{bytes_of(heads.primitives), std::as_bytes(asset.primitives)});
    sections.back().entry.version = version_of(asset);
    add(kTranSection, level, row_arrays(heads.transport, asset.transport));
    sections.back().entry.version = kTransportVersion;
    sections.push_back(store_mesh(asset, heads));
    if (!asset.added.empty()) {
        add(kRefiSection, kSmallLevel,
            Arrays{bytes_of(heads.added), std::as_bytes(asset.added.count),
                   std::as_bytes(asset.added.vertex)});
    }
    if (!asset.images.empty()) {
        sections.push_back(store_images(asset, heads));
    }
    if (!asset.roughness.empty()) {
        add(kSpecSection, kSmallLevel,
            Arrays{bytes_of(heads.specular), std::as_bytes(asset.roughness),
                   std::as_bytes(shares ? std::span<const Openness>(heads.of_slots.openness)
                                        : asset.openness)});
        sections.back().entry.version = shares ? kSlotsSpecularVersion : 1;
    }
    if (!asset.gloss.empty()) {
        add(kGlosSection, kSmallLevel, Arrays{bytes_of(heads.gloss), std::as_bytes(asset.gloss)});
    }
    if (!asset.holes.empty()) {
        add(kHoleSection, kSmallLevel,
            Arrays{bytes_of(heads.holes), std::as_bytes(asset.holes.record),
                   std::as_bytes(asset.holes.vertex_alpha)});
        const bool has_glass = std::ranges::any_of(
            asset.holes.record, [](const HoleRecord& h) { return h.clear != 0; });
        sections.back().entry.version = has_glass ? kClearHolesVersion : 1;
    }
    if (!asset.normal_maps.empty()) {
        add(kNormSection, kSmallLevel,
            Arrays{bytes_of(heads.normal_maps), std::as_bytes(asset.normal_maps.record),
                   std::as_bytes(asset.normal_maps.tangent)});
        const bool has_sheets =
            std::any_of(asset.normal_maps.record.begin(), asset.normal_maps.record.end(),
                        [](const NormalMapRecord& map) { return sheet_shares_of(map).any(); });
        sections.back().entry.version = has_sheets ? kMappedSheetVersion : 1;
    }
    if (!asset.volumes.empty()) {
        assert(asset.volumes.rows.cubemap_size == asset.cubemap_size);
        add(kVoluSection, level, volume_arrays(heads.volumes, asset.volumes, heads.volume_rows));
    }
    if (!asset.clouds.empty()) {
        add(kClouSection, level, cloud_arrays(heads.clouds, asset.clouds));
    }
    if (!asset.emitters.empty()) {
        add(kEmitSection, level, emitter_arrays(heads.emitters, asset.emitters));
    }
    if (!asset.volumes.glow.empty()) {
        add(kGlowSection, level, glow_arrays(heads.glow, asset.volumes.glow));
    }
    if (shares) {
        add(kSharSection, kSmallLevel,
            Arrays{bytes_of(heads.slots), std::as_bytes(std::span(heads.of_slots.code))});
    }
    if (!asset.slots.mix.empty()) {
        add(kMixrSection, kSmallLevel,
            Arrays{bytes_of(heads.mixes), std::as_bytes(std::span(heads.of_slots.mix))});
    }
    if (!asset.copies.empty()) {
        add(kCopySection, kSmallLevel, Arrays{bytes_of(heads.copies), std::as_bytes(asset.copies)});
    }
    if (!receiver_errors.empty()) {
        assert(receiver_errors.size() == asset.receivers());
        add(kRerrSection, kSmallLevel,
            Arrays{bytes_of(heads.receiver_errors), std::as_bytes(receiver_errors)});
    }
    return sections;
}

template <class Write>
Status write_padded(Write& write, std::uint64_t& position, std::uint64_t target) {
    while (position < target) {
        const std::size_t step = std::min<std::uint64_t>(target - position, kSectionAlignment);
        if (Status status = write(padding_zeros(step)); !status) return status;
        position += step;
    }
    return ok_status();
}

// Hands the file to `write`, a Status(std::span<const std::byte>), from beginning to end.
template <class Write>
Status write_parts(const AssetView& asset, std::span<const float> receiver_errors,
                   Compression compression, Write write) {
    const SectionHeads heads = make_heads(asset, receiver_errors);
    std::vector<StoredSection> sections =
        store_sections(asset, receiver_errors, compression, heads);
    std::vector<SectionEntry> table;
    std::uint64_t end = sizeof(FileHeader) + sections.size() * sizeof(SectionEntry);
    for (StoredSection& section : sections) {
        section.entry.offset = end + padding_to(kSectionAlignment, end);
        end = section.entry.offset + section.entry.stored_size;
        table.push_back(section.entry);
    }
    FileHeader header;
    header.version = kOpalVersion;
    header.file_size = end;
    header.section_count = static_cast<std::uint32_t>(table.size());
    header.table_checksum = checksum(std::as_bytes(std::span(table)));

    if (Status status = write(bytes_of(header)); !status) return status;
    if (Status status = write(std::as_bytes(std::span(table))); !status) return status;
    std::uint64_t position = sizeof header + table.size() * sizeof(SectionEntry);
    for (const StoredSection& section : sections) {
        if (Status status = write_padded(write, position, section.entry.offset); !status) {
            return status;
        }
        for (const auto part : section.parts) {
            if (Status status = write(part); !status) return status;
            position += part.size();
        }
    }
    return ok_status();
}

}  // namespace

Status write_opal_bytes(const AssetView& asset, AtomicFile& file,
                        std::span<const float> receiver_errors, Compression compression) {
    return write_parts(asset, receiver_errors, compression,
                       [&](std::span<const std::byte> bytes) { return file.write(bytes); });
}

Status write_opal(const AssetView& asset, AtomicFile file) {
    const Status status = write_opal_bytes(asset, file);
    return status ? file.commit() : status;
}

std::uint64_t opal_size(const AssetView& asset, Compression compression) {
    std::uint64_t size = 0;
    const Status counted =
        write_parts(asset, {}, compression, [&](std::span<const std::byte> bytes) {
            size += bytes.size();
            return ok_status();
        });
    return counted ? size : 0;
}

}  // namespace opaline::formats
