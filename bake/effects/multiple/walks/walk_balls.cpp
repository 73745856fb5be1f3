#include "bake/effects/multiple/walks/walk_balls.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace opaline::bake {
namespace {

bool is_same_phase(const PhaseTable& a, const PhaseTable& b) {
    return a.type == b.type && a.g == b.g && a.cosine == b.cosine;
}

// Of all bands.
double largest_of(const WalkSpace& space, const WalkMedium& medium) {
    const auto diagonal = static_cast<double>(glm::distance(space.low, space.high));
    double largest = 0;
    for (std::size_t group = 0; group < space.bands.size(); ++group) {
        const double size = diagonal * static_cast<double>(medium.sigma_t[group]);
        for (std::size_t b = 0; b < 3; ++b) {
            if (space.bands[group].member[b]) {
                const auto albedo = static_cast<double>(medium.albedo[b]);
                largest = std::max(largest, largest_ball(albedo, mean_cosine(medium.phase), size));
            }
        }
    }
    return largest;
}

// Cells of a mean free path, but not so small that the grid costs more than it saves.
void refine_grid(WalkSpace& space) {
    constexpr float kFinest = 1 / 400.0f;  // of the diagonal
    constexpr std::uint32_t kMostCells = 512;
    float densest = 0;
    for (const WalkMedium& medium : space.media) {
        densest = std::max({densest, medium.sigma_t[0], medium.sigma_t[1], medium.sigma_t[2]});
    }
    const float cell = std::max(1 / densest, kFinest * glm::distance(space.low, space.high));
    if (cell < space.cell) {
        space.cell = cell;
        space.clearance = ClearanceGrid(*space.scene, 0.5f * (space.low + space.high),
                                        0.5f * (space.high - space.low), cell, kMostCells);
    }
}

}  // namespace

double largest_ball(double albedo, double g, double size) {
    constexpr double kLeastSize = 200;  // walks in smaller bodies hardly ever have room
    constexpr double kPart = 1.0 / 8;
    constexpr double kReach = 2;  // diffusion lengths
    constexpr double kLeast = 5;  // smaller balls alone save no time
    const double lost = std::max(1e-9, (1 - albedo) * (1 - g * albedo));
    const double largest = std::min(kPart * size, kReach / std::sqrt(3 * lost));
    return size < kLeastSize || largest < kLeast ? 0 : largest;
}

void add_balls(WalkSpace& space, double walks, std::uint64_t seed, const Context& context) {
    // Events of a bank for each walk, which has tens or more, and a second or two in all.
    constexpr double kShare = 2, kMostEvents = 5e7;
    constexpr std::size_t kMostBanks = 8;  // of different phase functions
    space.balls.assign(space.media.size(), nullptr);
    std::vector<std::size_t> banked;
    for (std::size_t m = 0; m < space.media.size(); ++m) {
        const WalkMedium& medium = space.media[m];
        const double largest = medium.field ? 0 : largest_of(space, medium);
        if (!(largest > 0)) {
            continue;
        }
        const auto alike = std::ranges::find_if(banked, [&](std::size_t other) {
            return is_same_phase(space.media[other].phase, medium.phase);
        });
        if (alike != banked.end()) {
            space.balls[m] = space.balls[*alike];
            continue;
        }
        if (banked.size() == kMostBanks) {
            continue;
        }
        auto bank = std::make_shared<const BallBank>(
            make_ball_bank(medium.phase,
                           {.largest = largest,
                            .events = std::min(kShare * walks, kMostEvents),
                            .seed = seed,
                            .number = static_cast<std::uint32_t>(banked.size())},
                           context));
        if (bank->radii() > 0) {
            space.balls[m] = std::move(bank);
            banked.push_back(m);
        }
    }
    if (!banked.empty()) {
        refine_grid(space);
    }
}

}  // namespace opaline::bake
