#pragma once

#include <nlohmann/json.hpp>

#include "bake/physics/mie/angular_table.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/slab_medium.h"
#include "formats/scene.h"

namespace opaline::cli {

/// A slab and how it is looked at: in the plane of the light and the normal.
struct SlabViews {
    double optical_depth = 1, cosine = 1;  ///< of the light
    const bake::SlabMedium& medium;
    const bake::AngularTable& phase;  ///< the same phase function, integral 1
    unsigned count = 90;              ///< angles, evenly spaced between both horizons
};

/// [{degrees, reflected: [{order, radiance}], transmitted: [...]}]: radiance by order over that of
/// a white diffuse surface in the same light. Degrees from the normal, above 0 on the side that the
/// light goes to. By adding and doubling: orders 1, 2, 3+ and all.
nlohmann::ordered_json solver_views(const SlabViews& slab, unsigned streams);

/// By closed forms of one and two scatterings and one profile of `shares`[3] for the rest.
nlohmann::ordered_json model_views(const SlabViews& slab, const bake::OrderShares& shares);

/// By the table of a bake: orders 1, 2+ and all.
nlohmann::ordered_json table_views(const SlabViews& slab, const bake::RadianceTable& table);

/// A table of a media file or a phase function by its mean cosine, as a function of the angle.
bake::AngularTable angular_table(const formats::PhaseFunction& table);
bake::AngularTable henyey_greenstein_table(double g);

}  // namespace opaline::cli
