#pragma once

#include <complex>

#include "formats/opal/result.h"

namespace opaline::bake {

/// What droplets or crystals are made of.
enum class Substance {
    water,  ///< liquid, 25 degrees C [HaleQuerry1973]
    ice     ///< -7 degrees C [WarrenBrandt2008]
};

/// Index m_r + i m_i, m_i >= 0, linear between the rows of the published table: every 25 nm from
/// 300 to 1000 nm for water, every 10 nm from 400 to 800 nm for ice. `wavelength` in metres.
/// Errors: `usage` outside of the table (NaN included), naming its ends.
formats::Result<std::complex<double>> refractive_index(Substance substance, double wavelength);

}  // namespace opaline::bake
