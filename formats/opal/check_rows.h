#pragma once

#include <cstdint>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::formats {

/// What a reader of holes relies on without further checks: records of primitives and images that
/// exist, in their order, none twice; alpha of all vertices or of none. No holes are fine.
/// Precondition: primitives are sound.
Fault find_holes_fault(const AssetView& asset);

/// What a sound baker never writes: alpha of vertices that is not in [0, 1].
Fault find_hole_value_fault(const HolesView& holes);

/// What is wrong with the light of volumes; empty if nothing is. Numbers, orders and parts,
/// whatever the values. Precondition: volumes and emitters passed their own checks.
Fault find_glow_fault(const AssetView& asset);

/// Values: not finite.
Fault find_glow_value_fault(const GlowView& glow);

/// True where the range first .. first + count - 1 lies in an array of `size` values.
constexpr bool lies_inside(std::uint64_t first, std::uint64_t count, std::uint64_t size) {
    return first <= size && count <= size - first;
}

/// What decoding any row relies on: offsets that ascend to the number of details, coefficient
/// indices below 6 n n. `section` says in which section the rows stand. Precondition: at least one
/// row offset, a valid cubemap_size.
Fault find_rows_fault(const SparseRowsView& rows, const std::string& section);

/// What a sound baker never writes: scales that are negative or not finite, indices out of order or
/// of face averages. Precondition: find_rows_fault found nothing.
Fault find_row_value_fault(const SparseRowsView& rows, const std::string& section);

/// Codes from first_code on that `count` rows need. Precondition: these rows exist.
std::uint64_t codes_of_rows(const SparseRowsView& rows, std::uint32_t first_row,
                            std::uint64_t count, std::uint32_t bands);

}  // namespace opaline::formats
