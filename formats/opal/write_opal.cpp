#include "formats/opal/write_opal.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <memory>
#include <string>

#include "formats/opal/layout.h"
#include "formats/opal/row_arrays.h"
#include "formats/opal/section.h"
#include "formats/opal/volume_arrays.h"

namespace opaline::formats {
namespace {

constexpr int kZstdLevel = 6;

std::size_t padding_to(std::size_t alignment, std::uint64_t size) {
    return static_cast<std::size_t>((alignment - size % alignment) % alignment);
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

// A section on its way into the file: its entry, and its stored bytes as parts.
struct Stored {
    SectionEntry entry;
    std::vector<std::span<const std::byte>> parts;
    std::string compressed;
};

constexpr std::byte kZeros[kSectionAlignment] = {};

// Sections are lists of arrays, each padded to 16 bytes, so that a reader can use them in place.
Stored store(std::uint32_t id, Codec codec, std::span<const std::span<const std::byte>> arrays) {
    Stored stored;
    stored.entry.id = id;
    for (const std::span<const std::byte> array : arrays) {
        const std::size_t padding = padding_to(kArrayAlignment, array.size());
        stored.parts.push_back(array);
        stored.parts.push_back({kZeros, padding});
        stored.entry.size += array.size() + padding;
    }
    if (codec == Codec::zstd) {
        std::string plain;
        plain.reserve(stored.entry.size);
        for (const auto part : stored.parts) {
            plain.append(reinterpret_cast<const char*>(part.data()), part.size());
        }
        std::string& out = stored.compressed;
        out.resize(ZSTD_compressBound(plain.size()));
        const std::size_t size =
            ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), kZstdLevel);
        if (ZSTD_isError(size) == 0U && size < plain.size() &&
            plain.size() / size < kMaxCompressionRatio) {
            out.resize(size);
            stored.entry.codec = static_cast<std::uint32_t>(Codec::zstd);
            stored.parts = {std::as_bytes(std::span(out.data(), out.size()))};
        }
    }
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                                XXH3_freeState);
    XXH3_64bits_reset(state.get());
    for (const auto part : stored.parts) {
        XXH3_64bits_update(state.get(), part.data(), part.size());
        stored.entry.stored_size += part.size();
    }
    stored.entry.checksum = XXH3_64bits_digest(state.get());
    return stored;
}

