#include "bake/reference/reference_receivers.h"

#include <algorithm>

#include "bake/base/rng.h"
#include "bake/receivers/used_vertices.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/transport/touching_triangles.h"

namespace opaline::bake {
namespace {

// One from each of `wanted` equal runs, so none is drawn twice.
std::vector<std::uint64_t> draw(std::uint64_t count, std::uint64_t wanted, std::uint64_t seed) {
    std::vector<std::uint64_t> drawn;
    wanted = std::min(wanted, count);
    for (std::uint64_t i = 0; i < wanted; ++i) {
        const std::uint64_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const double u =
            static_cast<double>(random_uniform(seed, RandomStage::reference_receivers, i)[0]);
        drawn.push_back(begin + static_cast<std::uint64_t>(u * static_cast<double>(end - begin)));
    }
    return drawn;
}

glm::vec3 direction_to(glm::dvec3 from, glm::dvec3 to, glm::vec3 otherwise) {
    const glm::dvec3 way = to - from;
    const double length = glm::length(way);
    return length > 0 ? glm::vec3(way / length) : otherwise;
}

}  // namespace

std::vector<ReferenceReceiver> choose_receivers(const ReferenceScene& scene, std::uint32_t wanted,
                                                std::uint64_t seed,
                                                const std::optional<glm::vec3>& eye) {
    const formats::Scene& input = scene.surfaces.scene();
    // Ray origins as in the bake: in front of all triangles that meet at the vertex.
    const std::vector<Receiver> origins = make_vertex_receivers(input);
    std::vector<ReferenceReceiver> receivers;
    std::uint64_t first = 0;
    std::uint32_t primitive = 0;
    const std::vector<std::uint32_t> used = find_used_vertices(input);
    for (const std::uint64_t drawn : draw(used.size(), wanted, seed)) {
        const std::uint32_t number = used[drawn];
        while (number >= first + input.primitives[primitive].position.size()) {
            first += input.primitives[primitive++].position.size();
        }
        const formats::Primitive& p = input.primitives[primitive];
        ReferenceReceiver receiver;
        receiver.primitive = primitive;
        receiver.vertex = static_cast<std::uint32_t>(number - first);
        const glm::vec3 position = p.position[receiver.vertex];
        receiver.position = position;
        receiver.outside =
            leave_touching_triangles(scene.surfaces.hierarchy(), input, position, origins[number])
                .origin;
        receiver.inside = position - (receiver.outside - position);
        receiver.normal = p.normal[receiver.vertex];
        receiver.to_eye =
            eye ? direction_to(input.to_world(position), *eye, receiver.normal) : receiver.normal;
        receiver.base_color = base_color_at_vertex(input, primitive, receiver.vertex);
        receiver.medium = scene.medium_of[p.material];
        if (receiver.normal != glm::vec3(0)) {
            receiver.around = surrounding_media(scene, receiver.outside, receiver.normal);
            if (!receiver.around.empty() && receiver.around.top() == receiver.medium) {
                // Bodies that touch end where the other begins.
                receiver.within = surrounding_media(scene, receiver.inside, -receiver.normal);
                if (receiver.within.top() != receiver.medium) {
                    receiver.within = {};
                }
            }
        }
        receivers.push_back(receiver);
    }
    return receivers;
}

}  // namespace opaline::bake
