#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/exchange_points.h"
#include "bake/exchange/gather_sites.h"
#include "bake/exchange/scatterer_light.h"
#include "bake/exchange/series_end.h"
#include "bake/exchange/solve_bounces.h"
#include "bake/plan/effect.h"
#include "bake/trace/coded_rows.h"

namespace opaline::bake {

/// Rays of a scatterer to other scatterers, and of a point whose light is averaged.
inline constexpr std::uint32_t kRaysOfScatterer = 64, kRaysOfAveraged = 16;
/// Largest number of sites among receivers before more are added where they are too sparse. With
/// fewer receivers than that, rays of their own cost less than sites.
inline constexpr std::size_t kMostSites = 16384, kFewestWithSites = 4096;
/// Rays of a site where a receiver without sites has `of_receiver`.
std::uint32_t count_rays_of_site(std::uint32_t of_receiver);
/// Scatterers that are looked for.
std::size_t count_scatterers(std::uint32_t rays_of_receiver);

/// Light that goes from surface to surface: the radiosity B of scatterers, all bounces included.
struct BounceLight {
    const formats::Scene& scene;
    const RayScene& rays;
    std::uint32_t cubemap_size = kBounceCubemap;  ///< of its rows
    std::uint32_t bands = 3;                      ///< or 1
    std::uint64_t seed = 0;
    std::vector<RowLayout> layouts;  ///< by material
    BounceTree tree;                 ///< rows: B, band by band
    Transfer transfer;  ///< of its scatterers; without bounces there may be no arrivals
    BounceGrid of_site, of_receiver, of_averaged;  ///< rays; of a point whose light is averaged
    SolveReport report{};
    GatherSites sites;    ///< among receivers
    CodedRows site_rows;  ///< E, as long as the tree's

    BounceSpace space() const { return {scene, rays, layouts}; }
    /// Variance of a fit to sites, of that of one: with it the fit is as good as the rays `instead`
    /// of it, were these independent.
    float most_noise(const BounceGrid& instead) const {
        return static_cast<float>(of_site.rays) / static_cast<float>(instead.rays);
    }
};

/// What is solved for: the sky's light as scatterers send it on at once, with all that follows, or
/// the former with all that other light needs to be followed (Transfer).
enum class Bounces : std::uint8_t { none, all, of_lamps };

/// Finds the light of scatterers; null where there are none. `media`: rows of
/// ExchangePoints::media, in that order. Without bounces of the sky it is what they make of its
/// light, in three bands, and knows no sites. `rays` counts up.
std::shared_ptr<const BounceLight> solve_exchange(const LightInputs& inputs, ExchangePoints points,
                                                  std::span<const MediumRows> media,
                                                  std::uint64_t& rays,
                                                  Bounces bounces = Bounces::all);

/// What answers a view.
struct SeenNode {
    std::uint32_t node = 0;
    std::uint32_t view = 0;       ///< its number
    formats::Rgb share{1, 1, 1};  ///< of the view's light: less of what is mirrored
};

/// For each view the node of its surface that is as large as the view's footprint, by nodes. Views
/// that meet no radiating surface have none. Views that meet a medium or a narrow lobe have more,
/// for the light that it mirrors. `traced` counts up.
std::vector<SeenNode> find_seen(const BounceSpace& space, const BounceTree& tree,
                                std::span<const SurfaceView> views, double solid_angle,
                                std::uint64_t& traced);

/// Adds the radiance that views see of other surfaces per unit of each basis light, times their
/// weights and factors: to `rows`, a row for each factor, `bands` planes each as of add_bounced. It
/// is radiosity over pi of the clusters as large as each view's footprint (`solid_angle` [sr]), the
/// same in all directions. Returns the rays traced.
std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows);

/// Where light is asked for, outside of any boundary.
struct LitPoint {
    const Receiver& receiver;
    /// One of many points whose light is averaged, as the samples of a medium: each may be noisy.
    bool is_averaged = false;
};

/// Adds irradiance at a point, Haar rows as of add_irradiance: interpolated from the sites around,
/// or by final gathering where these are too few. Returns the rays traced, 0 if interpolated.
std::uint64_t add_bounced(const BounceLight& light, const LitPoint& point,
                          std::uint32_t cubemap_size, std::span<float> rows);

}  // namespace opaline::bake
