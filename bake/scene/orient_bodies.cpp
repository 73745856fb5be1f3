#include "bake/scene/orient_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "bake/scene/body_shells.h"
#include "bake/scene/cancel_flaps.h"
#include "bake/scene/coverage.h"
#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// volume / area^1.5 is 0.094 for a sphere and about 0 for a sheet.
bool has_volume(const BodyShell& shell) {
    constexpr double kLeastVolume = 1e-3;
    return std::abs(shell.volume) > kLeastVolume * std::pow(shell.area, 1.5);
}

using Corners = std::array<glm::dvec3, 3>;

// Stores the triangles of a shell contiguously, because each is read many times.
std::vector<Corners> corners_of(const BodyShells& body, const BodyShell& shell) {
    std::vector<Corners> triangles;
    triangles.reserve(shell.count);
    for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
        triangles.push_back(corners(body, body.triangle[body.order[i]]));
    }
    return triangles;
}

// True if a shell encloses the point: seen from there, its solid angle is the whole sphere.
bool encloses(const std::vector<Corners>& shell, glm::dvec3 point) {
    double angle = 0;
    for (const Corners& corner : shell) {
        const glm::dvec3 a = corner[0] - point, b = corner[1] - point, c = corner[2] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la +
                                                                   glm::dot(c, a) * lb);
    }
    return std::abs(angle) > 2 * std::numbers::pi;
}

// The shells inside `outer` whose direction can depend on it: if both face outward by themselves,
// neither changes. `work_left` bounds the time for a hostile mesh; once it is used up, the bounding
// box decides.
std::vector<std::uint32_t> shells_within(const BodyShells& body, const BodyShell& outer,
                                         std::uint64_t& work_left) {
    std::vector<std::uint32_t> within;
    std::vector<Corners> triangles;
    for (std::uint32_t s = 0; s < body.shell.size(); ++s) {
        const BodyShell& inner = body.shell[s];
        if (outer.volume > 0 && (inner.volume > 0 || !has_volume(inner))) continue;
        if (&inner == &outer || !glm::all(glm::greaterThanEqual(inner.low, outer.low)) ||
            !glm::all(glm::lessThanEqual(inner.high, outer.high))) {
            continue;
        }
        if (work_left >= outer.count) {
            work_left -= outer.count;
            if (triangles.empty()) {
                triangles = corners_of(body, outer);
            }
            if (!encloses(triangles,
                          body.position[body.triangle[body.order[inner.first]].point[0]])) {
                continue;
            }
        }
        within.push_back(s);
    }
    return within;
}

void turn(BodyShells& body, const BodyShell& shell) {
    for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
        BodyTriangle& t = body.triangle[body.order[i]];
        t.turned = !t.turned;
    }
}

// Outermost shells must enclose a positive volume. Inner shells turn with them.
void turn_shells_outward(BodyShells& body) {
    std::uint64_t work_left = 100'000'000;  // a second or two
    std::vector<std::uint32_t> by_size(body.shell.size());
    for (std::uint32_t s = 0; s < by_size.size(); ++s) {
        by_size[s] = s;
    }
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::abs(body.shell[a].volume) > std::abs(body.shell[b].volume);
    });
    for (const std::uint32_t s : by_size) {
        const BodyShell& shell = body.shell[s];
        if (shell.inside || !has_volume(shell)) continue;
        // Most bodies are one shell, or separate shells that face outward.
        if (body.shell.size() > 1) {
            for (const std::uint32_t inner : shells_within(body, shell, work_left)) {
                body.shell[inner].inside = true;
                if (shell.volume < 0) {
                    turn(body, body.shell[inner]);
                }
            }
        }
        if (shell.volume < 0) {
            turn(body, shell);
        }
    }
}

// Flips vertex normals of turned triangles that now point to the back.
void turn_normals(const BodyShells& body, Scene& scene) {
    std::vector<std::vector<glm::dvec3>> facing(scene.primitives.size());
    for (const BodyTriangle& t : body.triangle) {
        if (t.turned) {
            const Primitive& p = scene.primitives[t.primitive];
            facing[t.primitive].resize(p.position.size(), glm::dvec3(0));
            for (std::uint32_t k = 0; k < 3; ++k) {
                facing[t.primitive][p.index[t.first_index + k]] += area_vector(body, t);
            }
        }
    }
    for (std::size_t p = 0; p < facing.size(); ++p) {
        std::vector<glm::vec3>& normal = scene.primitives[p].normal;
        std::vector<glm::vec4>& tangent = scene.primitives[p].tangent;
        for (std::size_t v = 0; v < facing[p].size(); ++v) {
            if (glm::dot(facing[p][v], glm::dvec3(normal[v])) < 0) {
                normal[v] = -normal[v];
                if (!tangent.empty()) tangent[v] = -tangent[v];  // and its sign: bitangents, too
            }
        }
    }
}

