#include "tests/properties/change_scene.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace opaline::tests {
namespace {

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

}  // namespace

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

}  // namespace opaline::tests
