#pragma once

#include <cstddef>

#include "bake/plan/dense_rows.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// How the terms of a receiver add up to what an eye sees.
enum class TermsSeen {
    apart,    ///< terms of spherical harmonics, of the two sides of a sheet, or one alone
    together  ///< separate rows: the first is seen through h = 1, the others through harmonics
};

/// What encoding costs one receiver: the relative error of its stored rows against the dense ones
/// that they were made of, by dropped coefficients and rounded ones,
///
///     e = sqrt(sum_k |T_k - T'_k|^2 / sum_k |T_k|^2)
///
/// over terms, bands and coefficients. 0 where the dense rows are 0; NaN where they are not finite.
/// The basis is orthonormal, so that this is the RMS error of the receiver's radiance, relative to
/// its RMS radiance, of light that is white in the basis: coefficients of the light vector that are
/// uncorrelated and of equal variance, in the mean over the directions of view of which the h_k are
/// orthogonal (all of them inside the medium; both sides of a sheet). `together`: T_0 and T_1 first
/// become sqrt(4 pi) T_0 + T_1, the coefficient of the constant harmonic, times sqrt(4 pi).
/// For any light, one term, |<T, L> - <T', L>| <= e |T| |L| (Cauchy-Schwarz), which is e of the
/// most that a light of this norm could give. Natural light is stronger in coarse coefficients,
/// which are kept first: it errs less.
/// Not in it: noise and bias of the rows themselves, the model of light, what the cube map does not
/// resolve, interpolation between receivers, light of emitters, what is mirrored.
///
/// Sums of squares over several receivers add up.
struct RowLoss {
    double lost = 0, all = 0;

    float error() const;
};

/// Where the rows of a receiver stand among rows of receivers of one shape, that of `row`.
formats::RowRange rows_of_receiver(const formats::SparseRows& stored, std::size_t receiver,
                                   const DenseRow& row);

/// `stored`: rows of receivers of that shape alone.
RowLoss receiver_loss(const DenseRow& row, TermsSeen seen, const formats::SparseRows& stored,
                      std::size_t receiver);

}  // namespace opaline::bake
