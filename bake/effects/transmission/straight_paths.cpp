#include "bake/effects/transmission/straight_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/physics/entry.h"
#include "bake/physics/fresnel.h"
#include "bake/trace/body.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLanes = RayPacket::kSize;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// More arrivals at surfaces than any view needs; bounds the work that a hostile mesh can ask for.
constexpr int kMostArrivals = 256;

// A triangle that a view has arrived at.
struct BoundaryHit {
    glm::vec3 position;  // [m], on the triangle
    glm::vec3 flat;      // unit, of the triangle
    glm::vec3 normal;    // unit, interpolated, along `flat`
    float error;         // [m], bound on that of the position
};

BoundaryHit arrival_at(const formats::Scene& scene, const PacketHits& hits, std::uint32_t lane) {
    const formats::Primitive& p = scene.primitives[hits.primitive[lane]];
    const std::uint32_t* corner = &p.index[hits.first_index[lane]];
    const float u = hits.u[lane], v = hits.v[lane];
    const auto mix = [&](const std::vector<glm::vec3>& of) {
        return (1 - u - v) * of[corner[0]] + u * of[corner[1]] + v * of[corner[2]];
    };
    BoundaryHit a{mix(p.position),
                  {hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]},
                  mix(p.normal),
                  hits.error[lane]};
    const float length = glm::length(a.normal);
    a.normal = length > 0 && glm::dot(a.normal, a.flat) > 0 ? a.normal / length : a.flat;
    return a;
}

// One view on its way.
struct Lane {
    glm::vec3 position{0}, direction{0};
    std::array<float, 3> weight{};
    std::int32_t shells = 1;
    bool is_on_its_way = false;
};

class Follower {
  public:
    Follower(const StraightBody& body, StraightLight& found)
        : body_(body), found_(found), clearest_(body.sigma_t[0]) {
        for (std::size_t b = 1; b < body.bands; ++b) {
            clearest_ = std::min(clearest_, body.sigma_t[b]);
        }
        clearest_ = body.field ? 0 : clearest_;  // how clear it is on the way is not known
    }

