#pragma once

#include <algorithm>
#include <cmath>

namespace opaline::bake {

/// What a unit of some work costs, by how many triangles there are [s of one thread]: measured on
/// two meshes; linear in the depth of the hierarchy, log2, between and beyond them.
struct CostBySize {
    static constexpr double kFew = 3072, kMany = 49152;  ///< triangles of the two meshes
    double few = 0, many = 0;

    /// `triangles` >= 0. Never less than a part of `few`: a mesh of one triangle is not free.
    double at(double triangles) const {
        constexpr double kLeastShare = 0.25;
        const double place = std::log2(std::max(triangles, 1.0) / kFew) / std::log2(kMany / kFew);
        return std::max(few + place * (std::max(many, few) - few), kLeastShare * few);
    }
};

/// What work costs on one machine, measured there (calibration.h): seconds of one thread per unit.
struct Rates {
    // Every bake.
    double plan_triangle = 0;    ///< the rules, per triangle of the scene
    double orient_triangle = 0;  ///< shells, per triangle of a medium
    CostBySize build_triangle;   ///< the ray hierarchy, per triangle
    CostBySize place_receiver;   ///< a vertex's clearance, and whether it is hidden
    double test_lights = 0;      ///< all of them
    // Rows.
    CostBySize coherent_ray;   ///< one of a receiver's packets over the cube map, its cosine too
    double open_cell = 0;      ///< the cosine of such a ray's cell where nothing can be hit
    double encode_grey = 0;    ///< transform, selection and quantising, per texel of a row
    double encode_colour = 0;  ///< selection and quantising of three bands, transformed already
    CostBySize openness;       ///< of a receiver
    // Multiple scattering.
    double walk_event = 0;      ///< of a half space's random walk
    double place_sample = 0;    ///< blue noise, per sample
    CostBySize shared_texel;    ///< what a sample sees, per texel: rays shared in a group
    double truncate_texel = 0;  ///< transform and truncation, per texel of a sample
    double sum_entry = 0;       ///< one entry of a sample into the sum of a node
    double take_weight = 0;  ///< a node or sample found to be taken whole, with those that were not
    double gather_entry = 0;  ///< one entry of a node or sample into a receiver's row
    // Single scattering.
    CostBySize body_triangle;  ///< of the mesh that light maps draw
    double draw_triangle = 0;  ///< into a light map
    double draw_pixel = 0;     ///< of a light map, to clear and fill
    CostBySize place_nodes;    ///< the way inward of a receiver
    CostBySize look_up;        ///< of a node in a light map, those included that rays must find out
    double look_up_term = 0;   ///< each term beyond the first of a look-up
    double unpack_texel = 0;   ///< from packed rows into a receiver's, per term
    CostBySize entry_packet;   ///< sixteen rays out of a body, and what enters along them
    // The self-check.
    double split_triangle = 0;  ///< of the surface integral
    CostBySize surface_point;   ///< of the surface integral: its rays to all lights

    /// How many times slower each thread is when all of the machine's are at work.
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
    by_size("body_triangle_few", "body_triangle_many", rates.body_triangle);
    visit("draw_triangle", rates.draw_triangle);
    visit("draw_pixel", rates.draw_pixel);
    by_size("place_nodes_few", "place_nodes_many", rates.place_nodes);
    by_size("look_up_few", "look_up_many", rates.look_up);
    visit("look_up_term", rates.look_up_term);
    visit("unpack_texel", rates.unpack_texel);
    by_size("entry_packet_few", "entry_packet_many", rates.entry_packet);
    visit("split_triangle", rates.split_triangle);
    by_size("surface_point_few", "surface_point_many", rates.surface_point);
    visit("crowding", rates.crowding);
}

}  // namespace opaline::bake
