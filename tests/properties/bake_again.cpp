#include "tests/properties/bake_again.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "formats/opal/atomic_file.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/write_opal.h"
#include "formats/scene.h"
#include "tests/properties/shown.h"
#include "tests/properties/things.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

/// A scene that must show what another one does, or less.
struct ChangedScene {
    struct Vertex {
        std::uint32_t primitive = 0, vertex = 0;
    };
    formats::Scene scene;
    /// Of each vertex of each primitive: that of the scene before.
    std::vector<std::vector<Vertex>> before;
    /// Points of the scene before become scale * turn * point, directions turn * direction. The
    /// light turns with them.
    double scale = 1;
    glm::dmat3 turn{1};
};

using formats::Primitive;
using formats::Rgb;
using formats::Scene;

glm::vec3 changed(const glm::dmat3& by, glm::vec3 v) {
    return glm::vec3(by * glm::dvec3(v));
}

// All lengths, and all per length, so that no optical depth changes.
void transform(ChangedScene& to, double scale, const glm::dmat3& turn) {
    to.scale = scale;
    to.turn = turn;
    const glm::dmat3 all = scale * turn;
    const auto per_length = static_cast<float>(1 / scale);
    Scene& scene = to.scene;
    scene.origin = all * scene.origin;
    for (Primitive& p : scene.primitives) {
        for (glm::vec3& position : p.position) {
            position = changed(all, position);
        }
        for (glm::vec3& normal : p.normal) {
            normal = changed(turn, normal);
        }
        for (std::size_t i = 0; glm::determinant(turn) < 0 && i + 2 < p.index.size(); i += 3) {
            std::swap(p.index[i + 1], p.index[i + 2]);
        }
    }
    for (formats::Material& material : scene.materials) {
        if (!material.medium) continue;
        material.medium->sigma_s = per_length * material.medium->sigma_s;
        material.medium->sigma_a = per_length * material.medium->sigma_a;
    }
    for (formats::Volume& volume : scene.volumes) {
        volume.density.to_scene = glm::dmat4(all) * volume.density.to_scene;
        volume.sigma_t = per_length * volume.sigma_t;
        for (glm::vec3& emission : volume.emission.value) {
            emission *= per_length;
        }
    }
    for (formats::Light& light : scene.lights) {
        light.position = changed(all, light.position);
        light.direction = changed(turn, light.direction);
        light.intensity = static_cast<float>(scale * scale) * light.intensity;
    }
}

bool is_large(const Scene& scene) {
    double reach = 0;
    for (const Primitive& p : scene.primitives) {
        for (const glm::vec3 position : p.position) {
            reach = std::max(reach, double{glm::length(position)});
        }
    }
    for (const formats::Volume& volume : scene.volumes) {
        reach = std::max(reach, glm::length(volume.density.corners().front()));
    }
    return reach > 1;
}

void reverse_order(ChangedScene& to) {
    Scene& scene = to.scene;
    std::ranges::reverse(scene.primitives);
    std::ranges::reverse(to.before);
    std::ranges::reverse(scene.materials);
    std::ranges::reverse(scene.volumes);
    std::ranges::reverse(scene.lights);
    for (Primitive& p : scene.primitives) {
        p.material = static_cast<std::uint32_t>(scene.materials.size()) - 1 - p.material;
    }
}

// Triangles [begin, end) of a primitive, with a vertex of its own for each corner or those that
// they share.
void append_part(const Scene& from, std::uint32_t primitive, std::size_t begin, std::size_t end,
                 bool shares, ChangedScene& to) {
    const Primitive& whole = from.primitives[primitive];
    Primitive part = whole;
    part.position.clear();
    part.normal.clear();
    part.index.clear();
    std::vector<ChangedScene::Vertex> before;
    std::vector<std::uint32_t> copy_of(whole.position.size(), formats::kNone);
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
        const std::uint32_t v = whole.index[i];
        if (!shares || copy_of[v] == formats::kNone) {
            copy_of[v] = static_cast<std::uint32_t>(part.position.size());
            part.position.push_back(whole.position[v]);
            part.normal.push_back(whole.normal[v]);
            before.push_back({primitive, v});
        }
        part.index.push_back(copy_of[v]);
    }
    to.scene.primitives.push_back(std::move(part));
    to.before.push_back(std::move(before));
}

