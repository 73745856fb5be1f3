#include "formats/opal/read_opal.h"

#include <zstd.h>

#include <cstring>
#include <new>

#include "formats/opal/check_opal.h"
#include "formats/opal/layout.h"

namespace opaline::formats {
namespace {

// Hands out arrays of a section one after the other; every size is checked before it is believed.
class Cursor {
  public:
    explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <class T>
    bool take(std::uint64_t count, std::span<const T>& out) {
        if (count > rest_.size() / sizeof(T)) {
            return false;
        }
        const std::size_t size = static_cast<std::size_t>(count) * sizeof(T);
        const std::size_t padded = (size + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
        if (padded > rest_.size()) {
            return false;
        }
        out = {reinterpret_cast<const T*>(rest_.data()), static_cast<std::size_t>(count)};
        rest_ = rest_.subspan(padded);
        return true;
    }

    template <class T>
    bool take_one(T& out) {
        std::span<const T> one;
        if (!take(1, one)) {
            return false;
        }
        std::memcpy(&out, one.data(), sizeof out);
        return true;
    }

    bool at_end() const { return rest_.empty(); }

  private:
    std::span<const std::byte> rest_;
};

bool read_basis(Cursor cursor, AssetView& view) {
    BasisHead head;
    if (!cursor.take_one(head) || head.kind != 1 ||
        head.pairing != static_cast<std::uint32_t>(Pairing::light_carries_solid_angle)) {
        return false;
    }
    view.cubemap_size = head.cubemap_size;
    view.pairing = Pairing::light_carries_solid_angle;
    return true;
}

bool read_primitives(Cursor cursor, AssetView& view) {
    PrimitivesHead head;
    return cursor.take_one(head) && head.record_size == sizeof(PrimitiveRecord) &&
           cursor.take(head.count, view.primitives) && cursor.at_end();
}

bool read_mesh(Cursor cursor, AssetView& view) {
    MeshHead head;
    return cursor.take_one(head) && cursor.take(head.vertices, view.position) &&
           cursor.take(head.vertices, view.normal) && cursor.take(head.vertices, view.base_color) &&
           cursor.take(head.texcoords, view.texcoord) && cursor.take(head.indices, view.index) &&
           cursor.at_end();
}

bool read_images(Cursor cursor, AssetView& view) {
    ImagesHead head;
    std::span<const ImageSize> sizes;
    if (!cursor.take_one(head) || !cursor.take(head.count, sizes)) {
        return false;
    }
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

bool read_specular(Cursor cursor, AssetView& view) {
    SpecularHead head;
    return cursor.take_one(head) && cursor.take(head.primitives, view.roughness) &&
           cursor.take(head.vertices, view.openness) && cursor.at_end();
}

bool read_gloss(Cursor cursor, AssetView& view) {
    GlossHead head;
    return cursor.take_one(head) && head.record_size == sizeof(GlossRecord) &&
           cursor.take(head.primitives, view.gloss) && cursor.at_end();
}

bool read_transport(Cursor cursor, AssetView& view) {
    TransportHead head;
    if (!cursor.take_one(head) || (head.code_bits != 8 && head.code_bits != 16) ||
        (head.index_bytes != 2 && head.index_bytes != 4) || head.band_rows > UINT64_MAX / 6) {
        return false;
    }
    SparseRowsView& rows = view.transport;
    rows.code_bits = head.code_bits;
    rows.index_bytes = head.index_bytes;
    return cursor.take(std::uint64_t{head.rows} + 1, rows.row_offset) &&
           cursor.take(head.band_rows, rows.average_scale) &&
           cursor.take(head.band_rows, rows.detail_scale) &&
           cursor.take(head.band_rows * 6, rows.average_code) &&
           (head.index_bytes == 2 ? cursor.take(head.details, rows.index16)
                                  : cursor.take(head.details, rows.index32)) &&
           (head.code_bits == 8 ? cursor.take(head.codes, rows.code8)
                                : cursor.take(head.codes, rows.code16)) &&
           cursor.at_end();
}

}  // namespace

Result<LoadedAsset> read_opal(std::span<const std::byte> bytes, const std::string& file,
                              Checks checks) {
    Result<std::vector<SectionEntry>> table = read_section_table(bytes, file);
    if (!table) {
        return std::move(table).error();
    }
    const auto damaged = [&](std::string where, std::string fault) {
        return make_error(ErrorKind::bad_input, file, std::move(where), std::move(fault),
                          "the file is damaged: bake it again, or copy it again");
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
        bool (*read)(Cursor, AssetView&) = nullptr;
        unsigned bit = 0;
        std::uint32_t earliest = 1, latest = 1;
        switch (entry.id) {
            case kBasiSection:
                read = read_basis, bit = 1;
                break;
            case kPrimSection:
                read = read_primitives, bit = 2, latest = kSheetVersion;
                break;
            case kTranSection:
                read = read_transport, bit = 4, earliest = latest = kTransportVersion;
                break;
            case kMeshSection:
                read = read_mesh, bit = 8;
                break;
            case kImagSection:
                read = read_images;
                break;
            case kSpecSection:
                read = read_specular;
                break;
            case kGlosSection:
                read = read_gloss;
                break;
            case kProvSection:
                break;
            default:
                continue;  // of a later minor version, or somebody else's
        }
        if (entry.version > 0 && entry.version < earliest) {
            return make_error(
                ErrorKind::bad_input, file, where,
                "version " + std::to_string(entry.version) + " is of an earlier Opaline",
                "bake it again");
        }
        if (entry.version == 0 || entry.version > latest) {
            return make_error(ErrorKind::newer_file, file, where,
                              "version " + std::to_string(entry.version) + " is unknown",
                              "update Opaline");
        }
        if (entry.codec == static_cast<std::uint32_t>(Codec::zstd)) {
            if (entry.size / kMaxCompressionRatio > entry.stored_size ||
                ZSTD_getFrameContentSize(content.data(), content.size()) != entry.size) {
                return damaged(where, "its decoded size is not the one in the section table");
            }
            // operator new aligns to 16 bytes, as the arrays inside a section are.
            std::unique_ptr<std::byte[]> decoded(
                new (std::nothrow) std::byte[static_cast<std::size_t>(entry.size)]);
            if (decoded == nullptr) {
                return make_error(ErrorKind::resource, file, where,
                                  "no memory for " + std::to_string(entry.size) + " bytes",
                                  "free some memory");
            }
            const std::size_t size =
                ZSTD_decompress(decoded.get(), static_cast<std::size_t>(entry.size), content.data(),
                                content.size());
            if (size != entry.size) {
                return damaged(where, "its compressed data cannot be decoded");
            }
            content = {decoded.get(), static_cast<std::size_t>(entry.size)};
            loaded.decoded.push_back(std::move(decoded));
        } else if (entry.codec != 0 || entry.size != entry.stored_size) {
            return damaged(where, "unknown codec, or sizes that disagree");
        }
        if (entry.id == kProvSection) {
            loaded.view.provenance = {reinterpret_cast<const char*>(content.data()),
                                      content.size()};
        } else if (!read(Cursor(content), loaded.view)) {
            return damaged(where, "its counts do not agree with its size");
        }
        found |= bit;
    }
    if (found != 15) {
        return damaged("section table", "BASI, PRIM, TRAN and MESH must all be there");
    }
    loaded.view.transport.cubemap_size = loaded.view.cubemap_size;
    if (const Fault fault = find_structure_fault(loaded.view); !fault.what.empty()) {
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
