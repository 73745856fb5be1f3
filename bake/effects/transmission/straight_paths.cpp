#include "bake/effects/transmission/straight_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/physics/entry.h"
#include "bake/physics/fresnel.h"
#include "bake/scene/nested_media.h"
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

// A view on its way, or a part of it.
struct Lane {
    glm::vec3 position{0}, direction{0};
    std::array<float, 3> weight{};
    MediumStack bodies;  // around it
    std::uint32_t view = 0;
    int arrivals = 0;
    bool is_on_its_way = false;
};

class Follower {
  public:
    Follower(const StraightBody& body, StraightLight& found) : body_(body), found_(found) {
        for (const StraightMedium& medium : body.media) {
            float& clearest = clearest_.emplace_back(medium.sigma_t[0]);
            for (std::size_t b = 1; b < body.bands; ++b) {
                clearest = std::min(clearest, medium.sigma_t[b]);
            }
            if (medium.field) {
                clearest = 0;  // how clear it is on the way is not known
            }
        }
    }

    void follow(const StraightStart& start, std::span<const glm::vec3> seen, std::uint32_t first) {
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            Lane& lane = lanes_[i];
            lane = {start.position, {0, 1, 0}, {1, 1, 1}, start.bodies, first + i, 0, false};
            if (i < seen.size()) {
                lane.direction = -seen[i];
                lane.is_on_its_way = true;
            }
        }
        vertex_ = start.vertex;
        while (advance()) {
        }
        look_out();
    }

    std::uint64_t traced() const { return traced_; }

  private:
    const StraightMedium& medium_of(const Lane& lane) const {
        return body_.media[lane.bodies.top()];
    }

    float largest(const Lane& lane) const {
        return body_.bands == 1 ? lane.weight[0]
                                : std::max({lane.weight[0], lane.weight[1], lane.weight[2]});
    }

    // Beyond it a view's weight is below the least in all bands.
    float reach_of(const Lane& lane) const {
        const float depth = std::log(largest(lane) / kLeastStraightWeight);
        const float clearest = clearest_[lane.bodies.top()];
        return clearest > 0 ? depth / clearest : kInfinity;
    }

    // All views to their next surface. False: none is on its way any more.
    bool advance() {
        RayPacket packet{};
        packet.mask.fill(0xffffffffu);
        LaneMask mask{};
        bool any = false;
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            Lane& lane = lanes_[i];
            if (!lane.is_on_its_way && !parted_.empty()) {
                lane = parted_.back();
                parted_.pop_back();
            }
            set_origin(packet, i, lane.position);
            set_lane(packet, mask, i, lane.direction, lane.is_on_its_way ? reach_of(lane) : 0);
            mask[i] = lane.is_on_its_way ? -1 : 0;
            any = any || lane.is_on_its_way;
            traced_ += lane.is_on_its_way ? 1 : 0;
        }
        if (!any) return false;
        const PacketHits hits = body_.rays->closest(mask, packet);
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            if (mask[i] == 0) continue;
            Lane& lane = lanes_[i];
            lane.is_on_its_way = hits.hit[i] != 0 && lane.arrivals < kMostArrivals;
            if (!lane.is_on_its_way) continue;
            attenuate(lane, hits.distance[i]);
            lane.is_on_its_way = arrive(lane, hits, i) && largest(lane) >= kLeastStraightWeight;
            ++lane.arrivals;
        }
        return true;
    }

    void attenuate(Lane& lane, float length) const {
        const StraightMedium& medium = medium_of(lane);
        if (medium.field) {
            length *=
                medium.field->mean_density(lane.position, lane.position + length * lane.direction);
        }
        for (std::size_t b = 0; b < body_.bands; ++b) {
            lane.weight[b] *= exp_of_negative(-medium.sigma_t[b] * length);
        }
    }

    // False: nothing of the view goes on.
    bool arrive(Lane& lane, const PacketHits& hits, std::uint32_t i) {
        const std::uint16_t place = body_.place_of[hits.material[i]];
        const std::uint16_t own = body_.place_of[body_.material];
        if (place == kNoPlace || (body_.ends_at_others && place != own)) {
            StraightExit met{lane.view, lane.direction, lane.weight, lane.position};
            met.eta = medium_of(lane).eta;
            met.is_opaque = !body_.scene->materials[hits.material[i]].medium;
            found_.inside.push_back(met);
            return false;
        }
        if (hits.cosine[i] == 0) {  // without area, or edge-on: as if it were not there
            constexpr float kBeyond = 1e-6f;
            lane.position +=
                (hits.distance[i] * (1 + kBeyond) + 2 * hits.error[i]) * lane.direction;
            return true;
        }
        const BoundaryHit at = arrival_at(*body_.scene, hits, i);
        const FarSide far =
            find_far_side(body_.meets ? &*body_.bodies : nullptr, body_.place_of, lane.bodies,
                          {lane.position, lane.direction, hits.distance[i], at.position, at.flat,
                           at.error, hits.u[i], hits.v[i], place},
                          traced_);
        if (!far.has_room) return false;
        if (body_.ends_at_others &&
            (far.is_several || !(far.bodies.empty() || far.bodies.is_only(own)))) {
            return false;
        }
        if (far.bodies.empty()) {
            if (lane.arrivals == 0 && is_around_vertex(hits, i)) {
                found_.past.push_back(lane.view);
                return false;
            }
            leave(lane, at, far);
        } else if (far.bodies.top() == lane.bodies.top()) {
            pass(lane, at, far);
        } else {
            change_medium(lane, at, far);
        }
        return true;
    }

    bool is_around_vertex(const PacketHits& hits, std::uint32_t i) const {
        const formats::Primitive& p = body_.scene->primitives[hits.primitive[i]];
        const std::uint32_t* corner = &p.index[hits.first_index[i]];
        return std::any_of(corner, corner + 3,
                           [&](std::uint32_t v) { return p.position[v] == vertex_; });
    }

    static void pass(Lane& lane, const BoundaryHit& at, const FarSide& far) {
        lane.bodies = far.bodies;
        lane.position = at.position + far.side * far.lift * at.flat;
    }

    // What is reflected goes on, and what is refracted: apart, where each is more than a little.
    void change_medium(Lane& lane, const BoundaryHit& at, const FarSide& far) {
        const float ratio = body_.media[far.bodies.top()].eta / medium_of(lane).eta;
        if (is_matched(ratio)) return pass(lane, at, far);
        const Bend bend = bend_at(far.side * at.normal, far.side * at.flat, lane.direction, ratio);
        Lane reflected = lane;
        reflected.position = at.position - far.side * far.lift * at.flat;
        reflected.direction = bend.reflected;
        const float share = largest(lane) * std::min(bend.passed, 1 - bend.passed);
        if (share < kLeastParted) {  // one of both by chance, with the light of both
            if (chance(lane) >= bend.passed) {
                lane = reflected;
                return;
            }
        } else {
            for (std::size_t b = 0; b < body_.bands; ++b) {
                reflected.weight[b] *= 1 - bend.passed;
                lane.weight[b] *= bend.passed;
            }
            ++reflected.arrivals;
            parted_.push_back(reflected);
        }
        lane.direction = bend.refracted;
        pass(lane, at, far);
    }

    // In [0, 1): spread evenly over views and their arrivals [Roberts2018], and the same at all
    // receivers, so that neighbours differ by their light alone.
    static float chance(const Lane& lane) {
        const double number = 0.7548776662466927 * lane.view + 0.5698402909980532 * lane.arrivals;
        return static_cast<float>(number - std::floor(number));
    }

    void leave(Lane& lane, const BoundaryHit& at, const FarSide& far) {
        const auto mirrored = [&](glm::vec3 n) {
            return lane.direction - 2 * glm::dot(lane.direction, n) * n;
        };
        const glm::vec3 flat = far.side * at.flat;
        // The smooth normal, unless it faces away or reflects to behind the triangle.
        glm::vec3 normal = far.side > 0 ? at.normal : flat;
        if (glm::dot(lane.direction, normal) <= 0 || glm::dot(mirrored(normal), flat) >= 0) {
            normal = flat;
        }
        const float eta = medium_of(lane).eta;
        const double inverse = 1 / static_cast<double>(eta);
        const float cosine = std::min(1.0f, glm::dot(lane.direction, normal));
        const auto outside =
            static_cast<float>(refracted_cosine(static_cast<double>(cosine), inverse));
        const glm::vec3 direction =
            glm::normalize(eta * (lane.direction - cosine * normal) + outside * normal);
        // A smooth normal may refract to behind the triangle: then all is reflected.
        const float passed =
            glm::dot(direction, flat) > 0
                ? static_cast<float>(fresnel_transmittance(static_cast<double>(cosine), inverse))
                : 0;
        if (passed > 0) {
            StraightExit exit{lane.view, direction, {}, at.position + far.lift * flat};
            for (std::size_t b = 0; b < body_.bands; ++b) {
                exit.weight[b] = passed * lane.weight[b];
                lane.weight[b] *= 1 - passed;
            }
            escapes_.push_back(exit);
        }
        lane.position = at.position - far.lift * flat;
        lane.direction = glm::normalize(mirrored(normal));
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
    std::vector<float> clearest_;  // sigma_t of each medium's clearest band [1/m]
    glm::vec3 vertex_{0};
    std::array<Lane, kLanes> lanes_;
    std::vector<Lane> parted_;  // wait for a lane
    std::vector<StraightExit> escapes_;
    std::uint64_t traced_ = 0;
};

}  // namespace

