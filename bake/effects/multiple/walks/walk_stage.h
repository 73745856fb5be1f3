#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/exit_light.h"
#include "bake/effects/multiple/walks/inner_field.h"
#include "bake/effects/multiple/walks/site_field.h"
#include "bake/effects/multiple/walks/site_row_sum.h"
#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/effects/multiple/walks/view_fit.h"
#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// Radius [mean free paths] of the largest useful balls in a medium: at most an eighth of the
/// body's diagonal, `size` [mean free paths], and the distance that light reaches before it is
/// absorbed; 0 where balls save no time (README.md, "Balls"). `g`: the mean cosine.
double largest_ball(double albedo, double g, double size);

/// Gives a space banks of balls for its media that do not vary, and a finer grid of clearances.
/// Media with the same phase function share a bank. Not where as few walks as `walks` would save no
/// more than banks cost. No walk's mean changes. No balls if the context is cancelled.
void add_balls(WalkSpace& space, double walks, std::uint64_t seed, const Context& context);

/// Number and spacing of sites, and the radius around a receiver within which they count.
struct SitePlan {
    std::uint32_t sites = 0;
    double radius = 0;  ///< [m]
    /// Sites are too far apart for the transport itself: they hold its difference to the dipole.
    bool is_residual = false;
};

/// What walks may cost.
struct WalkBudget {
    double around = 0;        ///< walks within the radius of each receiver
    double most = 0;          ///< in all, at most
    std::uint32_t sites = 0;  ///< from which they start, at most
};

/// `area` [m^2] and `diagonal` [m] of the body; `mean_free_path` [m] > 0 (walk_space.h). Where the
/// budget is too small for as many walks around each receiver, the radius grows.
SitePlan plan_sites(double area, double diagonal, double mean_free_path, const WalkBudget& budget);

/// Sites of residuals for `receivers` places at which rows are asked for: a radius as wide as these
/// are apart, up to a tenth of the diagonal [m], blurs no more than what is interpolated between
/// them, and asks for fewer walks and sites. Others are as planned.
void widen_for_receivers(SitePlan& plan, double area, double diagonal, double receivers);

/// Walks in all. `area` [m^2] of the body.
double count_walks(const SitePlan& plan, double area, const WalkBudget& budget);

/// How far around a receiver's flight sites inside count [m]. `mean_free_path` [m] > 0.
double inner_radius(const SitePlan& plan, double mean_free_path);

/// Rows at sites, from which rows of receivers are interpolated.
struct WalkStage {
    SiteField field, view_field;     ///< the latter of rows by view: they vary less and are noisier
    InnerField inner;                ///< instead of both, where sites are inside
    std::optional<WalkSpace> space;  ///< of the inner field, and where light crosses other bodies
    WalkOrders orders{};
    std::uint64_t seed = 0;
    bool fills_crossed = false;  ///< of its flights, as of WalkOrders
    SiteRows rows;
    ViewFit view_fit;  ///< of the boundary
    WalkCounts counts;
    std::optional<MediumField> medium;  ///< where it varies
    float depth = 0;                    ///< [m] to which its tint is looked for

    /// How bright the medium is below a point of the surface, in [0, 1]; 1 where it is homogeneous.
    float tint(glm::vec3 position, glm::vec3 normal) const;
};

struct WalkStageOptions {
    double radius = 0;        ///< [m] around a receiver
    double walks = 1e6;       ///< in all; at least one from each site for each group of bands
    bool is_inside = false;   ///< walks begin with a scattering inside, below the sites
    std::uint32_t views = 1;  ///< rows of a receiver: 1, 4 or 9
    /// Where rows are asked for: sites on the surface that no such place reads have none. Empty:
    /// anywhere.
    std::span<const BodyPoint> served{};
    SiteRowOptions rows;  ///< but for the numbers of walks and views
};

/// Sites on the surface of the space's material, between its samples.
std::vector<SurfaceSample> place_sites(const WalkSpace& space, const SitePlan& plan,
                                       std::uint64_t seed, const Context& context);

/// Walks from sites. `subtract`: as for walk_from_sites. Precondition of `is_inside`: one medium
/// that does not vary. Incomplete if the context is cancelled.
WalkStage take_walks(const WalkSpace& space, const ExitLight& light,
                     std::span<const SurfaceSample> sites, const WalkStageOptions& options,
                     const std::function<void(std::size_t, std::span<float>)>& subtract,
                     const Context& context);

/// Adds the row of a receiver, T_0, times `scale`, from sites on the surface, to four floats per
/// texel (one with one band), and the rows by view (SiteRows) to `views`: none, 3 or 8, one after
/// the other. Precondition: the stage has as many, and no sites inside.
void add_walked_rows(const WalkStage& stage, const BodyPoint& point, float scale,
                     std::span<float> rgbx, std::span<float> views);

/// The same rows, 1, 4 or 9, from sites inside. Precondition: the stage has some. `texels` of a
/// row.
SiteRowSum sum_inner_rows(const WalkStage& stage, const BodyPoint& point, std::size_t texels,
                          std::uint32_t rows);

}  // namespace opaline::bake
