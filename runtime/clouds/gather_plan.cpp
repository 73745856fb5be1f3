#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/clouds/plane_gather.h"

namespace opaline::runtime {
namespace {

// A Gaussian goes to a coarser grid where sigma is this many of its cells or more.
constexpr double kSigmaPerCell = 1.2;
constexpr std::uint32_t kLeastCells = 8;  // fewer are not halved
constexpr double kTapReach = 3.4;         // [sigma]; e^-5.8 of the rest

// One axis of the pyramid.
struct Axis {
    std::uint32_t cells = 1;
    double cell = 1;        // width
    double finest = 1;      // of the first level
    double smoothings = 0;  // sum over the halvings of the finer cell's width squared

    bool wraps = false;

    std::uint32_t halved() const { return (cells + 1) / 2; }
    /// Cells of the one that becomes of them: 2, or a little less where it would not end with them.
    double ratio() const { return wraps ? static_cast<double>(cells) / halved() : 2.0; }
    double halved_cell() const { return cell * ratio(); }
};

// Adds the shares of the fine cell `fine` that the coarse cells first, first + 1, ... cover.
void add_covers(std::int32_t fine, double ratio, double weight, GatherPlan::Mix& mix) {
    const double begin = fine / ratio, end = (fine + 1) / ratio;
    for (std::uint32_t c = 0; c < mix.weight.size(); ++c) {
        const double coarse = mix.first + static_cast<double>(c);
        const double covered = std::min(end, coarse + 1) - std::max(begin, coarse);
        if (covered < 1e-9) continue;
        mix.weight[c] += static_cast<float>(covered * ratio * weight);
        mix.count = std::max(mix.count, c + 1);
    }
}

// Fine cell j takes the mean of what it covers of coarse cells, smoothed by (1, 2, 1) / 4 over fine
// cells. Where the ratio is 2 these are the quadratic B-splines: widths do not depend on places.
GatherPlan::Mix spread_cell(std::int32_t j, double ratio) {
    GatherPlan::Mix mix;
    mix.first = static_cast<std::int32_t>(std::floor((j - 1) / ratio + 1e-9));
    add_covers(j - 1, ratio, 0.25, mix);
    add_covers(j, ratio, 0.5, mix);
    add_covers(j + 1, ratio, 0.25, mix);
    return mix;
}

// The transpose over the ratio: what cells send, all in all, stays the same both ways.
GatherPlan::Mix reduce_cell(std::int32_t j, double ratio,
                            const std::vector<GatherPlan::Mix>& spread) {
    GatherPlan::Mix mix;
    const auto ghosts = static_cast<std::int32_t>(GatherPlan::kGhosts);
    mix.first = std::numeric_limits<std::int32_t>::max();
    for (std::size_t i = 0; i < spread.size(); ++i) {
        const std::int32_t at = j - spread[i].first;
        if (at < 0 || at >= static_cast<std::int32_t>(spread[i].count)) continue;
        const std::int32_t fine = static_cast<std::int32_t>(i) - ghosts;
        mix.first = std::min(mix.first, fine);
        mix.count = static_cast<std::uint32_t>(fine - mix.first) + 1;
        mix.weight[mix.count - 1] = static_cast<float>(
            static_cast<double>(spread[i].weight[static_cast<std::size_t>(at)]) / ratio);
    }
    return mix.count > 0 ? mix : GatherPlan::Mix{};
}

// Of an axis that is halved or stays as it is, ghosts included.
void list_mixes(const Axis& fine, bool is_halved, std::vector<GatherPlan::Mix>& reduce,
                std::vector<GatherPlan::Mix>& spread) {
    const std::uint32_t coarse_cells = is_halved ? fine.halved() : fine.cells;
    const double ratio = is_halved ? fine.ratio() : 1;
    const auto ghosts = static_cast<std::int32_t>(GatherPlan::kGhosts);
    for (std::int32_t j = -ghosts; j < static_cast<std::int32_t>(fine.cells) + ghosts; ++j) {
        spread.push_back(is_halved ? spread_cell(j, ratio) : GatherPlan::Mix{j, 1, {1}});
    }
    for (std::int32_t j = -ghosts; j < static_cast<std::int32_t>(coarse_cells) + ghosts; ++j) {
        reduce.push_back(is_halved ? reduce_cell(j, ratio, spread) : GatherPlan::Mix{j, 1, {1}});
    }
}

void halve(Axis& axis) {
    axis.smoothings += axis.cell * axis.cell;
    const std::uint32_t cells = axis.halved();
    axis.cell = axis.halved_cell();
    axis.cells = cells;
}

bool can_halve(const Axis& axis, double sigma) {
    return axis.cells >= kLeastCells && sigma >= kSigmaPerCell * axis.halved_cell();
}

GatherPlan::Taps fold(const GatherPlan::Taps& taps, std::uint32_t cells) {
    GatherPlan::Taps folded;
    folded.weight.resize(cells);
    const auto period = static_cast<std::int32_t>(cells);
    for (std::size_t k = 0; k < taps.weight.size(); ++k) {
        const std::int32_t at = (taps.first + static_cast<std::int32_t>(k)) % period;
        folded.weight[static_cast<std::size_t>(at < 0 ? at + period : at)] += taps.weight[k];
    }
    return folded;
}

// The Gaussian over cells, for values that are even over each cell of the first level. The way to
// this level and back widens it; what remains is done here.
GatherPlan::Taps make_taps(const Axis& axis, double sigma, double share, bool wraps) {
    const double cell2 = axis.cell * axis.cell, finest2 = axis.finest * axis.finest;
    const double variance = sigma * sigma - (cell2 - finest2) / 4 - axis.smoothings;
    const double rest = std::sqrt(std::max(0.0, variance)) / axis.cell;
    if (wraps && rest > axis.cells) {
        return {0, std::vector<float>(axis.cells, static_cast<float>(share / axis.cells))};
    }
    const double scale = 1 / std::max(1e-9, rest * std::numbers::sqrt2);
    const double wanted = std::ceil(kTapReach * rest + 0.5);
    const double reach = wraps ? wanted : std::min(wanted, axis.cells + 2.0 * GatherPlan::kGhosts);
    const double whole = std::erf((wanted + 0.5) * scale);
    GatherPlan::Taps taps;
    taps.first = -static_cast<std::int32_t>(reach);
    for (double k = -reach; k <= reach; ++k) {
        const double covered =
            (std::erf((k + 0.5) * scale) - std::erf((k - 0.5) * scale)) / (2 * whole);
        taps.weight.push_back(static_cast<float>(share * covered));
    }
    return wraps && taps.weight.size() > axis.cells ? fold(taps, axis.cells) : taps;
}

struct Share {
    double sigma = 1, weight = 1;  // sigma per distance
};

// The trapezoidal rule over log s, in which s e^-s falls off fast on both sides.
std::vector<Share> list_shares() {
    constexpr int kWidest = -10, kNarrowest = 3;  // s = 2^k: sigma = 22.6 h down to h / 4
    std::vector<Share> shares;
    double sum = 0;
    for (int k = kNarrowest; k >= kWidest; --k) {
        const double s = std::ldexp(1.0, k);
        shares.push_back({1 / std::sqrt(2 * s), std::numbers::ln2 * s * std::exp(-s)});
        sum += shares.back().weight;
    }
    shares.back().weight += 1 - sum;  // all that is still wider
    return shares;
}

}  // namespace

GatherPlan make_gather_plan(const PlaneGrid& grid) {
    GatherPlan plan;
    plan.wraps = grid.wraps;
    Axis x{grid.columns, static_cast<double>(grid.cell_x), static_cast<double>(grid.cell_x), 0,
           grid.wraps};
    Axis z{grid.rows, static_cast<double>(grid.cell_z), static_cast<double>(grid.cell_z), 0,
           grid.wraps};
    plan.level.push_back({grid.columns, grid.rows, {}, {}, {}, {}, {}});
    for (const Share& share : list_shares()) {
        const double sigma = share.sigma * static_cast<double>(grid.distance);
        while (can_halve(x, sigma) || can_halve(z, sigma)) {
            const bool halve_x = can_halve(x, sigma), halve_z = can_halve(z, sigma);
            GatherPlan::Level level;
            list_mixes(x, halve_x, level.reduce_x, level.spread_x);
            list_mixes(z, halve_z, level.reduce_z, level.spread_z);
            if (halve_x) halve(x);
            if (halve_z) halve(z);
            level.columns = x.cells;
            level.rows = z.cells;
            plan.level.push_back(std::move(level));
        }
        plan.level.back().gaussian.push_back(
            {make_taps(x, sigma, 1, grid.wraps), make_taps(z, sigma, share.weight, grid.wraps)});
    }
    return plan;
}

}  // namespace opaline::runtime
