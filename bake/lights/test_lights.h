#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "bake/base/rng.h"
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
/// and takes a second: `cache` is a file to keep it in (test_lights.h), empty for none.
formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads,
                                                         const std::filesystem::path& cache = {});

/// Projects them on a cube map of another size.
void project_test_lights(std::span<TestLight> lights, std::uint32_t cubemap_size);

/// The test lights that this very program (its file, byte for byte) wrote before, without
/// TestLight::coarse; empty where there are none, or a byte of them is wrong.
std::vector<TestLight> read_test_lights(const std::filesystem::path& file);

/// Keeps them for the next time. A failure is no error: they are computed again.
void write_test_lights(const std::filesystem::path& file, const std::vector<TestLight>& lights);

/// `wanted` of `count` distinct indices, ascending, one from each of `wanted` equal runs, so that
/// they cover all primitives. Drawn by (seed, stage).
std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed);

/// How many receivers the self-check compares with the truth out of `receivers`; as many points
/// between them are compared as well. With these numbers the check costs at most a tenth of the
/// bake, except in small scenes: the truth of a point costs as much as the rows of some ten
/// receivers at N = 16 and of two or three at N = 32, whatever the scene.
inline std::size_t count_checked(std::size_t receivers, std::uint32_t cubemap_size) {
    constexpr std::size_t kLeast = 32, kMost = 1024;
    // 1 in 96 at N = 32, in proportion to N, but not more often.
    constexpr std::size_t kReceiversPerCheck = 96, kFullSize = 32;
    const std::size_t share = std::min<std::size_t>(cubemap_size, kFullSize);
    const std::size_t wanted = receivers * share / (kReceiversPerCheck * kFullSize);
    return std::min(receivers, std::clamp(wanted, kLeast, kMost));
}

/// The most of these where the truth of each costs as much as the rows of dozens.
inline constexpr std::size_t kMostExpensiveChecks = 128;

}  // namespace opaline::bake
