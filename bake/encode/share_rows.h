#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/encode/receiver_error.h"
#include "bake/encode/row_sink.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// The encoder of rows that are going to be shared: a row may keep up to twice as many coefficients
/// as rows keep in the mean.
RowEncoder widen(const RowEncoder& encoder);

/// Room for the rows of a primitive, so that they are not copied as they grow.
void reserve_rows(formats::SparseRows& rows, const RowEncoder& wide, std::size_t count,
                  std::uint32_t bands);

/// What the rows of a primitive have in common. `terms` rows are one receiver's.
struct RowShape {
    std::uint32_t terms = 1, bands = 1;
    TermsSeen seen = TermsSeen::apart;
};

/// Of the rows of all receivers of a primitive, encoded by widen(encoder), those details that
/// matter most: as many as all rows would keep if each kept the largest of its own.
///
/// Would each row keep a number of its own, then an occluder that comes into sight of a floor would
/// bring details that push out others, which the floor's open sky has: neighbours drop different
/// ones of many that are equally large, and a floor in the sun shows it as blotches with edges.
/// With one least score for all, what is the same in two rows is kept or dropped in both.
///
/// A row's score is divided by the square root of the size of its averages, the RMS radiance under
/// even light: the eye, as sRGB, sees about the square root of light, whose error is dx / (2 sqrt
/// x). Terms of view weigh by their own size: views lie in half of the sphere, where terms are not
/// orthogonal, and small ones need more than Parseval's share (glass of `playing-pieces`).
formats::SparseRows share_rows(formats::SparseRows rows, const RowShape& shape,
                               const RowEncoder& encoder);

/// What encoding and sharing costs each receiver, known once the rows are shared and the dense ones
/// are gone: the wide rows in codes of 16 bits, whose rounding is nothing beside what is dropped,
/// stand for these. Of terms that are seen together what one lost before and the other loses now is
/// taken to be uncorrelated, which errs by some percent of the error.
class LossMeter {
  public:
    LossMeter(const RowEncoder& wide, const RowShape& shape);

    void add(const DenseRow& row);
    void append(const LossMeter& tail);
    /// `kept`: the rows of all receivers added.
    std::vector<RowLoss> losses(const formats::SparseRows& kept) const;

  private:
    RowShape shape_;
    RowEncoder encoder_;
    formats::SparseRows rows_;
    std::vector<RowLoss> beyond_;  // what the wide rows lose
};

}  // namespace opaline::bake