// What the result may change of the scene.
Scene& changed(const Scene& given, OrientedBodies& result) {
    if (!result.scene) {
        result.scene = given;
    }
    return *result.scene;
}

const Scene& latest(const Scene& given, const OrientedBodies& result) {
    return result.scene ? *result.scene : given;
}

// Gives the scene the direction of the body's triangles. Returns how many are turned.
std::uint64_t apply_turns(const BodyShells& body, const Scene& given, OrientedBodies& result) {
    std::uint64_t turned = 0;
    for (const BodyTriangle& t : body.triangle) {
        if (t.turned) {
            std::vector<std::uint32_t>& index =
                changed(given, result).primitives[t.primitive].index;
            std::swap(index[t.first_index + 1], index[t.first_index + 2]);
            ++turned;
        }
    }
    if (turned > 0) {
        turn_normals(body, *result.scene);
    }
    return turned;
}

std::vector<bool> choose_materials(const Scene& scene,
                                   bool (*wants)(const formats::Material& material)) {
    std::vector<bool> chosen;
    for (const formats::Material& material : scene.materials) {
        chosen.push_back(wants(material));
    }
    return chosen;
}

bool is_double_sided_opaque(const formats::Material& material) {
    return material.double_sided && !material.medium && !material.sheet;
}

// Places of a thing that may lie inside a closed shell.
using PlacesOfThing = std::vector<glm::dvec3>;

// Of each shell, other primitive and light; the shells come first.
std::vector<PlacesOfThing> find_things(const Scene& scene, const std::vector<bool>& chosen,
                                       const BodyShells& body) {
    constexpr std::size_t kPlaces = 16;  // of a thing, about
    std::vector<PlacesOfThing> things;
    for (const BodyShell& shell : body.shell) {
        PlacesOfThing& places = things.emplace_back();
        for (std::size_t i = 0; i < shell.count; i += 1 + shell.count / kPlaces) {
            const BodyTriangle& t = body.triangle[body.order[shell.first + i]];
            for (const std::uint32_t point : t.point) {
                places.emplace_back(body.position[point]);
            }
        }
    }
    for (const Primitive& p : scene.primitives) {
        if (chosen[p.material] || p.position.empty()) continue;
        PlacesOfThing& places = things.emplace_back();
        for (std::size_t v = 0; v < p.position.size(); v += 1 + p.position.size() / kPlaces) {
            places.emplace_back(p.position[v]);
        }
    }
    for (const formats::Light& light : scene.lights) {
        if (light.type != formats::Light::Type::directional) things.push_back({light.position});
    }
    return things;
}

// All of it: a leg that ends in a table's top leaves the top's inside unseen.
bool has_something_inside(const BodyShells& body, const BodyShell& shell,
                          const std::vector<PlacesOfThing>& things, std::uint64_t& work_left) {
    constexpr std::uint64_t kBoxes = 8;  // tests that take as long as one of a triangle
    const std::uint64_t boxes = things.size() / kBoxes;
    if (work_left < boxes) return true;  // two sides are right in any case
    work_left -= boxes;
    std::vector<Corners> triangles;
    const auto is_inside = [&](glm::dvec3 place) {
        if (!glm::all(glm::greaterThan(place, shell.low)) ||
            !glm::all(glm::lessThan(place, shell.high))) {
            return false;
        }
        if (work_left < shell.count) return true;
        work_left -= shell.count;
        if (triangles.empty()) triangles = corners_of(body, shell);
        return encloses(triangles, place);
    };
    const auto own = static_cast<std::size_t>(&shell - body.shell.data());
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (i != own && std::ranges::all_of(things[i], is_inside)) return true;
    }
    return false;
}

