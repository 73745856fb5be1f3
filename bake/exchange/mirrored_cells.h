#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/frame.h"
#include "bake/exchange/bounce_ends.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What boundaries of media and narrow lobes mirror of the cells of a point: one cell sees much of
/// the sky, since a curved surface spreads its directions. A single ray a cell finds the sun by
/// chance, and the point is a bright speck among others. So a cell whose ray meets a mirror is
/// mirrored by several rays, one in each part of the cell; by its own ray alone where it meets a
/// coat that mirrors little. The cell's own ray alone decides that a mirror is met: of the others,
/// those that miss mirrors do not count, and the mean of the rest takes the cell's share.
class MirroredCells {
  public:
    /// Keeps the references. `most_rays`: that all cells together have, were all of them mirrored;
    /// `cuts_lobes`: of lobes, too, which else have one ray a cell.
    MirroredCells(const BounceSpace& space, const Receiver& at, const Frame& frame,
                  const BounceGrid& grid, std::uint64_t seed, std::uint32_t most_rays,
                  bool cuts_lobes);

    /// Adds the cell, with `share` of the point's irradiance, of an end that is met and seen.
    /// Returns its number; formats::kNone of one that nothing mirrors.
    std::uint32_t add(const BounceEnd& end, float share);
    /// The same of an end whose ray goes through the medium around the point, and on out of it
    /// (go_on_inside): the cell has no light of its own.
    void add_inside(const BounceEnd& end, float share, std::uint32_t medium);

    /// Appends what the cells mirror, and returns the rays that were traced.
    ///
    /// From no texel of the sky comes more by boundaries than a flat mirror shows: the share of the
    /// hemisphere in which the texel is mirrored is at most its solid angle over pi, and the
    /// texel's weight is scaled by what exceeds that. This bounds what one path can do. Where
    /// boundaries focus light, less than that is mirrored; the truth of a self-check keeps that
    /// light. Lobes have shares that vary little, and a metal has no other light that could take
    /// the rest.
    std::uint64_t follow(const BounceTree& tree, std::vector<NodeWeight>& weights);

    /// Share of the point's irradiance that a cell mirrors, the largest band; known after `follow`.
    float mirrored(std::uint32_t cell) const { return mirrored_[cell]; }
    /// Whether a lobe does.
    bool is_lobe(std::uint32_t cell) const { return is_lobe_[cell] != 0; }

  private:
    void add_parts(const BounceEnd& end, float share);
    template <class Visit>
    void visit_parts(std::uint32_t cell, Visit&& visit) const;
    std::uint32_t number_from(std::size_t first, float of_hemisphere, bool is_lobe);

    const BounceSpace& space_;
    const Receiver& at_;
    const Frame& frame_;
    const BounceGrid& grid_;
    std::uint64_t seed_ = 0, key_ = 0, traced_ = 0;
    bool cuts_lobes_ = true;
    std::uint32_t parts_ = 1;           // in the width of a cell: 1, 2 or 4
    std::vector<MirroredRay> open_;     // each numbered by its place here
    std::vector<float> of_hemisphere_;  // that each stands for
    std::vector<std::uint32_t> cell_;   // of each
    std::vector<float> mirrored_;       // by cell
    std::vector<std::uint8_t> is_lobe_;
};

}  // namespace opaline::bake
