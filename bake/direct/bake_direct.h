#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/encode/select_coefficients.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// Position of these rows in a larger job, for its progress.
struct RowsDone {
    std::uint64_t before = 0, total = 0;
};

/// Grey rows of diffuse receivers, T = V max(0, n.w) / pi (direct/README.md, albedo 1), one row
/// each, in order: gather, Haar transform, selection, quantisation. Each thread holds one dense
/// vector. Fewer rows if the context is cancelled. Adds to `rays`.
formats::SparseRows bake_direct(const RayScene& scene, const DirectionSet& directions,
                                const Selector& selector, std::uint32_t code_bits,
                                std::span<const Receiver> receivers, RowsDone done,
                                const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