// Viewers light and show both sides of a double-sided surface. Of a closed one with nothing inside
// only the outside can be seen: it has the row, whichever way the faces point. A material of such
// alone has one side, so that what ends in them counts as hidden.
void settle_double_sided(const Scene& given, OrientedBodies& result) {
    const std::vector<bool> chosen = choose_materials(given, is_double_sided_opaque);
    if (std::ranges::find(chosen, true) == chosen.end()) return;
    BodyShells body = make_body_shells(latest(given, result), chosen);
    const std::vector<PlacesOfThing> things = find_things(given, chosen, body);
    std::vector<bool> has_two_sides(chosen.size(), false), is_closed(chosen.size(), false);
    std::uint64_t work_left = 100'000'000;  // a second or two
    for (const BodyShell& shell : body.shell) {
        const auto material_of = [&](std::uint32_t i) {
            return given.primitives[body.triangle[body.order[i]].primitive].material;
        };
        bool is_whole = !shell.is_open;
        for (std::uint32_t i = shell.first; is_whole && i < shell.first + shell.count; ++i) {
            is_whole = !has_holes(given.materials[material_of(i)]);
        }
        if (is_whole && !has_something_inside(body, shell, things, work_left)) {
            if (has_volume(shell) && shell.volume < 0) turn(body, shell);
            for (std::uint32_t i = 0; has_volume(shell) && i < shell.count; ++i) {
                is_closed[material_of(shell.first + i)] = true;
            }
            continue;
        }
        for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
            body.triangle[body.order[i]].turned = false;
            has_two_sides[material_of(i)] = true;
        }
    }
    apply_turns(body, given, result);
    for (std::size_t m = 0; m < has_two_sides.size(); ++m) {
        if (has_two_sides[m]) {
            changed(given, result).materials[m].sheet.emplace();
        } else if (is_closed[m]) {
            changed(given, result).materials[m].double_sided = false;
        }
    }
}

}  // namespace

OrientedBodies orient_bodies(const Scene& scene) {
    OrientedBodies result;
    for (WeldedVertices& welded :
         weld_seams(scene, choose_materials(scene, [](const formats::Material& material) {
                        return material.medium || is_double_sided_opaque(material);
                    }))) {
        changed(scene, result).primitives[welded.primitive].position = std::move(welded.position);
    }
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (!scene.materials[m].medium) continue;
        const Flaps flaps = find_flaps(latest(scene, result), m);
        if (flaps.pairs + flaps.repeats > 0) {
            remove_flaps(flaps, changed(scene, result));
        }
        BodyShells body = make_body_shells(latest(scene, result), m);
        if (body.triangle.empty()) continue;
        turn_shells_outward(body);
        BodySurface surface{m, 0, body.open_edges, flaps.pairs, flaps.repeats};
        surface.turned = apply_turns(body, scene, result);
        result.surfaces.push_back(surface);
    }
    settle_double_sided(scene, result);
    return result;
}

std::vector<formats::Diagnostic> describe_faults(const Scene& scene,
                                                 const std::vector<BodySurface>& surfaces) {
    std::vector<formats::Diagnostic> warnings;
    for (const BodySurface& surface : surfaces) {
        const std::string where = "material '" + scene.materials[surface.material].name + "'";
        if (surface.turned > 0) {
            warnings.push_back(formats::make_warning(
                scene.source, where,
                std::to_string(surface.turned) +
                    " triangles of the medium's surface face into it; they were turned outward",
                "make all faces point outward"));
        }
        if (surface.flaps > 0) {
            warnings.push_back(formats::make_warning(
                scene.source, where,
                "pairs of triangles that lie on one another and face opposite ways bound nothing "
                "and were left out: " +
                    std::to_string(surface.flaps),
                "remove such pairs, or give the part a thickness"));
        }
        if (surface.repeats > 0) {
            warnings.push_back(formats::make_warning(
                scene.source, where,
                std::to_string(surface.repeats) +
                    " triangles of the medium's surface lie on others and face the same way; they "
                    "were left out",
                "remove faces and objects that are there twice"));
        }
        if (surface.open_edges > 0) {
            warnings.push_back(formats::make_warning(
                scene.source, where,
                "the surface of the medium is open at " + std::to_string(surface.open_edges) +
                    " edges: light that scatters once is missing where it would enter or leave "
                    "through the holes, and by the dipole light that scatters many times is that "
                    "of a thick body",
                "close the surface"));
        }
    }
    return warnings;
}

}  // namespace opaline::bake
