#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "bake/base/rng.h"
#include "bake/effects/multiple/walks/band_weights.h"
#include "bake/effects/multiple/walks/walk_counts.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/trace/medium_stack.h"

namespace opaline::bake {

/// The random numbers of one walk: a function of its keys alone, whatever thread follows it.
class WalkRandom {
  public:
    struct Key {
        std::uint64_t seed = 0;
        RandomStage stage = RandomStage::body_walk;
        std::uint32_t start = 0, walk = 0;
    };
    /// `spread`: the first numbers of walks with the same start are spread evenly over these walks
    /// (a rank-1 lattice), which then are not independent of one another.
    explicit WalkRandom(Key key, bool spread = false) : key_(key), spread_(spread) {}

    /// Uniform in [0, 1), 24 bits.
    float next() {
        if (spread_ && number_ < kSpread) return next_spread();
        if (used_ == 4) {
            block_ = random_uniform(key_.seed, key_.stage,
                                    key_.start | std::uint64_t{blocks_++} << 32, key_.walk);
            used_ = 0;
        }
        return block_[used_++];
    }

  private:
    // A start's direction, a flight, a turn, a flight.
    static constexpr std::uint32_t kSpread = 7;
    // Steps of the lattice in units of 2^-32: powers of 1 / phi, phi^8 = phi + 1 [Roberts2018].
    static constexpr std::array<std::uint32_t, kSpread> kStep{
        3915259345u, 3569120481u, 3253582939u, 2965941329u, 2703729436u, 2464699080u, 2246800835u};

    float next_spread() {
        if (number_ % 4 == 0) {
            constexpr std::uint64_t kShifts = std::uint64_t{1} << 63;
            block_ = random_uniform(key_.seed, key_.stage, key_.start | kShifts, number_ / 4);
        }
        const std::uint32_t place =
            kStep[number_] * key_.walk + static_cast<std::uint32_t>(0x1p32f * block_[number_ % 4]);
        ++number_;
        return static_cast<float>(place >> 8) * 0x1p-24f;
    }

    Key key_;
    bool spread_;
    std::uint32_t number_ = 0;  // of spread numbers drawn
    std::uint32_t blocks_ = 0, used_ = 4;
    std::array<float, 4> block_{};
};

/// A point just inside a body from which walks start, and the surface through which they are seen.
struct WalkStart {
    glm::vec3 position{0};  ///< [m], inside
    glm::vec3 normal{0};    ///< unit, outward, of the smooth surface: it refracts
    glm::vec3 flat{0};      ///< unit, outward, of the facet: walks start below it
    int shells = 1;         ///< of the medium, around the point
    glm::vec3 seen{0};      ///< unit, inside, toward the eye that sees it; 0: seen from everywhere
    /// Of walks that begin with a scattering at `position`: the way that they came, away from the
    /// eye. 0 of those that begin at the surface.
    glm::vec3 arrival{0};
    float depth = 0;  ///< [m] of `position` below the surface that the site lies on
    /// [m], at which the walk is seen, where that is a vertex.
    glm::vec3 vertex{std::numeric_limits<float>::quiet_NaN()};
    /// Bodies around `position`, where WalkSpace::bodies is set; none: `shells` of its own.
    std::optional<MediumStack> around{};
};

/// Light that a walk finds: radiance that arrives at `position` from outside along `direction`
/// reaches the start with `weight`.
struct WalkExit {
    glm::vec3 position{0};          ///< [m], on the boundary
    glm::vec3 normal{0};            ///< unit, outward, smooth
    glm::vec3 direction{0};         ///< unit, outside, away from the body
    std::array<float, 3> weight{};  ///< per band; 0 in bands that never scatter
    /// Number of scatterings over WalkSpace::diffuse_after. From 1 on `direction` is as
    /// uncorrelated with the walk's past as `drift`, the way from the start over the length of the
    /// walk, which is the mean of all directions inside.
    float turned = 0;
    glm::vec3 drift{0};
    std::uint32_t primitive = 0, first_index = 0;  ///< of the triangle
    float u = 0, v = 0;                            ///< weights of its second and third corner
    std::uint32_t material = 0;                    ///< of the body that it leaves
    bool is_once = false;                          ///< counts by WalkOrders::marks_once alone
};

/// Which light counts.
struct WalkOrders {
    /// Light scattered this often at least; less often, if it was also reflected at a boundary
    /// inside or went through another medium, but not without any scattering. 2: all but single
    /// scattering; 1: all.
    std::uint32_t least = 2;
    /// Light scattered once alone counts for diffuse light as well: its exits are marked.
    bool marks_once = false;
    /// Light that leaves the body unscattered counts as bright as the rest: nothing else holds it.
    bool fills_crossed = false;
    /// Light that is not scattered counts where it went through another body: `transmission` holds
    /// what stays in its own.
    bool crosses_others = false;
    /// Walks end where they are scattered or meet another body: what is left is their share of
    /// light that does neither.
    bool is_straight_alone = false;
};

/// Follows one walk backwards from the eye (README.md, "The estimator"). The start's direction is
/// that of uniform light in reverse, with density F_t(c) c over the outer hemisphere, refracted;
/// the sum of the exits' weights then has the mean of one term for all views,
///     T_0 = E[sum of weight V L],    L_o = F_t <T_0, L>,
/// without energy added or lost: albedo 1 gives 1, less what never scatters. E is over the walks of
/// all groups of bands together (band_weights.h). The walk passes through inner shells of its own
/// medium, and into the space's other media and out again (README.md, "Media inside"). Where it
/// meets a surface of no medium it is reflected if it has scattered (reflect_at), and ends if not:
/// that light is seen straight. At every arrival at the boundary of any of these bodies to the outside the transmitted part is an exit and the
/// reflected part goes on. `exits` are appended. Returns the direction inside, away from the body,
/// in which the walk is seen.
glm::vec3 follow_walk(const WalkSpace& space, const WalkGroup& group, const WalkStart& start,
                      const WalkOrders& orders, WalkRandom& random, std::vector<WalkExit>& exits,
                      WalkCounts& counts);

}  // namespace opaline::bake
