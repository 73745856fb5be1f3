#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "bake/exchange/scatterer_light.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Share of even light that a body scatters back around a point, band by band: light that leaves
/// over light that arrives, both summed over points of the surface within some transport mean free
/// paths. A single point does not suffice: light that leaves at the bottom of a fold arrived beside
/// it.
class EvenReturn {
  public:
    explicit EvenReturn(const formats::Medium& medium);

    /// A point; points are uniform by area. `arriving`: irradiance, `leaving`: radiosity by band.
    void add(glm::vec3 position, float arriving, const BandColour& leaving);

    /// In [0, 1]; where there are few points near, more and more that of all; 0 without any.
    BandColour share(glm::vec3 position) const;

  private:
    struct Flux {
        double arriving = 0;
        std::array<double, 3> leaving{};

        void add(const Flux& other, double weight);
    };
    using Cube = std::array<std::int64_t, 3>;
    Cube cube_of(glm::vec3 position) const;

    double side_;  // [m]
    std::map<Cube, Flux> cubes_;
    Flux all_;
    double count_ = 0;
};

}  // namespace opaline::bake
