#pragma once

#include <span>
#include <vector>

namespace opaline::bake {

/// Draws the cosine between the directions before and after a scattering.
class CosineSampler {
  public:
    /// [Henyey1941]; |g| < 1.
    static CosineSampler henyey_greenstein(double g);
    /// A density linear in the cosine between the rows, of any scale: cosines ascend within [-1,
    /// 1], values are >= 0 and not all of them 0.
    static CosineSampler tabulated(std::span<const double> cosine, std::span<const double> value);

    /// In [-1, 1]; ascends with `uniform`, in [0, 1).
    double sample(double uniform) const;

  private:
    double sample_table(double uniform) const;

    double g_ = 0;
    std::vector<double> cosine_, value_, cumulative_;  ///< a table, of integral 1
};

}  // namespace opaline::bake
