#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "formats/opal/clouds.h"
#include "formats/opal/emitters.h"
#include "formats/opal/glow.h"
#include "formats/opal/layout.h"
#include "formats/opal/sparse_rows.h"
#include "formats/opal/volumes.h"

namespace opaline::formats {

/// Hands out arrays of a section one after the other; every size is checked before it is believed.
/// Arrays are spans into the section's bytes, which must be aligned to 16 bytes.
class SectionCursor {
  public:
    explicit SectionCursor(std::span<const std::byte> bytes) : rest_(bytes) {}

    /// The next array with its padding; false, and nothing taken, where the section is too short.
    template <class T>
    bool take(std::uint64_t count, std::span<const T>& out) {
        if (count > rest_.size() / sizeof(T)) return false;
        const std::size_t size = static_cast<std::size_t>(count) * sizeof(T);
        const std::size_t padded = (size + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
        if (padded > rest_.size()) return false;
        out = {reinterpret_cast<const T*>(rest_.data()), static_cast<std::size_t>(count)};
        rest_ = rest_.subspan(padded);
        return true;
    }

    /// A copy of the next value: a head.
    template <class T>
    bool take_one(T& out) {
        std::span<const T> one;
        if (!take(1, one)) return false;
        std::memcpy(&out, one.data(), sizeof out);
        return true;
    }

    bool at_end() const { return rest_.empty(); }

  private:
    std::span<const std::byte> rest_;
};

/// Sparse rows as they stand in `TRAN`, and behind the volumes in `VOLU`: a head and six arrays.

TransportHead rows_head(const SparseRowsView& rows);

/// Head and arrays in the order of the file. They point into `head` and into what `rows` points to.
std::array<std::span<const std::byte>, 7> row_arrays(const TransportHead& head,
                                                     const SparseRowsView& rows);

/// Reads both; sets all of `rows` but its cubemap_size. False where they do not fit into what is
/// left of the section, or the head has widths that do not exist. What the arrays say is not looked
/// at: measure_error.h.
bool take_rows(SectionCursor& cursor, SparseRowsView& rows);

/// Light of volumes as it stands in `GLOW`: a head and the arrays of GlowView in its order.

GlowHead glow_head(const GlowView& glow);

/// Head and arrays in the order of the file. They point into `head` and into what `glow` points to.
std::array<std::span<const std::byte>, 5> glow_arrays(const GlowHead& head, const GlowView& glow);

/// Reads all. False where it does not fit into what is left of the section. What the arrays say is
/// not looked at: check_rows.h.
bool take_glow(SectionCursor& cursor, GlowView& glow);

/// Cloud layers as they stand in `CLOU`: a head and the arrays of CloudsView in its order.

CloudsHead clouds_head(const CloudsView& clouds);

/// Head and arrays in the order of the file. They point into `head` and into what `clouds` points
/// to.
std::array<std::span<const std::byte>, 5> cloud_arrays(const CloudsHead& head,
                                                       const CloudsView& clouds);

/// Reads all of `clouds`. False where it does not fit into what is left of the section. What the
/// arrays say is not looked at: check_clouds.h.
bool take_clouds(SectionCursor& cursor, CloudsView& clouds);

/// Emitters as they stand in `EMIT`: a head and the arrays of EmittersView in its order.

EmittersHead emitters_head(const EmittersView& emitters);

/// Head and arrays in the order of the file. They point into `head` and into what `emitters` points
/// to.
std::array<std::span<const std::byte>, 6> emitter_arrays(const EmittersHead& head,
                                                         const EmittersView& emitters);

/// Reads all of `emitters`. False where it does not fit into what is left of the section. What the
/// arrays say is not looked at: check_emitters.h.
bool take_emitters(SectionCursor& cursor, EmittersView& emitters);

/// Volumes as they stand in `VOLU`: a head, the arrays of VolumesView in its order, their rows.

VolumesHead volumes_head(const VolumesView& volumes);

/// Heads, arrays and rows in the order of the file. They point into the heads (`rows` is that of
/// volumes.rows) and into what `volumes` points to.
std::vector<std::span<const std::byte>> volume_arrays(const VolumesHead& head,
                                                      const VolumesView& volumes,
                                                      const TransportHead& rows);

/// Reads all; sets all of `volumes` but the cubemap_size of its rows. False where it does not fit
/// into what is left of the section. What the arrays say is not looked at: check_volumes.h.
bool take_volumes(SectionCursor& cursor, VolumesView& volumes);

}  // namespace opaline::formats
