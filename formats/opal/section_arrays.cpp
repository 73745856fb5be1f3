#include "formats/opal/section_arrays.h"

#include "formats/opal/volumes.h"

namespace opaline::formats {

VolumesHead volumes_head(const VolumesView& volumes) {
    return {static_cast<std::uint32_t>(volumes.records.size()),
            sizeof(VolumeRecord),
            volumes.table.size(),
            volumes.density_scale.size(),
            volumes.corner.size(),
            volumes.node.size(),
            0};
}

std::vector<std::span<const std::byte>> volume_arrays(const VolumesHead& head,
                                                      const VolumesView& volumes,
                                                      const TransportHead& rows) {
    std::vector<std::span<const std::byte>> arrays{
        std::as_bytes(std::span(&head, 1)), std::as_bytes(volumes.records),
        std::as_bytes(volumes.table),       std::as_bytes(volumes.density_scale),
        std::as_bytes(volumes.density),     std::as_bytes(volumes.corner),
        std::as_bytes(volumes.node),        std::as_bytes(volumes.phase)};
    const auto of_rows = row_arrays(rows, volumes.rows);
    arrays.insert(arrays.end(), of_rows.begin(), of_rows.end());
    return arrays;
}

bool take_volumes(SectionCursor& cursor, VolumesView& volumes) {
    VolumesHead head;
    // Scales come before codes: where there are as many as bricks, 512 times that cannot overflow.
    return cursor.take_one(head) && head.record_size == sizeof(VolumeRecord) &&
           cursor.take(head.count, volumes.records) && cursor.take(head.cells, volumes.table) &&
           cursor.take(head.bricks, volumes.density_scale) &&
           cursor.take(head.bricks * kBrickVoxels, volumes.density) &&
           cursor.take(head.corners, volumes.corner) && cursor.take(head.nodes, volumes.node) &&
           cursor.take(std::uint64_t{head.count} * kPhaseEntries, volumes.phase) &&
           take_rows(cursor, volumes.rows);
}

EmittersHead emitters_head(const EmittersView& emitters) {
    return {emitters.size(),
            static_cast<std::uint32_t>(emitters.text.size()),
            static_cast<std::uint32_t>(emitters.own.size()),
            sizeof(OwnLight),
            emitters.block.size(),
            emitters.value.size(),
            sizeof(EmitterBlock),
            {}};
}

std::array<std::span<const std::byte>, 6> emitter_arrays(const EmittersHead& head,
                                                         const EmittersView& emitters) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(emitters.name_end),
            std::as_bytes(emitters.text),       std::as_bytes(emitters.block),
            std::as_bytes(emitters.own),        std::as_bytes(emitters.value)};
}

bool take_emitters(SectionCursor& cursor, EmittersView& emitters) {
    EmittersHead head;
    return cursor.take_one(head) && head.own_size == sizeof(OwnLight) &&
           head.block_size == sizeof(EmitterBlock) && cursor.take(head.count, emitters.name_end) &&
           cursor.take(head.text, emitters.text) && cursor.take(head.blocks, emitters.block) &&
           cursor.take(head.own, emitters.own) && cursor.take(head.values, emitters.value);
}

CloudsHead clouds_head(const CloudsView& clouds) {
    return {static_cast<std::uint32_t>(clouds.records.size()),
            sizeof(LayerRecord),
            clouds.thickness.size(),
            clouds.ground.size(),
            clouds.value.size(),
            {}};
}

std::array<std::span<const std::byte>, 5> cloud_arrays(const CloudsHead& head,
                                                       const CloudsView& clouds) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(clouds.records),
            std::as_bytes(clouds.thickness), std::as_bytes(clouds.ground),
            std::as_bytes(clouds.value)};
}

bool take_clouds(SectionCursor& cursor, CloudsView& clouds) {
    CloudsHead head;
    return cursor.take_one(head) && head.record_size == sizeof(LayerRecord) &&
           cursor.take(head.count, clouds.records) &&
           cursor.take(head.thickness, clouds.thickness) &&
           cursor.take(head.ground, clouds.ground) && cursor.take(head.values, clouds.value);
}

GlowHead glow_head(const GlowView& glow) {
    return {static_cast<std::uint32_t>(glow.record.size()),
            sizeof(GlowRecord),
            glow.brick.size(),
            glow.value.size(),
            {}};
}

std::array<std::span<const std::byte>, 5> glow_arrays(const GlowHead& head, const GlowView& glow) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(glow.record),
            std::as_bytes(glow.brick), std::as_bytes(glow.code), std::as_bytes(glow.value)};
}

bool take_glow(SectionCursor& cursor, GlowView& glow) {
    GlowHead head;
    // Numbers come before codes: where there are as many as bricks, 512 times that cannot overflow.
    return cursor.take_one(head) && head.record_size == sizeof(GlowRecord) &&
           cursor.take(head.count, glow.record) && cursor.take(head.bricks, glow.brick) &&
           cursor.take(head.bricks * kBrickVoxels, glow.code) &&
           cursor.take(head.values, glow.value);
}

TransportHead rows_head(const SparseRowsView& rows) {
    return {rows.rows(),
            rows.code_bits,
            rows.index_bytes,
            0,
            rows.detail_scale.size(),
            rows.index16.size() + rows.index32.size(),
            rows.code8.size() + rows.code16.size(),
            0};
}

std::array<std::span<const std::byte>, 7> row_arrays(const TransportHead& head,
                                                     const SparseRowsView& rows) {
    return {std::as_bytes(std::span(&head, 1)),
            std::as_bytes(rows.row_offset),
            std::as_bytes(rows.average_scale),
            std::as_bytes(rows.detail_scale),
            std::as_bytes(rows.average_code),
            rows.index_bytes == 2 ? std::as_bytes(rows.index16) : std::as_bytes(rows.index32),
            rows.code_bits == 8 ? std::as_bytes(rows.code8) : std::as_bytes(rows.code16)};
}

bool take_rows(SectionCursor& cursor, SparseRowsView& rows) {
    TransportHead head;
    if (!cursor.take_one(head) || (head.code_bits != 8 && head.code_bits != 16) ||
        (head.index_bytes != 2 && head.index_bytes != 4) || head.band_rows > UINT64_MAX / 6) {
        return false;
    }
    rows.code_bits = head.code_bits;
    rows.index_bytes = head.index_bytes;
    return cursor.take(std::uint64_t{head.rows} + 1, rows.row_offset) &&
           cursor.take(head.band_rows, rows.average_scale) &&
           cursor.take(head.band_rows, rows.detail_scale) &&
           cursor.take(head.band_rows * 6, rows.average_code) &&
           (head.index_bytes == 2 ? cursor.take(head.details, rows.index16)
                                  : cursor.take(head.details, rows.index32)) &&
           (head.code_bits == 8 ? cursor.take(head.codes, rows.code8)
                                : cursor.take(head.codes, rows.code16));
}

}  // namespace opaline::formats
