#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::bake {

/// A light in the bases that an error is measured in: luminance per Haar coefficient, pairing A.
struct TestLight {
    std::string name;           ///< as for `--light`
    std::vector<float> coarse;  ///< 6 n n, n the asset's cube map size
    std::vector<float> fine;    ///< 6 (2n)(2n), of the reference
};

/// Names of the published set, as for `--light`.
std::span<const char* const> published_lights();

/// <row, light>, summed in double precision; both of one length and basis.
double relit(std::span<const float> row, std::span<const float> light);

/// The published set: white, the sun at three angles, studio, sky.
formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads);

}  // namespace opaline::bake