    void follow(const StraightStart& start, std::span<const glm::vec3> seen, std::uint32_t first) {
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            Lane& lane = lanes_[i];
            lane = {start.position, {}, {1, 1, 1}, start.shells, i < seen.size()};
            lane.direction = i < seen.size() ? -seen[i] : glm::vec3(0, 1, 0);
        }
        vertex_ = start.vertex;
        is_first_ = true;
        for (int arrival = 0; arrival < kMostArrivals && advance(first); ++arrival) {
            is_first_ = false;
        }
        look_out();
    }

    std::uint64_t traced() const { return traced_; }

  private:
    float largest(const Lane& lane) const {
        return body_.bands == 1 ? lane.weight[0]
                                : std::max({lane.weight[0], lane.weight[1], lane.weight[2]});
    }

    // Beyond it a view's weight is below the least in all bands.
    float reach_of(const Lane& lane) const {
        const float depth = std::log(largest(lane) / kLeastStraightWeight);
        return clearest_ > 0 ? depth / clearest_ : kInfinity;
    }

    // All views to their next surface. False: none is on its way any more.
    bool advance(std::uint32_t first) {
        RayPacket packet{};
        packet.mask.fill(0xffffffffu);
        LaneMask mask{};
        bool any = false;
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            const Lane& lane = lanes_[i];
            set_origin(packet, i, lane.position);
            set_lane(packet, mask, i, lane.direction, lane.is_on_its_way ? reach_of(lane) : 0);
            mask[i] = lane.is_on_its_way ? -1 : 0;
            any = any || lane.is_on_its_way;
            traced_ += lane.is_on_its_way ? 1 : 0;
        }
        if (!any) return false;
        const PacketHits hits = body_.rays->closest(mask, packet);
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            if (mask[i] != 0) {
                Lane& lane = lanes_[i];
                lane.is_on_its_way = hits.hit[i] != 0;
                if (!lane.is_on_its_way) continue;
                attenuate(lane, hits.distance[i]);
                if (hits.material[i] == body_.material) {
                    lane.is_on_its_way = arrive(lane, hits, i, first + i);
                } else {
                    lane.is_on_its_way = false;
                    StraightExit met{first + i, lane.direction, lane.weight, lane.position};
                    for (float& weight : met.weight) {
                        weight /= static_cast<float>(body_.eta * body_.eta);
                    }
                    found_.inside.push_back(met);
                }
            }
        }
        return true;
    }

    void attenuate(Lane& lane, float length) const {
        if (body_.field) {
            length *=
                body_.field->mean_density(lane.position, lane.position + length * lane.direction);
        }
        for (std::size_t b = 0; b < body_.bands; ++b) {
            lane.weight[b] *= exp_of_negative(-body_.sigma_t[b] * length);
        }
    }

    // False: nothing of the view goes on.
    bool arrive(Lane& lane, const PacketHits& hits, std::uint32_t i, std::uint32_t view) {
        const float cosine = hits.cosine[i];
        if (cosine == 0) {  // without area, or edge-on: as if it were not there
            constexpr float kBeyond = 1e-6f;
            lane.position +=
                (hits.distance[i] * (1 + kBeyond) + 2 * hits.error[i]) * lane.direction;
            return true;
        }
        const BoundaryHit at = arrival_at(*body_.scene, hits, i);
        if (cosine < 0 || lane.shells > 1) {  // of a shell inside
            lane.shells += cosine > 0 ? -1 : 1;
            lane.position = at.position + (cosine > 0 ? 2 : -2) * at.error * at.flat;
            return largest(lane) >= kLeastStraightWeight;
        }
        if (is_first_ && is_around_vertex(hits, i)) {
            found_.past.push_back(view);
            return false;
        }
        return leave(lane, at, view);
    }

    bool is_around_vertex(const PacketHits& hits, std::uint32_t i) const {
        const formats::Primitive& p = body_.scene->primitives[hits.primitive[i]];
        const std::uint32_t* corner = &p.index[hits.first_index[i]];
        return std::any_of(corner, corner + 3,
                           [&](std::uint32_t v) { return p.position[v] == vertex_; });
    }

    // A face of another body lies on this one.
    bool is_against_other(const Lane& lane, const BoundaryHit& at) const {
        if (!body_.bodies) return false;
        constexpr float kGrazing = 0.1f;
        const float reach =
            body_.bodies->touch() / std::max(kGrazing, std::abs(glm::dot(lane.direction, at.flat)));
        bool is_met = false;
        body_.bodies->visit_crossed(at.position - reach * lane.direction, lane.direction, 2 * reach,
                                    [&](std::uint32_t place, bool) {
                                        is_met = is_met ||
                                                 body_.bodies->order()[place] != body_.material;
                                    });
        return is_met;
    }

    bool leave(Lane& lane, const BoundaryHit& at, std::uint32_t view) {
        if (is_against_other(lane, at)) return false;
        const auto mirrored = [&](glm::vec3 n) {
            return lane.direction - 2 * glm::dot(lane.direction, n) * n;
        };
        // The smooth normal, unless it faces away or reflects to behind the triangle.
        glm::vec3 normal = at.normal;
        if (glm::dot(lane.direction, normal) <= 0 || glm::dot(mirrored(normal), at.flat) >= 0) {
            normal = at.flat;
        }
        const double inverse = 1 / body_.eta;
        const float cosine = std::min(1.0f, glm::dot(lane.direction, normal));
        const auto outside =
            static_cast<float>(refracted_cosine(static_cast<double>(cosine), inverse));
        const glm::vec3 direction = glm::normalize(
            static_cast<float>(body_.eta) * (lane.direction - cosine * normal) + outside * normal);
        // A smooth normal may refract to behind the triangle: then all is reflected.
        const float passed =
            glm::dot(direction, at.flat) > 0
                ? static_cast<float>(fresnel_transmittance(static_cast<double>(cosine), inverse))
                : 0;
        if (passed > 0) {
            StraightExit exit{view, direction, {}, at.position + 2 * at.error * at.flat};
            for (std::size_t b = 0; b < body_.bands; ++b) {
                exit.weight[b] = passed * lane.weight[b];
                lane.weight[b] *= 1 - passed;
            }
            escapes_.push_back(exit);
        }
        lane.position = at.position - 2 * at.error * at.flat;
        lane.direction = glm::normalize(mirrored(normal));
        return largest(lane) >= kLeastStraightWeight;
    }

    // Which exits something stands before.
    void look_out() {
        for (std::size_t begin = 0; begin < escapes_.size(); begin += kLanes) {
            const std::size_t count = std::min<std::size_t>(kLanes, escapes_.size() - begin);
            RayPacket packet{};
            packet.mask.fill(0xffffffffu);
            packet.dir_y.fill(1.0f);
            packet.tfar.fill(kInfinity);
            LaneMask mask{};
            for (std::size_t i = 0; i < count; ++i) {
                const StraightExit& e = escapes_[begin + i];
                set_origin(packet, i, e.origin);
                set_lane(packet, mask, i, e.direction);
            }
            if (!body_.sky->is_empty()) {
                body_.sky->occluded(mask, packet);
                traced_ += count;
            }
            for (std::size_t i = 0; i < count; ++i) {
                (packet.tfar[i] > 0 ? found_.exits : found_.blocked).push_back(escapes_[begin + i]);
            }
        }
        escapes_.clear();
    }

    const StraightBody& body_;
    StraightLight& found_;
    float clearest_;
    glm::vec3 vertex_{0};
    bool is_first_ = true;
    std::array<Lane, kLanes> lanes_;
    std::vector<StraightExit> escapes_;
    std::uint64_t traced_ = 0;
};

}  // namespace

