#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/trace/bodies_at.h"
#include "bake/trace/medium_stack.h"

namespace opaline::bake {

/// A straight flight that ends at a triangle of a body.
struct BodyArrival {
    glm::vec3 from{0}, direction{0};  ///< [m]; unit
    float way = 0;                    ///< [m]
    glm::vec3 position{0};            ///< [m], on the triangle
    glm::vec3 flat{0};                ///< unit normal of the triangle, outward by its winding
    float error = 0;                  ///< [m], bound on that of the position
    float u = 0, v = 0;               ///< weights of its second and third corner
    std::uint16_t place = 0;          ///< of the body's material: MediumStack
};

/// What lies beyond a surface that a flight has met.
struct FarSide {
    MediumStack bodies;
    float side = 1;           ///< where the triangle's normal points along the flight, else -1
    float lift = 0;           ///< [m], clear of the surface
    bool has_room = true;     ///< false: it lies in more materials than a stack holds
    bool is_several = false;  ///< several faces lie there on one another
};

/// No body of these materials is followed.
inline constexpr std::uint16_t kNoPlace = 0xffff;

/// The bodies around a point, in places of their materials, by material.
MediumStack bodies_around(const BodiesAt& bodies, std::span<const std::uint16_t> place_of,
                          glm::vec3 point);

/// The same just below the surface of a body of the place `own`; that alone where edges hide it.
MediumStack bodies_at_start(const BodiesAt& bodies, std::span<const std::uint16_t> place_of,
                            std::uint16_t own, glm::vec3 point);

/// `before`: the bodies around the flight. `meeting`: null where no surfaces of bodies touch or
/// cross; else faces that lie on one another are crossed as one, and where there are several, at an
/// edge, or where the flight leaves what it was not in, the bodies beyond are counted anew, in the
/// middle of the way to the next surface. `rays` counts up.
FarSide find_far_side(const BodiesAt* meeting, std::span<const std::uint16_t> place_of,
                      const MediumStack& before, const BodyArrival& arrival, std::uint64_t& rays);

/// Share of light that passes a smooth boundary. `ratio`: index beyond it over that before it.
float boundary_transmittance(float cosine, float ratio);

/// Between two indices whose quotient is that, light neither bends nor is reflected.
bool is_matched(float ratio);

/// How light goes on at a smooth surface between two media.
struct Bend {
    glm::vec3 reflected{0}, refracted{0};  ///< unit
    float passed = 0;                      ///< share of the latter
};

/// By the normal `smooth`, unless it sends light to the wrong side of the facet, whose normal is
/// `flat`; both unit, `flat` along `direction`. `ratio`: index beyond over that before, not 1.
Bend bend_at(glm::vec3 smooth, glm::vec3 flat, glm::vec3 direction, float ratio);

}  // namespace opaline::bake
