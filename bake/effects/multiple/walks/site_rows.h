#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/exit_light.h"
#include "bake/effects/multiple/walks/walk.h"

namespace opaline::bake {

/// Rows of sites: Haar vectors with few entries, each with a value per band. The first row of a
/// site is T_0, the mean over views. Three more, if there are four, are its slopes over the view
/// (README.md, "Views"): seen along w' inside, it is row 0 + sum of (w' - m n)_k row k + 1.
/// Five more, of nine, add functions of degree two (view_fit.h).
struct SiteRows {
    struct Block {
        std::vector<std::uint32_t> offset{0};  ///< rows + 1, site by site
        std::vector<std::uint32_t> index;      ///< ascending within a row
        std::vector<float> value;              ///< `bands` for each index
    };
    static constexpr std::size_t kPerBlock = 16;
    std::vector<Block> blocks;  ///< each of kPerBlock sites, the last of as many or fewer
    std::uint32_t bands = 3;    ///< or 1
    std::uint32_t views = 1;    ///< rows of a site: 1, 4 or 9
    /// WalkCounts::scattered_share of each site, where SiteRowOptions say so; else none.
    std::vector<std::array<float, 3>> scattered;
};

struct SiteRowOptions {
    std::uint32_t cubemap_size = 32;
    std::uint32_t kept = 128;           ///< entries of a row; of those by view a quarter
    std::uint32_t views = 1;            ///< or 4 or 9
    std::uint32_t bands = 3;            ///< or 1, where those of the medium coincide
    std::uint32_t walks_per_site = 64;  ///< for each group of bands, >= 1
    std::uint64_t seed = 0;
    WalkOrders orders;
    bool counts_scattered = false;  ///< SiteRows::scattered
};

/// Where walks start from a site.
std::vector<WalkStart> make_walk_starts(const WalkSpace& space,
                                        std::span<const SurfaceSample> sites,
                                        const Context& context);

/// For each site the mean of its walks' exits, each as the light of a sample nearby: T_0
/// (README.md, "The estimator"). `subtract(site, row)`, if there is one, subtracts the dipole's
/// row, four floats per texel (one with one band), before the row is truncated. No walk is stored.
/// `is_read`: by site, 0 where nobody reads its row, which then stays empty; none: all are read.
/// The same bits for any number of threads; incomplete if the context is cancelled.
SiteRows walk_from_sites(const WalkSpace& space, std::span<const WalkStart> starts,
                         const ExitLight& light, const SiteRowOptions& options,
                         const std::function<void(std::size_t, std::span<float>)>& subtract,
                         const Context& context, WalkCounts& counts,
                         std::span<const std::uint8_t> is_read = {});

/// Adds weight * row of a site, weighted band by band, to `rgbx`, four floats per texel (one with
/// bands = 1). `view` < rows.views.
void add_site_row(const SiteRows& rows, std::size_t site, std::uint32_t view, glm::vec3 weight,
                  std::span<float> rgbx);

}  // namespace opaline::bake