StraightBody make_straight_body(const EffectInputs& inputs) {
    const formats::Medium& medium = inputs.medium();
    StraightBody body;
    body.scene = &inputs.bake.scene;
    body.rays = &inputs.bake.rays;
    body.sky = &inputs.outside();
    body.material = inputs.material;
    body.eta = static_cast<double>(medium.eta);
    if (std::ranges::any_of(inputs.bake.facts.material[inputs.material].inner,
                            [](const InnerMedium& inner) { return inner.depth == 0; })) {
        body.bodies.emplace(inputs.bake.scene, inputs.bake.rays.hierarchy());
    }
    const formats::Rgb sigma_t = medium.sigma_s + medium.sigma_a;
    body.sigma_t = {sigma_t.r, sigma_t.g, sigma_t.b};
    body.bands = inputs.layout.bands();
    if (medium.variation && medium.variation->density.image != formats::kNone) {
        body.field.emplace(inputs.bake.scene, inputs.material);
    }
    return body;
}

StraightStart make_straight_start(const StraightBody& body, const BodyPoint& point,
                                  std::uint64_t& rays) {
    const InwardPath path = trace_inward_path(*body.rays, point, kInfinity);
    rays += path.steps.size();
    StraightStart start{point.inner, std::max(1, shells_at(path, 0)), point.position};
    if (body.bodies) {
        std::vector<int> around;
        body.bodies->count(point.inner, around);
        for (std::size_t p = 0; p < around.size(); ++p) {
            start.is_in_others =
                start.is_in_others || (around[p] > 0 && body.bodies->order()[p] != body.material);
        }
    }
    return start;
}

std::uint64_t follow_straight(const StraightBody& body, const StraightStart& start,
                              std::span<const glm::vec3> seen, StraightLight& found) {
    if (start.is_in_others) return 0;
    Follower follower(body, found);
    for (std::size_t first = 0; first < seen.size(); first += kLanes) {
        follower.follow(start,
                        seen.subspan(first, std::min<std::size_t>(kLanes, seen.size() - first)),
                        static_cast<std::uint32_t>(first));
    }
    return follower.traced();
}

}  // namespace opaline::bake
