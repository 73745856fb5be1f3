#include "bake/effects/multiple/walks/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/free_ball.h"
#include "bake/effects/multiple/walks/medium_stack.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kForever = std::numeric_limits<float>::infinity();

float transmittance(float cosine, float eta) {
    return static_cast<float>(
        fresnel_transmittance(static_cast<double>(cosine), static_cast<double>(eta)));
}

// Into the half space below both normals. Refracted by the smooth one; where that leads above the
// facet, by the facet's.
glm::vec3 start_direction(const WalkSpace& space, const WalkStart& start, WalkRandom& random) {
    if (start.seen != glm::vec3(0)) return -start.seen;
    float cosine = 1, azimuth = 0;
    constexpr int kMostTries = 1000;  // one in a hundred is accepted at the most extreme index
    for (int i = 0; i < kMostTries; ++i) {
        cosine = std::sqrt(1 - random.next());
        azimuth = 2 * kPi * random.next();
        if (random.next() < transmittance(cosine, space.eta)) break;
        cosine = 1;
    }
    const auto inside = static_cast<float>(
        refracted_cosine(static_cast<double>(cosine), static_cast<double>(space.eta)));
    const float sine = std::sqrt(std::max(0.0f, 1 - inside * inside));
    const glm::vec3 tilted(sine * std::cos(azimuth), sine * std::sin(azimuth), -inside);
    const glm::vec3 direction = make_frame(start.normal).to_world(tilted);
    return glm::dot(direction, start.flat) < 0 ? direction
                                               : make_frame(start.flat).to_world(tilted);
}

// Two indices of refraction between which light neither bends nor is reflected.
bool is_matched(float ratio) {
    return std::abs(ratio - 1) < 1e-5f;
}

class Walk {
  public:
    Walk(const WalkSpace& space, const WalkGroup& group, const WalkStart& start,
         const WalkOrders& orders, WalkRandom& random, std::vector<WalkExit>& exits,
         WalkCounts& counts)
        : space_(space),
          weight_(space, group),
          orders_(orders),
          random_(random),
          exits_(exits),
          counts_(counts),
          bodies_(0, start.shells) {}

    glm::vec3 follow(const WalkStart& start) {
        ++counts_.walks;
        const glm::vec3 seen = follow_from(start);
        count_absorbed();
        return seen;
    }

  private:
    glm::vec3 follow_from(const WalkStart& start) {
        position_ = start_ = start.position;
        vertex_ = start.vertex;
        free_.set(position_, 0, start.depth);
        if (start.arrival != glm::vec3(0)) {
            direction_ = start.arrival;
            if (collide(0)) {
                go_on(1);
            }
            return -start.arrival;
        }
        direction_ = start_direction(space_, start, random_);
        const glm::vec3 seen = -direction_;
        ++counts_.events;
        if (fly_first()) {
            go_on(1);
        }
        return seen;
    }

    void go_on(std::uint32_t event) {
        for (; event < space_.most_events; ++event) {
            ++counts_.events;
            if (!(may_jump() ? jump() : fly(flight_length()))) return;
        }
        give_up(counts_.endless);
    }

    // Lower bound [m] on the distance to the nearest surface.
    float clearance() const {
        return std::max(space_.clearance(position_), free_.least(position_));
    }

    const BallBank* balls() const {
        return bodies_.top() < space_.balls.size() ? space_.balls[bodies_.top()].get() : nullptr;
    }

    // Whether a ball of the bank fits here. Where the grid is too coarse to decide, searches for
    // the nearest triangle, unless the walk cannot have gone far enough from one.
    bool may_jump() {
        const BallBank* const bank = balls();
        if (bank == nullptr || !(weight_.sigma_t() > 0)) return false;
        const float least = bank->least() / weight_.sigma_t();
        clearance_ = clearance();
        if (clearance_ >= least) return true;
        constexpr float kCoarse = 3, kWorth = 3;  // measured: a search costs five flights
        const float most = free_.most(position_);
        if (!(space_.cell * weight_.sigma_t() > kCoarse) || most < kWorth * least) return false;
        const float reach = std::min(1.00001f * most, bank->largest() / weight_.sigma_t());
        ++counts_.searches;
        const float distance = find_clearance(space_, position_, reach);
        free_.set(position_, distance, distance < reach ? distance : most);
        clearance_ = std::max(clearance_, free_.least(position_));
        return clearance_ >= least;
    }

    bool jump() {
        const float sigma_t = weight_.sigma_t();
        const float u = random_.next();
        const BallJump jump = balls()->draw(sigma_t * clearance_, direction_, u, random_.next());
        ++counts_.jumps;
        position_ += jump.way / sigma_t;
        direction_ = jump.direction;
        length_ += jump.length / sigma_t;
        if (jump.scatterings > 0) {
            count_scatterings(static_cast<std::uint32_t>(jump.scatterings));
        }
        return weight_.cross_ball(jump.length / sigma_t, jump.scatterings) && survives();
    }

