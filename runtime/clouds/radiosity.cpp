#include "runtime/clouds/radiosity.h"

#include <algorithm>
#include <array>

namespace opaline::runtime {
namespace {

using formats::Rgb;

constexpr std::array<float Rgb::*, 3> kBands{&Rgb::r, &Rgb::g, &Rgb::b};

// A quantity on the grid and beyond it.
struct Plane {
    std::vector<Rgb> cell;
    Rgb outside;
};

// f(cell, values of planes ...) for each cell and for the outside.
template <class Function, class... Planes>
void visit_cells(const std::vector<RadiosityCell>& cells, const RadiosityCell& outside,
                 const Function& f, Planes&... planes) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        f(cells[i], planes.cell[i]...);
    }
    f(outside, planes.outside...);
}

// What is far from the edges sees only itself.
Plane gather_plane(const GatherPlan& plan, const Plane& radiosity, unsigned threads) {
    return {gather(plan, radiosity.cell, radiosity.outside, threads), radiosity.outside};
}

std::array<double, 3> totals(const Plane& plane) {
    std::array<double, 3> sum{};
    for (const Rgb& value : plane.cell) {
        for (std::size_t band = 0; band < 3; ++band) {
            sum[band] += static_cast<double>(value.*kBands[band]);
        }
    }
    return sum;
}

// For the largest values of all cells.
std::uint32_t passes_for(const std::vector<RadiosityCell>& cells, const RadiosityCell& outside,
                         bool wraps, const RadiosityOptions& options) {
    Rgb albedo, reflectance;
    const auto include = [&](const RadiosityCell& cell) {
        for (const auto band : kBands) {
            albedo.*band = std::max(albedo.*band, cell.albedo.*band);
            reflectance.*band = std::max(reflectance.*band, cell.reflectance.*band);
        }
    };
    std::ranges::for_each(cells, include);
    if (!wraps) include(outside);
    return count_passes(albedo, reflectance, options);
}

// Adds the passes that were left out: `last` times q + q^2 + ...
void add_tail(const Plane& last, const Rgb& series, const Rgb& outside_series, Plane& sum) {
    for (std::size_t i = 0; i < sum.cell.size(); ++i) {
        sum.cell[i] = sum.cell[i] + series * last.cell[i];
    }
    sum.outside = sum.outside + outside_series * last.outside;
}

float sum_series(double quotient) {
    const double q = std::clamp(quotient, 0.0, kMaxQuotient);
    return static_cast<float>(q / (1 - q));
}

}  // namespace

std::uint32_t count_passes(const Rgb& albedo, const Rgb& reflectance,
                           const RadiosityOptions& options) {
    std::uint32_t passes = 0;
    for (const auto band : kBands) {
        if (!(albedo.*band > 0)) continue;
        const double q = std::min(kMaxQuotient, static_cast<double>(albedo.*band) *
                                                    static_cast<double>(reflectance.*band));
        std::uint32_t n = 1;
        for (double rest = q / (1 - q);
             n < options.max_passes && !(rest < static_cast<double>(options.tolerance)); ++n) {
            rest *= q;
        }
        passes = std::max(passes, std::min(n, options.max_passes));
    }
    return passes;
}

Radiosity solve_radiosity(const PlaneGrid& grid, const std::vector<RadiosityCell>& cells,
                          const RadiosityCell& outside, const RadiosityOptions& options) {
    const GatherPlan plan = make_gather_plan(grid);
    const auto each = [&](const auto& f, auto&... planes) {
        visit_cells(cells, outside, f, planes...);
    };
    Plane next{std::vector<Rgb>(cells.size()), {}};  // radiosity of the plane that shines next
    each([](const RadiosityCell& c, Rgb& to) { to = c.emission; }, next);
    Plane ground = gather_plane(plan, next, options.threads);
    Plane base{std::vector<Rgb>(cells.size()), {}};
    each([](const RadiosityCell& c, const Rgb& e, Rgb& to) { to = c.albedo * (c.direct + e); },
         ground, next);

    Radiosity result;
    result.passes = passes_for(cells, outside, grid.wraps, options);
    Plane last_ground, last_base;
    std::array<double, 3> before{}, after{};
    for (std::uint32_t n = 0; n < result.passes; ++n) {
        before = totals(next);
        last_base = gather_plane(plan, next, options.threads);
        each(
            [](const RadiosityCell& c, const Rgb& e, Rgb& rc, Rgb& to) {
                rc = rc + e;
                to = c.reflectance * e;
            },
            last_base, base, next);
        last_ground = gather_plane(plan, next, options.threads);
        each(
            [](const RadiosityCell& c, const Rgb& e, Rgb& rg, Rgb& to) {
                rg = rg + e;
                to = c.albedo * e;
            },
            last_ground, ground, next);
        after = totals(next);
    }
    if (result.passes > 0) {
        Rgb inside, beyond;
        for (std::size_t b = 0; b < 3; ++b) {
            const auto band = kBands[b];
            inside.*band = before[b] > 0 ? sum_series(after[b] / before[b]) : 0;
            beyond.*band = sum_series(static_cast<double>(outside.albedo.*band) *
                                      static_cast<double>(outside.reflectance.*band));
        }
        add_tail(last_ground, inside, beyond, ground);
        add_tail(last_base, inside, beyond, base);
    }
    result.ground = std::move(ground.cell);
    result.base = std::move(base.cell);
    result.outside_ground = ground.outside;
    result.outside_base = base.outside;
    return result;
}

}  // namespace opaline::runtime
