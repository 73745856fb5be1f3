#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "bake/emitters/media_light.h"

namespace opaline::bake {

/// Watches light of media change from pass to pass, B_i+1 - B_i ~ q^i, and ends the series.
class SeriesSum {
  public:
    /// Passes end once all lamps' light changes by less than `least` of itself.
    SeriesSum(std::size_t lamps, double least) : lamps_(lamps), least_(least) {}

    /// Whether `after` needs no further pass, or gets none. Then the sum of all changes to come is
    /// added to it, q that of the last two passes, lamp by lamp and band by band.
    bool is_last(const MediaLight& before, MediaLight& after, bool gets_none);

  private:
    std::size_t lamps_;
    double least_;
    std::vector<glm::dvec3> last_;  // change of the pass before, summed up, by lamp
};

}  // namespace opaline::bake
