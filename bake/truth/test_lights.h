#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::bake {

/// Cube map of the smooth part of the test lights; independent of the knobs.
inline constexpr std::uint32_t kTruthCubemap = 64;

/// A sun of a test light, as a disc.
struct TestDisc {
    glm::vec3 direction{0, 1, 0};  ///< unit, toward its centre
    float angular_radius = 0;      ///< [rad]
    double flux = 0;               ///< luminance times solid angle
};

/// A published light, in luminance: projected as in the runtime, and exact.
struct TestLight {
    std::string name;           ///< as for `--light`
    std::vector<float> coarse;  ///< Haar, pairing A, discs included; 6 n n, n the asset's
    std::vector<TestDisc> discs;
    std::vector<float> smooth;  ///< everything else: integrals over the texels of kTruthCubemap
};

/// Names of the published set, as for `--light`.
std::span<const char* const> published_lights();

/// <row, light>, summed in double precision; both of one length and basis.
double relit(std::span<const float> row, std::span<const float> light);

/// The published set: white, the sun at three angles, studio, sky. It is the same for every bake,
/// and takes a second: `cache` is a file to keep it in (test_light_cache.h), empty for none.
formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads,
                                                         const std::filesystem::path& cache = {});

/// Projects them on a cube map of another size.
void project_test_lights(std::span<TestLight> lights, std::uint32_t cubemap_size);

}  // namespace opaline::bake
