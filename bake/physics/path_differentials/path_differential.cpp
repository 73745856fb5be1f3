#include "bake/physics/path_differentials/path_differential.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "bake/physics/path_differentials/axis_frame.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kMergeAbove = 6;
constexpr int kLimitedFrom = 2;  // with one glossy event, steps tile its lobe

double path_step(const PathDifferential& path, const DifferentialRules& rules) {
    return global_step(rules.samples, path.variables, path.survival);
}

/// step_j dP_j in the frame's first two axes, at most a quarter of the scene long.
std::array<glm::dvec2, PathDifferential::kMost> tangent_vectors(const PathDifferential& path,
                                                                const DifferentialRules& rules,
                                                                const glm::dmat3& frame) {
    std::array<glm::dvec2, PathDifferential::kMost> vectors{};
    for (std::size_t i = 0; i < path.count; ++i) {
        const DifferentialColumn& column = path.column[i];
        const glm::dvec3 v = column_step(path, rules, column) * column.dP;
        const double longest = rules.extent / 4, length = glm::length(v);
        vectors[i] = glm::dvec2(glm::dot(frame[0], v), glm::dot(frame[1], v)) *
                     (length > longest ? longest / length : 1);
    }
    return vectors;
}

double tangent_area(const PathDifferential& path, const DifferentialRules& rules,
                    const glm::dmat3& frame) {
    const auto vectors = tangent_vectors(path, rules, frame);
    return polygon_area(std::span(vectors).first(path.count));
}

void merge_above(PathDifferential& path, const DifferentialRules& rules, const MergeSpace& space) {
    if (path.count <= kMergeAbove) return;
    const glm::dmat3 frame = frame_around(space.N_g.value_or(space.D));
    const double before = tangent_area(path, rules, frame);
    const double step = path_step(path, rules);
    std::array<double, PathDifferential::kMost> steps{};
    for (std::size_t i = 0; i < path.count; ++i) {
        steps[i] = path.column[i].step * step;
    }
    path.count = merge_columns(path.columns(), std::span(steps).first(path.count), space);
    for (DifferentialColumn& column : path.columns()) {
        column.step = 1 / step;  // the path's later step over the one that is merged
    }
    const double after = tangent_area(path, rules, frame);
    path.polygon_scale *= before > 0 && after > 0 ? std::sqrt(before / after) : 1;
}

void add_direction(PathDifferential& path, const DifferentialColumn& du,
                   const DifferentialColumn& dv) {
    add_variable(path, du);
    add_variable(path, dv);
    ++path.scatterings;
}

/// Step of the two columns that are about to be added.
double step_to_come(const PathDifferential& path, const DifferentialRules& rules) {
    return global_step(rules.samples, path.variables + 2, path.survival);
}

}  // namespace

double global_step(double samples, int variables, double survival) {
    return variables > 0 ? std::min(1.0, std::pow(samples * survival, -1.0 / variables)) : 1.0;
}

void add_variable(PathDifferential& path, const DifferentialColumn& column) {
    assert(path.count < PathDifferential::kMost);
    path.column[path.count++] = column;
    ++path.variables;
}

double column_step(const PathDifferential& path, const DifferentialRules& rules,
                   const DifferentialColumn& column) {
    const double step = column.step * path_step(path, rules), change = std::abs(column.dlnW);
    return path.scatterings >= kLimitedFrom && change * step > rules.gradient_limit
               ? rules.gradient_limit / change
               : step;
}

void move_to_surface(PathDifferential& path, const glm::dvec3& D, const glm::dvec3& N_g, double t) {
    for (DifferentialColumn& column : path.columns()) {
        column.dP = bounded_transfer(D, N_g, t, column.dP, column.dD);
    }
}

void reflect_columns(PathDifferential& path, const Mirror& event, const glm::dmat3& dN_dP) {
    for (DifferentialColumn& column : path.columns()) {
        column.dD = event.change(column.dD, dN_dP * column.dP);
    }
}

void refract_columns(PathDifferential& path, const DifferentialRules& rules,
                     const Refraction& event, const glm::dmat3& dN_dP) {
    for (DifferentialColumn& column : path.columns()) {
        const double step = column_step(path, rules, column);
        column.dD = bounded_refraction(event, column.dD, dN_dP * column.dP, step);
    }
}