StraightBody make_straight_body(const formats::Scene& scene, const RayScene& rays,
                                std::uint32_t material, std::span<const std::uint32_t> inner,
                                bool meets) {
    StraightBody body;
    body.scene = &scene;
    body.rays = body.sky = &rays;
    body.material = material;
    body.eta = static_cast<double>(scene.materials[material].medium->eta);
    body.meets = meets;
    body.place_of.assign(scene.materials.size(), kNoPlace);
    for (const std::uint32_t m : order_media(scene)) {
        if (m != material && std::ranges::find(inner, m) == inner.end()) continue;
        const formats::Medium& medium = *scene.materials[m].medium;
        const formats::Rgb sigma_t = medium.sigma_s + medium.sigma_a;
        body.place_of[m] = static_cast<std::uint16_t>(body.media.size());
        StraightMedium& own = body.media.emplace_back();
        own.eta = medium.eta;
        own.sigma_t = {sigma_t.r, sigma_t.g, sigma_t.b};
        if (medium.variation && medium.variation->density.image != formats::kNone) {
            own.field.emplace(scene, m);
        }
    }
    if (meets || !inner.empty()) {
        body.bodies.emplace(scene, rays.hierarchy());
    }
    return body;
}

StraightBody make_straight_body(const EffectInputs& inputs) {
    const MaterialFacts& facts = inputs.bake.facts.material[inputs.material];
    std::vector<std::uint32_t> inner;
    bool meets = facts.overlaps;
    for (const InnerMedium& other : facts.inner) {
        inner.push_back(other.material);
        meets = meets || other.depth == 0;
    }
    StraightBody body =
        make_straight_body(inputs.bake.scene, inputs.bake.rays, inputs.material, inner, meets);
    body.sky = &inputs.outside();
    body.ends_at_others = inputs.layout.layered;
    body.bands = inputs.layout.bands();
    return body;
}

StraightStart make_straight_start(const StraightBody& body, const BodyPoint& point,
                                  std::uint64_t& rays) {
    const std::uint16_t own = body.place_of[body.material];
    if (body.bodies) {
        return {point.inner, bodies_at_start(*body.bodies, body.place_of, own, point.inner),
                point.position};
    }
    const InwardPath path = trace_inward_path(*body.rays, point, kInfinity);
    rays += path.steps.size();
    return {point.inner, MediumStack(own, std::max(1, shells_at(path, 0))), point.position};
}

std::uint64_t follow_straight(const StraightBody& body, const StraightStart& start,
                              std::span<const glm::vec3> seen, StraightLight& found) {
    if (body.ends_at_others && !start.bodies.is_only(body.place_of[body.material])) return 0;
    Follower follower(body, found);
    for (std::size_t first = 0; first < seen.size(); first += kLanes) {
        follower.follow(start,
                        seen.subspan(first, std::min<std::size_t>(kLanes, seen.size() - first)),
                        static_cast<std::uint32_t>(first));
    }
    return follower.traced();
}

}  // namespace opaline::bake
