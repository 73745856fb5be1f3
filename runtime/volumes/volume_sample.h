#pragma once

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::runtime {

/// What volumes do to light at a point, all of them added up.
struct VolumeSample {
    formats::Rgb extinction;  ///< sum of sigma_t density [1/m]
    /// sum of sigma_t albedo density max(0, J), and what volumes send out by themselves
    /// [W m^-3 sr^-1]
    formats::Rgb scattered;
};

/// The integrands of march_volumes at `point` [m, world] toward the eye, which lies in the unit
/// direction `to_eye`; for hosts that march by themselves. Finite and not negative for any
/// arguments; nothing where nothing is. Never allocates.
VolumeSample sample_volumes(const LitVolumes& volumes, formats::Vec3 point, formats::Vec3 to_eye);

}  // namespace opaline::runtime