void aim_at_normal(PathDifferential& path, const glm::dmat3& dN_dP) {
    for (DifferentialColumn& column : path.columns()) {
        column.dD = dN_dP * column.dP;
    }
}

glm::dvec3 scatter_in_lobe(PathDifferential& path, const DifferentialRules& rules,
                           const LobeEvent& event) {
    const LobeDirection sample =
        secant_of_lobe(event.lobe, event.u, event.v, step_to_come(path, rules));
    const glm::dmat3 frame = frame_around(event.axis);
    const glm::dvec3 direction = frame * sample.D;
    for (DifferentialColumn& column : path.columns()) {
        column.dD = carry_with_axis(event.axis, column.dD, direction);
    }
    merge_above(path, rules, {direction, event.N_g});
    add_direction(path, {glm::dvec3(0), frame * sample.dD_du, sample.dln_pdf_du},
                  {glm::dvec3(0), frame * sample.dD_dv, sample.dln_pdf_dv});
    return direction;
}

std::optional<glm::dvec3> scatter_on_facets(PathDifferential& path, const DifferentialRules& rules,
                                            const FacetEvent& event) {
    const glm::dmat3 frame = frame_around(event.N), to_frame = glm::transpose(frame);
    const glm::dvec3 w_i = to_frame * -event.D;
    const VisibleNormal facet =
        sample_visible_normal(w_i, {event.alpha, event.alpha}, event.u, event.v);
    const Mirror mirror = make_mirror(-w_i, facet.m);
    const bool refracts = event.eta > 0;
    const auto refraction = refracts ? make_refraction(-w_i, facet.m, event.eta) : std::nullopt;
    if (refracts && !refraction) return std::nullopt;
    const glm::dvec3 w_o = refracts ? refraction->refracted : mirror.reflected;
    if (refracts ? !(w_o.z < 0) : !(w_o.z > 0)) return std::nullopt;
    const auto change = [&](const glm::dvec3& dw_i, const glm::dvec3& dm, double step) {
        return refracts ? bounded_refraction(*refraction, -dw_i, dm, step)
                        : mirror.change(-dw_i, dm);
    };
    const glm::dvec3 direction = frame * w_o;
    for (DifferentialColumn& column : path.columns()) {
        // The frame turns with its normal: what is fixed in it moves by turn x.
        const glm::dvec3 turn = glm::cross(event.N, event.dN_dP * column.dP);
        const glm::dvec3 dw_i = to_frame * (glm::cross(turn, event.D) - column.dD);
        const double step = column_step(path, rules, column);
        column.dD = frame * change(dw_i, facet.dm_dwi * dw_i, step) + glm::cross(turn, direction);
    }
    merge_above(path, rules, {direction, event.N_g});
    const auto own = [&](const glm::dvec3& dm) {
        const double step = step_to_come(path, rules);
        const glm::dvec3 dD = frame * change(glm::dvec3(0), dm, step);
        return DifferentialColumn{glm::dvec3(0), bounded_direction(dD, step)};
    };
    add_direction(path, own(facet.dm_du), own(facet.dm_dv));
    return direction;
}

SurfaceFootprint surface_footprint(const PathDifferential& path, const DifferentialRules& rules,
                                   const glm::dvec3& N_g, FootprintMode mode) {
    const glm::dmat3 frame = frame_around(N_g);
    const auto all = tangent_vectors(path, rules, frame);
    const std::span<const glm::dvec2> vectors = std::span(all).first(path.count);
    const bool is_polygon = mode == FootprintMode::polygon;
    const FootprintPair pair = is_polygon ? polygon_pair(vectors) : rms_pair(vectors);
    const double major = pair_extent(pair).major, longest = rules.extent / 4;
    const double wanted = is_polygon ? path.polygon_scale : 1;
    const double scale = major * wanted > longest ? longest / major : wanted;
    const FootprintPair scaled{scale * pair.A, scale * pair.B};
    return {frame * glm::dvec3(scaled.A, 0), frame * glm::dvec3(scaled.B, 0), pair_area(scaled),
            pair_extent(scaled)};
}

}  // namespace opaline::bake
