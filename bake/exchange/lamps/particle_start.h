#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/physics/path_differentials/path_differential.h"

namespace opaline::bake {

struct ParticleRun;

/// Where particles of a lamp start: its triangles, its lights, its voxels, chosen in proportion to
/// power.
struct StartTable {
    const LampSources& lamp;
    std::vector<double> cumulative;  ///< of largest bands [lm]

    bool empty() const { return cumulative.empty() || !(cumulative.back() > 0); }
};

StartTable make_start_table(const LampSources& lamp);

/// A particle in flight.
struct Particle {
    glm::dvec3 position{0}, direction{0};
    glm::dvec3 power{0};  ///< [lm]
    double range = 0;     ///< [m] of its light; 0: endless
    PathDifferential path;
    std::array<float, 3> first_bounce{};  ///< its random numbers at the first surface

    /// Share that the light's range leaves at a distance [m].
    double dimming(double distance) const;
};

/// Random numbers of a lamp's particle.
std::uint64_t particle_key(const ParticleRun& run, std::uint64_t particle);

/// A particle at its source, with its share of the lamp's power. The first eight numbers of all
/// particles are a lattice [Roberts2018], shifted by the seed. Precondition: the table is not
/// empty.
Particle start_particle(const StartTable& table, const DifferentialRules& rules,
                        const ParticleRun& run, std::uint64_t particle);

}  // namespace opaline::bake
