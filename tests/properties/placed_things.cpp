#include "tests/properties/placed_things.h"

#include <algorithm>
#include <cmath>

#include "formats/scene.h"
#include "tests/properties/meshes.h"

namespace opaline::tests {
namespace {

glm::dvec3 half_extent(const Thing& thing) {
    switch (thing.shape) {
        case Shape::quad:
        case Shape::triangle:
            return thing.size * glm::dvec3(1, 1, 0);
        case Shape::plate:
            return thing.size * glm::dvec3(1, 0.05, 1);
        case Shape::box:
        case Shape::ball:
        case Shape::cup:
        case Shape::shell:
            break;
    }
    return glm::dvec3(thing.size);
}

// From the centre of the thing before to its own.
glm::dvec3 step_between(const Thing& before, const Thing& thing) {
    const glm::dvec3 reach = half_extent(before) + half_extent(thing);
    const int a = thing.side % 3, b = (a + 1) % 3, c = (a + 2) % 3;
    const double sign = thing.side < 3 ? 1 : -1;
    glm::dvec3 step(0);
    switch (thing.place) {
        case Place::apart:
            step[a] = sign * (1.2 * reach[a] + 0.1 * thing.size);
            break;
        case Place::corner:
            step[c] = sign * reach[c];
            [[fallthrough]];
        case Place::edge:
            step[b] = sign * reach[b];
            [[fallthrough]];
        case Place::face:
            step[a] = sign * reach[a];
            break;
        case Place::overlap:
            step[a] = sign * 0.6 * reach[a];
            break;
        case Place::inside:
            step[a] = sign * 0.1 * before.size;
            break;
        case Place::same:
            break;
    }
    return step;
}

// A copy of the thing before.
PlacedThing copied(const PlacedThing& original, const Thing& copy) {
    PlacedThing thing = original;
    thing.place = copy.place;
    thing.side = copy.side;
    thing.mirrored = copy.mirrored;
    thing.size = copy.size;
    return thing;
}

}  // namespace

std::vector<PlacedThing> place_things(const std::vector<Thing>& things) {
    std::vector<PlacedThing> placed;
    for (std::size_t i = 0; i < things.size(); ++i) {
        const bool is_copy = things[i].kind == ThingKind::copy && i > 0;
        PlacedThing thing = is_copy ? copied(placed.back(), things[i]) : PlacedThing{things[i], i};
        if (thing.kind == ThingKind::copy) thing.kind = ThingKind::opaque;
        if (i > 0) {
            const PlacedThing& before = placed.back();
            if (thing.place == Place::inside) thing.size = 0.5 * before.size;
            if (thing.place == Place::same) thing.size = before.size;
            if (is_copy) {  // of the same medium
                const PlacedThing& source = placed[thing.source];
                thing.depth = source.depth * thing.size / source.size;
            }
            thing.at = before.at + step_between(before, thing);
        }
        placed.push_back(thing);
    }
    return placed;
}

bool is_body(const Thing& thing) {
    return thing.kind == ThingKind::medium || thing.kind == ThingKind::clear ||
           thing.kind == ThingKind::core;
}

bool is_at(const PlacedThing& thing, glm::dvec3 where) {
    const glm::dvec3 point = (where - thing.at) / thing.size;
    if (thing.kind == ThingKind::volume || thing.kind == ThingKind::glow ||
        thing.kind == ThingKind::bulb)
        return false;
    constexpr double kNear = 0.02;
    const double most = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    switch (thing.shape) {
        case Shape::ball:
            return glm::length(point) < 1 + kNear;
        case Shape::shell:
            return glm::length(point) < 1 + kNear && glm::length(point) > 0.6;
        case Shape::cup:
            return most < 1 + kNear &&
                   !(std::max(std::abs(point.x), std::abs(point.z)) < 0.9 - kNear &&
                     point.y > kNear - 0.9);
        case Shape::quad:
        case Shape::triangle:
            return most < 1 + kNear && std::abs(point.z) < kNear;
        case Shape::plate:
            return most < 1 + kNear && std::abs(point.y) < 0.05 + kNear;
        case Shape::box:
            break;
    }
    return most < 1 + kNear;
}

std::optional<double> index_around(const std::vector<PlacedThing>& things, std::size_t lamp) {
    double index = 1;
    bool is_outside = false, is_inside = false;
    const formats::Primitive mesh = make_mesh(things[lamp].shape);
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (!is_body(things[i])) continue;
        for (const glm::vec3 p : mesh.position) {
            const glm::dvec3 point = things[lamp].at + things[lamp].size * glm::dvec3(p);
            const bool is_in = is_at(things[i], point);
            (is_in ? is_inside : is_outside) = true;
            // Bodies smaller than the lamp may reach into it without a vertex of it in them.
            const glm::dvec3 apart = glm::abs(things[i].at - things[lamp].at);
            const double reach = things[i].size + things[lamp].size;
            if (!is_in && std::max({apart.x, apart.y, apart.z}) < 1.01 * reach &&
                things[i].size < things[lamp].size)
                is_inside = true;
        }
        if (is_inside && index != 1) return std::nullopt;
        if (is_inside) index = things[i].kind == ThingKind::core ? 0 : things[i].eta;
        if (is_inside && is_outside && index != 1) return std::nullopt;
        is_inside = is_outside = false;
    }
    if (index == 0 || (index != 1 && things[lamp].kind == ThingKind::glow)) return std::nullopt;
    return index;
}

bool loses_light_inside(const std::vector<PlacedThing>& things) {
    constexpr double kNear = 0.02, kDense = 3;
    for (std::size_t i = 0; i < things.size(); ++i) {
        for (std::size_t j = 0; j < things.size() && is_body(things[i]); ++j) {
            if (j == i || things[j].kind == ThingKind::lamp ||
                things[j].kind == ThingKind::volume || things[j].kind == ThingKind::glow)
                continue;
            const bool is_dense = things[i].kind == ThingKind::medium && things[i].depth > kDense;
            const bool are_clear =
                things[i].kind == ThingKind::clear && things[j].kind == ThingKind::clear;
            if (is_body(things[j]) && (is_dense || are_clear)) continue;
            const double near = (is_body(things[j]) ? kNear : -kNear) * things[i].size;
            const glm::dvec3 gap = glm::abs(things[i].at - things[j].at) - half_extent(things[i]) -
                                   half_extent(things[j]);
            if (std::max({gap.x, gap.y, gap.z}) < near) return true;
        }
    }
    return false;
}

}  // namespace opaline::tests