void cut_meshes(const Scene& from, std::size_t parts, bool shares, ChangedScene& to) {
    to.scene.primitives.clear();
    to.before.clear();
    for (std::uint32_t p = 0; p < from.primitives.size(); ++p) {
        const std::size_t triangles = from.primitives[p].index.size() / 3;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = triangles * part / parts,
                              end = triangles * (part + 1) / parts;
            if (begin < end) append_part(from, p, begin, end, shares, to);
        }
    }
}

// Each surface, each crossing of a boundary and each scattering leaves less; extinction stays, and
// what sends out light sends out as much.
void darken(Scene& scene) {
    constexpr float kLeft = 0.7f;
    for (formats::Material& material : scene.materials) {
        material.base_color = kLeft * material.base_color;
        if (!material.medium) continue;
        const Rgb scattered = material.medium->sigma_s;
        material.medium->sigma_s = kLeft * scattered;
        material.medium->sigma_a = material.medium->sigma_a + (1 - kLeft) * scattered;
    }
    for (formats::Volume& volume : scene.volumes) {
        volume.albedo = kLeft * volume.albedo;
    }
}

/// The same scene where `again` says that it is baked once more as it is.
ChangedScene change_scene(const Scene& scene, Again again) {
    ChangedScene to;
    to.scene = scene;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        auto& vertices = to.before.emplace_back();
        for (std::uint32_t v = 0; v < scene.primitives[p].position.size(); ++v) {
            vertices.push_back({p, v});
        }
    }
    switch (again) {
        case Again::never:
        case Again::threads:
            break;
        case Again::scaled: {
            constexpr double kFactor = 1024;
            transform(to, is_large(scene) ? 1 / kFactor : kFactor, glm::dmat3(1));
            break;
        }
        case Again::turned:
            transform(to, 1, glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0));  // x to y to z to x
            break;
        case Again::mirrored:
            transform(to, 1, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1));
            break;
        case Again::reordered:
            reverse_order(to);
            break;
        case Again::unwelded:
            cut_meshes(scene, 1, false, to);
            break;
        case Again::split:
            cut_meshes(scene, 2, true, to);
            break;
        case Again::darker:
            darken(to.scene);
            break;
    }
    return to;
}

std::string file_bytes(const formats::Asset& asset) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    if (!file || !formats::write_opal(asset.view(), std::move(*file))) return "";
    const auto bytes = formats::FileBytes::open(folder / "a.opal").value();
    return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
}

// What two bakes show at one place.
struct SeenTwice {
    double first = 0, again = 0;
};

// Of the vertices that are seen, by primitive of the first bake, and along lines.
struct Comparison {
    std::vector<std::vector<SeenTwice>> vertices;
    std::vector<SeenTwice> lines;
};

Comparison compare(const BuiltScene& built, const ChangedScene& changed, const Shown& first,
                   const Shown& again) {
    Comparison pairs;
    pairs.vertices.resize(first.vertices.size());
    for (std::size_t p = 0; p < again.vertices.size(); ++p) {
        for (std::size_t v = 0; v < again.vertices[p].size(); ++v) {
            const ChangedScene::Vertex from = changed.before[p][v];
            if (!built.exposed[from.primitive][from.vertex]) continue;
            pairs.vertices[from.primitive].push_back(
                {first.vertices[from.primitive][from.vertex], again.vertices[p][v]});
        }
    }
    for (std::size_t i = 0; i < first.through_volumes.size(); ++i) {
        pairs.lines.push_back({first.through_volumes[i], again.through_volumes[i]});
    }
    return pairs;
}

// Root mean squares of the first, and of what is not allowed: of all that differs, or of all that
// is brighter again.
struct Apart {
    double seen = 0, off = 0, count = 0;

