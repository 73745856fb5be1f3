#include "bake/accuracy/model_receivers.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace opaline::bake {
namespace {

// Inside another body or behind all surfaces: invisible, and the bake uses the light of its
// neighbours (visibility/hidden_receivers).
bool is_buried(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (!receiver.around.empty()) {
        return true;
    }
    for (std::uint32_t i = 0; i < 16; ++i) {
        RandomStream random(0, i, 0);
        glm::vec3 d{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
        d *= glm::dot(d, receiver.normal) < 0 ? -1.0f : 1.0f;
        const auto hit = scene.surfaces.closest_hit({receiver.outside}, glm::normalize(d),
                                                    std::numeric_limits<float>::infinity());
        if (!hit || glm::dot(hit->flat, d) < 0) {
            return false;
        }
        const formats::Scene& input = scene.surfaces.scene();
        if (input.materials[input.primitives[hit->primitive].material].double_sided) {
            return false;
        }
    }
    return true;
}

// An opaque surface lies close behind it in its own body, such as a floor that the body has sunk
// into. There the bake's empty body differs from the reference's.
bool is_pierced(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (receiver.medium == formats::kNone) {
        return false;
    }
    constexpr float kClose = 3;  // mean free paths, in the clearest channel
    const glm::vec3 sigma_t = scene.media[receiver.medium].sigma_t;
    const auto hit = scene.surfaces.closest_hit(
        {receiver.inside}, -receiver.normal,
        kClose / std::max(std::min({sigma_t.x, sigma_t.y, sigma_t.z}), 1e-30f));
    const formats::Scene& input = scene.surfaces.scene();
    return hit && scene.medium_of[input.primitives[hit->primitive].material] == formats::kNone;
}

// Its body ends just behind it and begins again: a fold of the mesh that lies on itself. Hardly any
// light scatters between. Light from below the gap has met a second surface, which bakes ignore
// (README.md).
bool is_folded(const ReferenceScene& scene, const ReferenceReceiver& receiver) {
    if (receiver.medium == formats::kNone) {
        return false;
    }
    constexpr float kThin = 1;  // mean free paths, in the clearest channel
    const glm::vec3 sigma_t = scene.media[receiver.medium].sigma_t;
    float reach = kThin / std::max(std::min({sigma_t.x, sigma_t.y, sigma_t.z}), 1e-30f);
    const glm::vec3 down = -receiver.normal;
    const formats::Scene& input = scene.surfaces.scene();
    RayOrigin from{receiver.inside};
    for (int i = 0; i < 2; ++i) {  // where it ends, and where it begins again
        const auto hit = scene.surfaces.closest_hit(from, down, reach);
        if (!hit || scene.medium_of[input.primitives[hit->primitive].material] != receiver.medium) {
            return false;
        }
        if (glm::dot(hit->flat, down) < 0) {
            return true;
        }
        reach -= hit->distance;
        from = go_straight_on(from, leave_surface(*hit, down));
    }
    return false;
}

// At a sharp edge of its body radiance is discontinuous, because the path along one face's normal
// lies in the other face.
bool is_on_edge(const ReferenceReceiver& receiver) {
    constexpr float kSharp = 0.9f;
    return receiver.medium != formats::kNone &&
           glm::dot(glm::normalize(receiver.outside - receiver.inside), receiver.normal) < kSharp;
}

// Marks vertices with triangles on both sides of 60 degrees from their normal: ends and folds of
// the mesh, at which no normal is right.
std::vector<std::vector<bool>> find_creases(const formats::Scene& scene) {
    constexpr float kSharp = 0.5f;
    std::vector<std::vector<bool>> creased;
    for (const formats::Primitive& p : scene.primitives) {
        std::vector<bool> facing(p.position.size()), turned(p.position.size());
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const std::uint32_t* const corner = &p.index[i];
            const glm::vec3 a = p.position[corner[0]];
            const glm::vec3 flat = glm::cross(p.position[corner[1]] - a, p.position[corner[2]] - a);
            for (int c = 0; c < 3; ++c) {
                const float cosine = glm::dot(flat, p.normal[corner[c]]);
                const float sharp = kSharp * glm::length(flat);
                facing[corner[c]] = facing[corner[c]] || cosine > sharp;
                turned[corner[c]] = turned[corner[c]] || cosine < sharp;
            }
        }
        for (std::size_t v = 0; v < facing.size(); ++v) {
            facing[v] = facing[v] && turned[v];
        }
        creased.push_back(std::move(facing));
    }
    return creased;
}

}  // namespace

std::vector<ReferenceReceiver> choose_model_receivers(const ReferenceScene& scene,
                                                      std::uint32_t wanted, std::uint64_t seed) {
    std::vector<ReferenceReceiver> receivers = choose_receivers(scene, wanted, seed, std::nullopt);
    const formats::Scene& input = scene.surfaces.scene();
    const std::vector<std::vector<bool>> creased = find_creases(input);
    std::erase_if(receivers, [&](const ReferenceReceiver& r) {
        return r.normal == glm::vec3(0) || is_buried(scene, r) || is_pierced(scene, r) ||
               is_folded(scene, r) || is_on_edge(r) ||
               (r.medium != formats::kNone && creased[r.primitive][r.vertex]);
    });
    bool turn = false;
    for (ReferenceReceiver& r : receivers) {
        if (input.materials[input.primitives[r.primitive].material].sheet) {
            r.to_eye = turn ? -r.normal : r.normal;
            turn = !turn;
        }
    }
    return receivers;
}

}  // namespace opaline::bake