// Of PRIM: the earliest version that has all of it.
std::uint32_t version_of(std::span<const PrimitiveRecord> primitives) {
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

Stored store_provenance(const AssetView& asset) {
    // Text has no arrays to pad: one part, its exact length.
    Stored stored;
    stored.entry.id = kProvSection;
    const auto text = std::as_bytes(std::span(asset.provenance.data(), asset.provenance.size()));
    stored.parts = {text};
    stored.entry.size = stored.entry.stored_size = text.size();
    stored.entry.checksum = checksum(text);
    return stored;
}

Stored store_mesh(const AssetView& asset) {
    const MeshHead head{asset.receivers(), static_cast<std::uint32_t>(asset.index.size()),
                        static_cast<std::uint32_t>(asset.texcoord.size()), 0};
    const std::span<const std::byte> arrays[] = {bytes_of(head),
                                                 std::as_bytes(asset.position),
                                                 std::as_bytes(asset.normal),
                                                 std::as_bytes(asset.base_color),
                                                 std::as_bytes(asset.texcoord),
                                                 std::as_bytes(asset.index)};
    Stored stored = store(kMeshSection, Codec::zstd, arrays);
    if (stored.entry.codec == 0) {
        // `head` dies with this function: keep a copy where the parts can refer to it.
        stored.compressed.assign(reinterpret_cast<const char*>(&head), sizeof head);
        stored.parts.front() = std::as_bytes(std::span(stored.compressed));
    }
    return stored;
}

Stored store_images(const AssetView& asset) {
    const ImagesHead head{static_cast<std::uint32_t>(asset.images.size()), {}};
    std::vector<ImageSize> sizes;
    for (const PreviewImage& image : asset.images) {
        sizes.push_back({image.width, image.height});
    }
    // One block, since head and sizes are made here; images compress well or are small.
    std::string block(reinterpret_cast<const char*>(&head), sizeof head);
    const auto add = [&block](std::span<const std::byte> bytes) {
        block.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        block.append(padding_to(kArrayAlignment, bytes.size()), '\0');
    };
    add(std::as_bytes(std::span(sizes)));
    for (const PreviewImage& image : asset.images) {
        add(std::as_bytes(image.rgb));
    }
    const std::span<const std::byte> arrays[] = {std::as_bytes(std::span(block))};
    Stored stored = store(kImagSection, Codec::zstd, arrays);
    if (stored.entry.codec == 0) {
        stored.compressed = std::move(block);
        stored.parts.front() = std::as_bytes(std::span(stored.compressed));
    }
    return stored;
}

Stored store_specular(const AssetView& asset) {
    const SpecularHead head{static_cast<std::uint32_t>(asset.roughness.size()),
                            static_cast<std::uint32_t>(asset.openness.size()),
                            {}};
    const std::span<const std::byte> arrays[] = {bytes_of(head), std::as_bytes(asset.roughness),
                                                 std::as_bytes(asset.openness)};
    Stored stored = store(kSpecSection, Codec::zstd, arrays);
    if (stored.entry.codec == 0) {
        stored.compressed.assign(reinterpret_cast<const char*>(&head), sizeof head);
        stored.parts.front() = std::as_bytes(std::span(stored.compressed));
    }
    return stored;
}

Stored store_gloss(const AssetView& asset) {
    const GlossHead head{static_cast<std::uint32_t>(asset.gloss.size()), sizeof(GlossRecord), {}};
    const std::span<const std::byte> arrays[] = {bytes_of(head), std::as_bytes(asset.gloss)};
    Stored stored = store(kGlosSection, Codec::zstd, arrays);
    if (stored.entry.codec == 0) {
        stored.compressed.assign(reinterpret_cast<const char*>(&head), sizeof head);
        stored.parts.front() = std::as_bytes(std::span(stored.compressed));
    }
    return stored;
}

template <class Write>
Status write_padded(Write& write, std::uint64_t& position, std::uint64_t target) {
    while (position < target) {
        const std::size_t step = std::min<std::uint64_t>(target - position, sizeof kZeros);
        if (Status status = write(std::span(kZeros, step)); !status) {
            return status;
        }
        position += step;
    }
    return ok_status();
}

// Hands the file to `write`, a Status(std::span<const std::byte>), from beginning to end.
template <class Write>
Status write_parts(const AssetView& asset, Write write) {
    const BasisHead basis{1, asset.cubemap_size, static_cast<std::uint32_t>(asset.pairing), 0};
    const PrimitivesHead primitives{static_cast<std::uint32_t>(asset.primitives.size()),
                                    sizeof(PrimitiveRecord), 0};
    const TransportHead transport = rows_head(asset.transport);
    const std::span<const std::byte> basis_arrays[] = {bytes_of(basis)};
    const std::span<const std::byte> primitive_arrays[] = {bytes_of(primitives),
                                                           std::as_bytes(asset.primitives)};
    const VolumesHead volumes = volumes_head(asset.volumes);
    const TransportHead volume_rows = rows_head(asset.volumes.rows);

    std::vector<Stored> sections;
    sections.reserve(9);
    if (!asset.provenance.empty()) {
        sections.push_back(store_provenance(asset));
    }
    sections.push_back(store(kBasiSection, Codec::none, basis_arrays));
    sections.push_back(store(kPrimSection, Codec::none, primitive_arrays));
    sections.back().entry.version = version_of(asset.primitives);
    sections.push_back(store(kTranSection, Codec::none, row_arrays(transport, asset.transport)));
    sections.back().entry.version = kTransportVersion;
    sections.push_back(store_mesh(asset));
    if (!asset.images.empty()) {
        sections.push_back(store_images(asset));
    }
    if (!asset.roughness.empty()) {
        sections.push_back(store_specular(asset));
    }
    if (!asset.gloss.empty()) {
        sections.push_back(store_gloss(asset));
    }
    if (!asset.volumes.empty()) {
        assert(asset.volumes.rows.cubemap_size == asset.cubemap_size);
        sections.push_back(
            store(kVoluSection, Codec::none, volume_arrays(volumes, asset.volumes, volume_rows)));
    }

    std::vector<SectionEntry> table;
    std::uint64_t end = sizeof(FileHeader) + sections.size() * sizeof(SectionEntry);
    for (Stored& section : sections) {
        section.entry.offset = end + padding_to(kSectionAlignment, end);
        end = section.entry.offset + section.entry.stored_size;
        table.push_back(section.entry);
    }
    FileHeader header;
    header.version = kOpalVersion;
    header.file_size = end;
    header.section_count = static_cast<std::uint32_t>(table.size());
    header.table_checksum = checksum(std::as_bytes(std::span(table)));

    if (Status status = write(bytes_of(header)); !status) {
        return status;
    }
    if (Status status = write(std::as_bytes(std::span(table))); !status) {
        return status;
    }
    std::uint64_t position = sizeof header + table.size() * sizeof(SectionEntry);
    for (const Stored& section : sections) {
        if (Status status = write_padded(write, position, section.entry.offset); !status) {
            return status;
        }
        for (const auto part : section.parts) {
            if (Status status = write(part); !status) {
                return status;
            }
            position += part.size();
        }
    }
    return ok_status();
}

}  // namespace

Status write_opal_bytes(const AssetView& asset, AtomicFile& file) {
    return write_parts(asset, [&](std::span<const std::byte> bytes) { return file.write(bytes); });
}

Status write_opal(const AssetView& asset, AtomicFile file) {
    const Status status = write_opal_bytes(asset, file);
    return status ? file.commit() : status;
}

std::uint64_t opal_size(const AssetView& asset) {
    std::uint64_t size = 0;
    const Status counted = write_parts(asset, [&](std::span<const std::byte> bytes) {
        size += bytes.size();
        return ok_status();
    });
    return counted ? size : 0;
}

}  // namespace opaline::formats
