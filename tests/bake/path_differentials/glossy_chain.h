#pragma once

#include <optional>

#include "bake/path_differentials/axis_frame.h"
#include "bake/path_differentials/lobe.h"
#include "bake/path_differentials/smooth_event.h"
#include "bake/path_differentials/surface_shape.h"
#include "tests/bake/path_differentials/camera_start.h"
#include "tests/bake/path_differentials/path_gradient.h"
#include "tests/bake/path_differentials/primal.h"
#include "tests/bake/path_differentials/table_case.h"
#include "tests/bake/path_differentials/transfer.h"

namespace opaline::tests {

/// Eye, glossy sphere, floor: the pixel's x and y move the ray by (x, y, -1), u and v choose the
/// direction of a Phong lobe.
struct GlossyChain {
    glm::dvec3 eye{0}, center{0};
    double radius = 1, exponent = 1, floor = 0;
};

struct ChainPoint {
    double x = 0, y = 0, u = 0.5, v = 0.5;
};

/// Turns v as the shortest turn from one unit vector to another does, not the opposite one.
inline glm::dvec3 turned_along(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& v) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double c = glm::dot(from, to);
    return c * v + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + c));
}

/// The vertices, and the relative contribution, by the events' raw columns. The frame of the lobe
/// is that of the axis, or that of another one, `reference`, turned along: then paths nearby do not
/// spin around it.
inline NamedValues chain_outputs(const GlossyChain& chain, const ChainPoint& at,
                                 std::optional<glm::dvec3> reference = {}) {
    using namespace opaline::bake;
    const CameraStart start =
        start_at_pinhole({chain.eye, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, at.x, at.y);
    const double t1 = sphere_distance<double>(start.P, start.D, chain.center, chain.radius);
    const glm::dvec3 P1 = start.P + t1 * start.D;
    const SurfaceShape sphere = sphere_shape(chain.center, chain.radius, P1);
    const Mirror mirror = make_mirror(start.D, sphere.N);
    const LobeDirection lobe =
        sample_lobe({Lobe::Kind::power, chain.exponent}, DiskMap::polar, at.u, at.v);
    glm::dmat3 frame = frame_around(reference.value_or(mirror.reflected));
    for (int i = 0; reference && i < 3; ++i) {
        frame[i] = turned_along(*reference, mirror.reflected, frame[i]);
    }
    const glm::dvec3 D1 = frame * lobe.D, up(0, 1, 0);
    const double t2 = plane_distance<double>(P1, D1, up, glm::dvec3(0, chain.floor, 0));
    NamedValues out{
        {"P1", listed(P1)}, {"P2", listed(P1 + t2 * D1)}, {"R", listed(mirror.reflected)}};
    out["lnW"] = listed(chain.exponent * std::log(lobe.D.z) + std::log(glm::dot(sphere.N, D1)));
    const auto add = [&](const std::string& name, const glm::dvec3& dP1, const glm::dvec3& dN,
                         const glm::dvec3& dD1, double dln_lobe) {
        out["dP1_" + name] = listed(dP1);
        out["dP2_" + name] = listed(transfer_to_plane(D1, up, t2, dP1, dD1).dP);
        out["dlnW_" + name] = listed(dln_lobe + dln_cosine(sphere.N, D1, dN, dD1));
    };
    const auto add_pixel = [&](const std::string& name, const glm::dvec3& dD) {
        const glm::dvec3 dP1 = transfer_to_plane(start.D, sphere.N, t1, glm::dvec3(0), dD).dP;
        const glm::dvec3 dN = sphere.dN_dP * dP1, dR = mirror.change(dD, dN);
        const glm::dvec3 carried = carry_with_axis(mirror.reflected, dR, D1);
        add(name, dP1, dN, carried, 0);
        const auto moving = branchless_frame(moved(mirror.reflected, dR, Dual(0, 1)));
        const double spin = glm::dot(frame[1], changes(moving[0]));
        const glm::dvec3 spun = carried + spin * glm::cross(mirror.reflected, D1);
        out["dP2_" + name + "_with_spin"] = listed(transfer_to_plane(D1, up, t2, dP1, spun).dP);
    };
    add_pixel("x", start.dD_dx);
    add_pixel("y", start.dD_dy);
    add("u", glm::dvec3(0), glm::dvec3(0), frame * lobe.dD_du, lobe.dln_pdf_du);
    add("v", glm::dvec3(0), glm::dvec3(0), frame * lobe.dD_dv, lobe.dln_pdf_dv);
    return out;
}

}  // namespace opaline::tests
