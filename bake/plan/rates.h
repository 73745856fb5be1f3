#pragma once

#include <algorithm>
#include <cmath>

namespace opaline::bake {

/// Seconds of one thread per unit of work as a function of the number of triangles: measured on two
/// meshes, linear in log2 of the number (the depth of the hierarchy) between and beyond them.
struct CostBySize {
    static constexpr double kFew = 3072, kMany = 49152;  ///< triangles of the two meshes
    double few = 0, many = 0;

    /// `triangles` >= 0. Never less than a fraction of `few`, because a mesh of one triangle has a
    /// cost too.
    double at(double triangles) const {
        constexpr double kLeastShare = 0.25;
        const double place = std::log2(std::max(triangles, 1.0) / kFew) / std::log2(kMany / kFew);
        return std::max(few + place * (std::max(many, few) - few), kLeastShare * few);
    }
};

/// Seconds of one thread per unit of work, measured on this machine (calibration.h).
struct Rates {
    // Every bake.
    double plan_triangle = 0;    ///< the rules, per triangle of the scene
    double orient_triangle = 0;  ///< shells, per triangle of a medium
    CostBySize build_triangle;   ///< the ray hierarchy, per triangle
    CostBySize place_receiver;   ///< a vertex's clearance, and whether it is hidden
    double test_lights = 0;      ///< all of them
    // Rows.
    CostBySize coherent_ray;   ///< a ray of a receiver's packets over the cube map, cosine included
    double open_cell = 0;      ///< the cosine of such a ray's cell in an empty scene
    double encode_grey = 0;    ///< transform, selection and quantising, per texel of a row
    double encode_colour = 0;  ///< selection and quantising of three bands, transformed already
    CostBySize openness;       ///< of a receiver
    // Multiple scattering.
    double walk_event = 0;      ///< of a half space's random walk
    double place_sample = 0;    ///< blue noise, per sample
    CostBySize shared_texel;    ///< irradiance of a sample, per texel, with shared rays
    double truncate_texel = 0;  ///< transform and truncation, per texel of a sample
    double sum_entry = 0;       ///< one entry of a sample into the sum of a node
    double take_weight = 0;     ///< per accepted node or sample, traversal included
    double gather_entry = 0;    ///< one entry of a node or sample into a receiver's row
    CostBySize body_event;      ///< of a random walk through a body: a flight and what ends it
    double walk_exit = 0;       ///< the sample at a walk's exit
    double site_weight = 0;     ///< of a site around a receiver, the fit included
    CostBySize first_flight;    ///< of a receiver, with all its views
    CostBySize inner_site;      ///< of a site inside, in view of a receiver, the fit included
    // Single scattering.
    CostBySize body_triangle;  ///< of the mesh that light maps draw
    double draw_triangle = 0;  ///< into a light map
    double draw_pixel = 0;     ///< of a light map, to clear and fill
    CostBySize place_nodes;    ///< the inward path of a receiver
    CostBySize look_up;        ///< of a node in a light map, rays for undecided nodes included
    double look_up_term = 0;   ///< each term beyond the first of a look-up
    double unpack_texel = 0;   ///< from packed rows into a receiver's, per term
    CostBySize entry_packet;   ///< sixteen rays out of a body, with their entries
    // Light between surfaces.
    CostBySize bounce_ray;   ///< to the nearest surface, and the cluster that it meets
    double bounce_cell = 0;  ///< one number of a cluster into a receiver's row
    // Light that crosses bodies unscattered.
    CostBySize straight_view;  ///< a view through a body: its flights, and rays beyond its exits
    double straight_cell = 0;  ///< a texel of one row and band, and half an exit's share of one
    // Volumes.
    double density_step = 0;      ///< of an optical depth through one volume
    double volume_flight = 0;     ///< of a walk: to a collision, and the direction after it
    double scattered_cell = 0;    ///< light of one direction and band that joins a walk there
    double node_texel = 0;        ///< of a node's row: transform, selection and quantising
    double traced_collision = 0;  ///< of a path of the reference, its light included
    // Cloud layers.
    double series_term = 0;       ///< of a sphere's series, at one angle
    double flux_product = 0;      ///< a multiplication of the adding of slabs, for fluxes
    double radiance_product = 0;  ///< the same for radiance
    // The self-check.
    double split_triangle = 0;  ///< of the surface integral
    CostBySize surface_point;   ///< of the surface integral: its rays to all lights

    /// Slow-down of a thread when all threads of the machine work.
    double crowding = 1;
};

/// Calls `visit(name, double&)` for every number of `rates`, which may be const.
template <class AnyRates, class Visit>
void visit_rates(AnyRates&& rates, Visit&& visit) {
    const auto by_size = [&](const char* few, const char* many, auto& cost) {
        visit(few, cost.few);
        visit(many, cost.many);
    };
    visit("plan_triangle", rates.plan_triangle);
    visit("orient_triangle", rates.orient_triangle);
    by_size("build_triangle_few", "build_triangle_many", rates.build_triangle);
    by_size("place_receiver_few", "place_receiver_many", rates.place_receiver);
    visit("test_lights", rates.test_lights);
    by_size("coherent_ray_few", "coherent_ray_many", rates.coherent_ray);
    visit("open_cell", rates.open_cell);
    visit("encode_grey", rates.encode_grey);
    visit("encode_colour", rates.encode_colour);
    by_size("openness_few", "openness_many", rates.openness);
    visit("walk_event", rates.walk_event);
    visit("place_sample", rates.place_sample);
    by_size("shared_texel_few", "shared_texel_many", rates.shared_texel);
    visit("truncate_texel", rates.truncate_texel);
    visit("sum_entry", rates.sum_entry);
    visit("take_weight", rates.take_weight);
    visit("gather_entry", rates.gather_entry);
    by_size("body_event_few", "body_event_many", rates.body_event);
    visit("walk_exit", rates.walk_exit);
    visit("site_weight", rates.site_weight);
    by_size("first_flight_few", "first_flight_many", rates.first_flight);
    by_size("inner_site_few", "inner_site_many", rates.inner_site);
    by_size("body_triangle_few", "body_triangle_many", rates.body_triangle);
    visit("draw_triangle", rates.draw_triangle);
    visit("draw_pixel", rates.draw_pixel);
    by_size("place_nodes_few", "place_nodes_many", rates.place_nodes);
    by_size("look_up_few", "look_up_many", rates.look_up);
    visit("look_up_term", rates.look_up_term);
    visit("unpack_texel", rates.unpack_texel);
    by_size("entry_packet_few", "entry_packet_many", rates.entry_packet);
    by_size("bounce_ray_few", "bounce_ray_many", rates.bounce_ray);
    visit("bounce_cell", rates.bounce_cell);
    by_size("straight_view_few", "straight_view_many", rates.straight_view);
    visit("straight_cell", rates.straight_cell);
    visit("density_step", rates.density_step);
    visit("volume_flight", rates.volume_flight);
    visit("scattered_cell", rates.scattered_cell);
    visit("node_texel", rates.node_texel);
    visit("traced_collision", rates.traced_collision);
    visit("series_term", rates.series_term);
    visit("flux_product", rates.flux_product);
    visit("radiance_product", rates.radiance_product);
    visit("split_triangle", rates.split_triangle);
    by_size("surface_point_few", "surface_point_many", rates.surface_point);
    visit("crowding", rates.crowding);
}

}  // namespace opaline::bake
