#include "bake/emitters/surface_arrival.h"

#include <algorithm>

#include "bake/transport/packet_lane.h"

namespace opaline::bake {

std::optional<Arrival> arrival_of(const PacketHits& hits, std::size_t lane) {
    if (hits.hit[lane] == 0 || hits.cosine[lane] == 0) return std::nullopt;
    const bool is_back = hits.cosine[lane] > 0;
    const glm::dvec3 normal(hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]);
    Arrival arrival;
    arrival.side = {hits.primitive[lane], hits.first_index[lane], is_back};
    const double u = hits.u[lane], v = hits.v[lane];
    arrival.weights = {1 - u - v, u, v};
    arrival.normal = is_back ? -normal : normal;
    arrival.material = hits.material[lane];
    arrival.distance = hits.distance[lane];
    arrival.error = hits.error[lane];
    return arrival;
}

std::optional<Arrival> find_arrival(const RayScene& surfaces, const glm::vec3& from,
                                    const glm::vec3& direction) {
    return arrival_of(closest_of_one(surfaces, from, direction), 0);
}

glm::dvec3 leave_surface(const glm::dvec3& from, const glm::dvec3& direction, const Arrival& at,
                         bool crosses) {
    const glm::dvec3 hit = from + at.distance * direction;
    if (crosses) return hit - 2 * at.error * at.normal;
    const double back = std::min(2 * at.error / -glm::dot(direction, at.normal), 0.5 * at.distance);
    return hit - back * direction;
}

}  // namespace opaline::bake
