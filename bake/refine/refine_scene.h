#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "bake/base/context.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How far receivers are added.
struct RefineLimits {
    /// Relative RMS that interpolation between receivers may err by, of the proxies' light: suns of
    /// all directions and an even sky, half each; and each lamp.
    double error = 0.05;
    std::uint64_t most_added = 0;      ///< receivers
    double probes_per_receiver = 0.1;  ///< how closely the meshes given are looked at
    std::uint32_t cubemap_size = 8;    ///< of the proxies: 8 or 16
    double longest_edge = 0;  ///< > 0: halve all edges that are longer [m], whatever the light does
    std::uint64_t seed = 0;
};

/// Why no more receivers were added.
enum class RefineEnd {
    met,        ///< the error, or the length of edges
    receivers,  ///< most_added
    points,     ///< what errs too much lies in small triangles, at which no point looks
    edges,      ///< triangles that err too much are a five-thousandth of the scene
    returns     ///< twice as many receivers lowered the error by less than an eighth
};

/// What refinement did.
struct RefineReport {
    std::uint64_t given = 0, added = 0;        ///< receivers
    double error_before = 0, error_after = 0;  ///< as of RefineLimits; 0 where edges decided
    RefineEnd end = RefineEnd::met;
    std::uint64_t rays = 0;

    bool is_bounded() const { return end == RefineEnd::receivers; }
};

struct RefinedScene {
    std::optional<formats::Scene> scene;  ///< nothing: none was added
    RefineReport report;
};

/// Adds receivers where the light changes between them: at middles of edges (split_mesh.h), where
/// the row of a point differs from what its triangle's corners interpolate. Rows are proxies
/// (proxy_rows.h).
///
/// First at points spread over all surfaces by area. Then, over and over, the triangles that hold
/// half of the squared error, the worst ones first, are halved [Doerfler1996], and their parts are
/// looked at: at the points that they inherit, and where these are fewer than two at the middle of
/// their longest edge, whose row is its vertex's later. RefineEnd says when it ends. Triangles of a
/// dense mesh in which no point lies stay as they are. The result is the same for any number of
/// threads; a cancelled context leaves it incomplete. `lamps`: whose light counts.
RefinedScene refine_scene(const formats::Scene& scene, const RayScene& rays,
                          std::span<const LampSources> lamps, const RefineLimits& limits,
                          const Context& context);

}  // namespace opaline::bake