    void add(SeenTwice pair, bool only_brighter) {
        const double off_by = pair.again - pair.first;
        seen += pair.first * pair.first;
        off += only_brighter && off_by < 0 ? 0 : off_by * off_by;
        count += 1;
    }
    double relative() const { return off > 0 ? std::sqrt(off / seen) : 0; }
};

Apart measure(const Comparison& pairs, bool only_brighter) {
    Apart apart;
    for (const auto& primitive : pairs.vertices) {
        for (const SeenTwice pair : primitive) {
            apart.add(pair, only_brighter);
        }
    }
    for (const SeenTwice pair : pairs.lines) {
        apart.add(pair, only_brighter);
    }
    return apart;
}

// Where the order and the place of things stay, bakes draw the same rays again: what then differs
// is roundings, and what few rays change by them.
double allowed(Again again, double stated) {
    const bool same_rays = again == Again::scaled || again == Again::unwelded;
    constexpr double kRoundings = 0.02, kNoise = 0.09;
    return same_rays ? std::max(0.1 * stated, kRoundings) : 1.5 * std::max(stated, kNoise);
}

std::vector<LineOfSight> changed_lines(std::vector<LineOfSight> lines, const ChangedScene& by) {
    for (LineOfSight& line : lines) {
        line = {by.scale * (by.turn * line.from), by.turn * line.along};
    }
    return lines;
}

template <class Judge>
std::optional<Fault> for_each_light(const BuiltScene& built, const bake::BakeResult& baked,
                                    Again again, Judge&& judge) {
    const ChangedScene changed = change_scene(built.scene, again);
    const auto second = bake_coarsely(changed.scene, 1);
    if (!second) return Fault{"bakes again", second.error().diagnostics.front().fault};
    const auto lines = lines_through_volumes(built.scene);
    const auto lines_again = changed_lines(lines, changed);
    for (const LightOfAll& light : {even_light(false), half_sky(false), no_sky(true)}) {
        const Shown first = show(baked, built.scene.origin, lines, light);
        const Shown shown =
            show(*second, changed.scene.origin, lines_again, turned(light, changed.turn));
        if (auto fault = judge(light, compare(built, changed, first, shown),
                               std::hypot(stated_of(baked), stated_of(*second))))
            return fault;
    }
    return std::nullopt;
}

}  // namespace

std::optional<Fault> find_fault_again(const BuiltScene& built, const bake::BakeResult& baked,
                                      Again again) {
    if (again == Again::never) return std::nullopt;
    if (again == Again::threads) {
        const auto three = bake_coarsely(built.scene, 3);
        if (three && file_bytes(baked.asset) == file_bytes(three->asset)) return std::nullopt;
        return Fault{"threads", "1 and 3 threads make different bytes"};
    }
    const bool only_brighter = again == Again::darker;
    return for_each_light(built, baked, again,
                          [&](const LightOfAll& light, const Comparison& pairs,
                              double stated) -> std::optional<Fault> {
                              const Apart apart = measure(pairs, only_brighter);
                              if (apart.relative() < allowed(again, stated)) return std::nullopt;
                              return Fault{
                                  only_brighter ? "darker" : "again",
                                  fmt::format("RMS {:.3f} off under {} light, {:.3f} stated",
                                              apart.relative(), light.name, stated)};
                          });
}

std::string describe_again(const BuiltScene& built, const bake::BakeResult& baked, Again again) {
    if (again == Again::never || again == Again::threads) return "";
    std::string text;
    const auto fault =
        for_each_light(built, baked, again,
                       [&](const LightOfAll& light, const Comparison& pairs,
                           double stated) -> std::optional<Fault> {
                           const Apart apart = measure(pairs, again == Again::darker);
                           text += fmt::format("again: {} light: RMS {:.6f} off, {:.3f} stated\n",
                                               light.name, apart.relative(), stated);
                           return std::nullopt;
                       });
    return fault ? fault->detail : text;
}

}  // namespace opaline::tests
