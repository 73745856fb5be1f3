#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/encode/select_coefficients.h"
#include "bake/multiple/gather_multiple.h"
#include "formats/opal/sparse_rows.h"
#include "formats/scene.h"

namespace opaline::bake {

/// RGB rows of a primitive's vertices inside a medium, T_0 = T_d / (pi c_exit), to be seen through
/// Ft (translucency.md 3.5, 3.6); `exit` = c_exit. One row each, in order. Fewer if the context is
/// cancelled.
formats::SparseRows bake_multiple(const ClusterTree& tree, const GatherProfile& profile,
                                  double exit, const GatherOptions& options,
                                  const Selector& selector, std::uint32_t code_bits,
                                  const formats::Primitive& primitive, const Context& context);

/// How many samples the surface of a medium needs: one per square of the depth of its source, so
/// that their sum has converged (translucency.md 3.7), at least 2000, at most `most`.
/// `area` [m^2].
std::uint32_t count_samples(double area, const MediumProfile& profile, std::uint32_t most);

}  // namespace opaline::bake
