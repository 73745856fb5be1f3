#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/encode/select_coefficients.h"
#include "bake/multiple/gather_multiple.h"
#include "bake/plan/row_layout.h"
#include "bake/translucent/local_stage.h"
#include "bake/translucent/multiple_stage.h"
#include "bake/translucent/single_stage.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// How one receiver's rows are put together.
struct TranslucentRecipe {
    RowLayout layout;
    const MediumProfile* profile = nullptr;   ///< null: no multiple scattering
    const MultipleStage* multiple = nullptr;  ///< null: none, or local
    const SingleStage* single = nullptr;      ///< null: none, or local
    const LocalStage* local = nullptr;        ///< both, in place of the two
    GatherOptions gather;
    Selector selector;
    std::uint32_t code_bits = 8;
    std::size_t batch_bytes = std::size_t{2} << 30;  ///< memory for single scattering at a time
};

/// Values of one receiver's rows before selection: term by term, band by band, Haar coefficients,
/// layout.terms() * layout.bands() * 6 n n values, overwritten (translucency.md 3.6):
///     T_0 = T_d / (pi c_exit h_0) + T^(1)_0,   T_k = T^(1)_k.
/// `single`: the receiver's row of a batch; null where there is none. Returns the number of rays
/// traced, which only a local recipe does, from `receiver`.
std::uint64_t assemble_rows(const TranslucentRecipe& recipe, const RayScene& rays,
                            const Receiver& receiver, const BodyPoint& point,
                            const SingleBatch* batch, std::size_t place, std::span<float> rows);

/// Finished rows of the points of one material's primitive, in order; fewer, in no order, if the
/// context is cancelled or if they hold more than 2^32 - 1 coefficients. `receivers`: of the same
/// vertices. `counts` adds up.
formats::SparseRows bake_translucent(const TranslucentRecipe& recipe, const RayScene& rays,
                                     std::span<const Receiver> receivers,
                                     std::span<const BodyPoint> points, const Context& context,
                                     EntryCounts& counts);

}  // namespace opaline::bake