    float flight_length() {
        const float depth = -std::log(1 - random_.next());
        return weight_.sigma_t() > 0 ? depth / weight_.sigma_t() : kForever;
    }

    void count_scatterings(std::uint32_t count) {
        if (scatterings_ == 0) {
            count_absorbed();
            add_left(1, counts_.scattered);
        }
        scatterings_ += count;
    }

    // Of the light that the walk carries.
    WalkEnds& ends() { return scatterings_ > 0 ? counts_.ends : counts_.straight; }

    void count_absorbed() {
        const std::array<double, 3> taken = weight_.take_absorbed();
        for (std::size_t b = 0; b < 3; ++b) {
            ends().absorbed[b] += taken[b];
        }
    }

    // The weight in walks times `share`.
    void add_left(float share, std::array<double, 3>& sum) const {
        for (std::size_t b = 0; b < 3; ++b) {
            sum[b] += static_cast<double>(share) * weight_.left(b);
        }
    }

    bool give_up(std::uint64_t& count) {
        ++count;
        add_left(1, ends().unfinished);
        return false;
    }

    bool meet() {
        add_left(1, ends().met);
        return false;
    }

    // A flight from the start. Where a body is thin, nearly all light crosses it unscattered and is
    // not counted: half of the walks scatter before the first surface (BandWeights).
    bool fly_first() {
        const float reach = weight_.first_reach();
        if (space_.clearance(position_) >= reach) return fly(flight_length());
        WalkHit hit;
        ++counts_.rays;
        // Beyond another medium's surface the walk may still scatter.
        if (!find_hit(space_, position_, direction_, reach, hit) || is_entered(hit)) {
            return fly(flight_length());
        }
        const float distance = glm::length(hit.position - position_);
        const float scattered = -std::expm1(-weight_.sigma_t() * distance);
        constexpr float kHalfStep = 0x1p-25f;  // of random numbers: never 0
        if (random_.next() + kHalfStep < weight_.first_crossing_chance(distance)) {
            return weight_.cross_first(distance) && arrive(hit);
        }
        const float inside =
            std::min(distance, -std::log1p(-scattered * random_.next()) / weight_.sigma_t());
        return weight_.collide_first(inside, distance) && collide(inside);
    }

    bool fly(float length) {
        WalkHit hit;
        if (clearance() < length) {
            ++counts_.rays;
            if (find_hit(space_, position_, direction_, length, hit)) {
                return weight_.fly(glm::distance(hit.position, position_), false) && arrive(hit);
            }
        }
        if (!(length < kForever)) return give_up(counts_.lost);
        return weight_.fly(length, true) && collide(length);
    }

    bool collide(float length) {
        position_ += length * direction_;
        length_ += length;
        if (glm::any(glm::lessThan(position_, space_.low)) ||
            glm::any(glm::greaterThan(position_, space_.high))) {
            return give_up(counts_.lost);
        }
        if (const auto& field = medium().field) return collide_in(*field);
        count_scatterings(1);
        turn();
        return weight_.absorb() && survives();
    }

    // Flights are those of the stated extinction, the largest there is. Where it is less, the rest
    // of the collisions are with nothing. All groups of bands have the same share of these, so it
    // cancels from their weights.
    bool collide_in(const MediumField& field) {
        if (field.has_density() && !(random_.next() < field.density(position_))) return true;
        count_scatterings(1);
        turn();
        const glm::vec3 albedo = field.albedo(position_);
        return weight_.absorb({albedo.x, albedo.y, albedo.z}) && survives();
    }

    void turn() {
        const float u = random_.next();
        direction_ = scatter(medium().phase, direction_, u, random_.next());
    }

    const WalkMedium& medium() const { return space_.media[bodies_.top()]; }

    // Of another medium that walks go into.
    bool is_entered(const WalkHit& hit) const {
        return hit.medium != 0 && hit.medium != kNoWalkMedium;
    }

    bool arrive(const WalkHit& hit) {
        if (hit.medium == kNoWalkMedium) return meet();
        length_ += glm::distance(hit.position, position_);
        free_.set(hit.position, 0, 0);
        const float side = glm::dot(direction_, hit.flat) > 0 ? 1.0f : -1.0f;
        MediumStack beyond = bodies_;
        if (side > 0) {
            beyond.leave(hit.medium);
        } else if (!beyond.enter(hit.medium)) {
            return give_up(counts_.buried);
        }
        if (beyond.empty()) return hit.is_own ? arrive_at_boundary(hit) : meet();
        return beyond.top() == bodies_.top() ? pass(hit, side, beyond)
                                             : change_medium(hit, side, beyond);
    }

    bool pass(const WalkHit& hit, float side, const MediumStack& beyond) {
        bodies_ = beyond;
        position_ = hit.position + side * 2 * hit.error * hit.flat;
        return true;
    }

