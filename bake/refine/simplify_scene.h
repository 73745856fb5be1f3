#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How far receivers are taken away.
struct SimplifyLimits {
    /// Relative RMS that vertices without rows of their own may err by, of the light that
    /// RefineLimits::error is of.
    double error = 0;
    double angle = 0.1;              ///< that a cell of the file's cube map is wide [rad]
    std::uint32_t cubemap_size = 8;  ///< of the proxies: 8 or 16
    std::size_t points = 512;        ///< where the error is measured
    std::uint64_t seed = 0;
};

/// What was taken away.
struct SimplifyReport {
    std::uint64_t given = 0, kept = 0;  ///< places and normals; those with rows. Equal: all
    double error = 0;                   ///< as of SimplifyLimits, measured; 0 where all are kept
    std::uint64_t rays = 0;
};

struct SimplifiedScene {
    formats::Slots slots;  ///< as find_slots, and mixed where receivers were taken away
    SimplifyReport report;
};

/// Whether a scene has so many vertices that `simplify_scene` may take any away.
bool has_dense_meshes(const formats::Scene& scene);

/// Finds vertices of dense smooth meshes that need no rows: what their light is can be interpolated
/// from others of their primitive (coarse_mesh.h). How far apart these may be is known from
/// normals, and from how near those are that cast shadows (receiver_spacing.h), which is asked at
/// vertices that stay, over and over where more of them do. The error is then measured with proxy
/// rows at random mixed vertices, and limits are set again until it is met. Where that fails, or
/// hardly any receivers would go, all stay.
///
/// Of opaque surfaces that are neither thin-walled nor metals: rows of others depend on the view,
/// or hold light of which proxies know nothing. The result is the same for any number of threads; a
/// cancelled context leaves all. `lamps`: whose light counts.
SimplifiedScene simplify_scene(const formats::Scene& scene, const RayScene& rays,
                               std::span<const LampSources> lamps, const SimplifyLimits& limits,
                               const Context& context);

}  // namespace opaline::bake
