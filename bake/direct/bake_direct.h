#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/encode/select_coefficients.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// Where rows stand in a larger job, for its progress.
struct RowsDone {
    std::uint64_t before = 0, total = 0;
};

/// Grey rows of diffuse receivers, T = V max(0, n.w) / pi (direct/README.md, albedo 1), one
/// each, in order: dense, Haar, selection, quantisation. Only one dense vector per thread exists at
/// any time. Fewer rows if the context is cancelled. `rays` counts up.
formats::SparseRows bake_direct(const RayScene& scene, const DirectionSet& directions,
                                const Selector& selector, std::uint32_t code_bits,
                                std::span<const Receiver> receivers, RowsDone done,
                                const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