    // `side`: 1 where the triangle's normal points along the walk, else -1. Light of one surface is
    // either reflected or refracted, as Fresnel's reflectance says, with unchanged weights.
    bool change_medium(const WalkHit& hit, float side, const MediumStack& beyond) {
        const float ratio = space_.media[beyond.top()].eta / medium().eta;
        if (!is_matched(ratio)) {
            const glm::vec3 flat = side * hit.flat;
            glm::vec3 refracted;
            const auto bend = [&](glm::vec3 normal, float cosine) {
                const auto beyond_cosine = static_cast<float>(
                    refracted_cosine(static_cast<double>(cosine), static_cast<double>(ratio)));
                refracted =
                    glm::normalize((direction_ - cosine * normal) / ratio + beyond_cosine * normal);
            };
            // The smooth normal, unless it sends light to the wrong side of the triangle.
            glm::vec3 normal = side * smooth_normal(space_, hit);
            float cosine = glm::dot(direction_, normal);
            const auto reflect_at = [&](glm::vec3 n) {
                return direction_ - 2 * glm::dot(direction_, n) * n;
            };
            if (cosine > 0) {
                bend(normal, std::min(1.0f, cosine));
            }
            if (!(cosine > 0) || glm::dot(reflect_at(normal), flat) >= 0 ||
                glm::dot(refracted, flat) <= 0) {
                normal = flat;
                cosine = glm::dot(direction_, flat);
                bend(normal, std::min(1.0f, cosine));
            }
            if (!(random_.next() < transmittance(std::min(1.0f, cosine), ratio))) {
                is_reflected_ = true;
                position_ = hit.position - 2 * hit.error * flat;
                direction_ = glm::normalize(reflect_at(normal));
                return true;
            }
            direction_ = refracted;
        }
        has_changed_ = true;
        weight_.enter(beyond.top());
        return pass(hit, side, beyond);
    }

    bool arrive_at_boundary(const WalkHit& hit) {
        const glm::vec3 normal = inner_boundary_normal(space_, hit, direction_);
        const float cosine = std::min(1.0f, glm::dot(direction_, normal));
        const float passed = transmittance(cosine, 1 / space_.eta);
        const bool counts =
            scatterings_ >= orders_.least || (scatterings_ > 0 && (is_reflected_ || has_changed_));
        if (passed > 0 && (counts || (orders_.marks_once && scatterings_ > 0))) {
            leave(hit, normal, cosine, passed);
            exits_.back().is_once = !counts;
        }
        if (scatterings_ == 0 &&
            (orders_.fills_crossed || (!is_reflected_ && is_around_vertex(space_, hit, vertex_)))) {
            add_left(passed, counts_.filled);
        }
        add_left(passed, ends().left);
        is_reflected_ = true;
        position_ = hit.position - 2 * hit.error * hit.flat;
        direction_ = glm::normalize(direction_ - 2 * glm::dot(direction_, normal) * normal);
        return weight_.scale(1 - passed) && survives();
    }

    void leave(const WalkHit& hit, glm::vec3 normal, float cosine, float passed) {
        const auto outside = static_cast<float>(
            refracted_cosine(static_cast<double>(cosine), 1 / static_cast<double>(space_.eta)));
        const glm::vec3 along = space_.eta * (direction_ - cosine * normal);
        WalkExit exit;
        exit.position = hit.position;
        exit.normal = normal;
        exit.direction = glm::normalize(along + outside * normal);
        for (std::size_t b = 0; b < 3; ++b) {
            exit.weight[b] = passed * weight_.value()[b];
        }
        exit.turned = static_cast<float>(scatterings_) / static_cast<float>(space_.diffuse_after);
        exit.drift = length_ > 0 ? (hit.position - start_) / length_ : glm::vec3(0);
        exit.primitive = hit.primitive;
        exit.first_index = hit.first_index;
        exit.u = hit.u;
        exit.v = hit.v;
        exits_.push_back(exit);
    }

    bool survives() { return weight_.survives(weight_.is_at_risk() ? random_.next() : 0); }

    const WalkSpace& space_;
    BandWeights weight_;
    const WalkOrders& orders_;
    WalkRandom& random_;
    std::vector<WalkExit>& exits_;
    WalkCounts& counts_;

    glm::vec3 start_{0}, vertex_{0}, position_{0}, direction_{0};
    float length_ = 0;     // of the walk so far
    float clearance_ = 0;  // where it may jump [m]
    FreeBall free_;
    std::uint32_t scatterings_ = 0;
    bool is_reflected_ = false, has_changed_ = false;  // inside; medium
    MediumStack bodies_;
};

}  // namespace

glm::vec3 follow_walk(const WalkSpace& space, const WalkGroup& group, const WalkStart& start,
                      const WalkOrders& orders, WalkRandom& random, std::vector<WalkExit>& exits,
                      WalkCounts& counts) {
    return Walk(space, group, start, orders, random, exits, counts).follow(start);
}

}  // namespace opaline::bake
