#include "bake/effects/multiple/walks/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/frame.h"
#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/free_ball.h"
#include "bake/effects/multiple/walks/walk_boundary.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

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
          bodies_(
              start.around.value_or(MediumStack(space.place_of[space.material], start.shells))) {
        if (medium_here() != 0) {
            weight_.enter(medium_here());
        }
    }

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
        if (!bodies_.is_only(space_.place_of[space_.material])) {
            meet_other();
        }
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
            if (orders_.is_straight_alone && is_scattered_) return;
            if (!(may_jump() ? jump() : fly(flight_length()))) return;
        }
        give_up(counts_.endless);
    }

    // Lower bound [m] on the distance to the nearest surface.
    float clearance() const {
        return std::max(space_.clearance(position_), free_.least(position_));
    }

    const BallBank* balls() const {
        return medium_here() < space_.balls.size() ? space_.balls[medium_here()].get() : nullptr;
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
        take_as_scattered();
        scatterings_ += count;
    }

    void take_as_scattered() {
        if (is_scattered_) return;
        count_absorbed();
        add_left(1, counts_.scattered);
        is_scattered_ = true;
    }

    // Straight light in another body is what no other row holds.
    void meet_other() {
        if (orders_.crosses_others && !is_scattered_) {
            take_as_scattered();
            is_straight_ = true;
        }
    }

    // Of the light that the walk carries.
    WalkEnds& ends() { return is_scattered_ ? counts_.ends : counts_.straight; }

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

    // Off a thing inside. What has not scattered ends: `transmission` has it.
    bool reflect(const WalkHit& hit) {
        const auto found = reflect_at(space_, hit, direction_, random_.next());
        if (!found) return meet();
        length_ += glm::distance(hit.position, position_);
        free_.set(hit.position, 0, 0);
        is_reflected_ = true;
        position_ = hit.position + 2 * hit.error * found->normal;
        const float u = random_.next();
        direction_ = make_frame(found->normal).to_world(to_hemisphere(u, random_.next()));
        return weight_.absorb(found->albedo) && survives();
    }

    // A flight from the start. Where a body is thin, nearly all light crosses it unscattered and is
    // not counted: half of the walks scatter before the first surface (BandWeights).
    bool fly_first() {
        const float reach = weight_.first_reach();
        if (space_.clearance(position_) >= reach) return fly(flight_length());
        WalkHit hit;
        ++counts_.rays;
        // Beyond another medium's surface the walk may still scatter.
        if (space_.bodies || !find_hit(space_, position_, direction_, reach, hit) ||
            is_entered(hit)) {
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

    std::uint8_t medium_here() const { return space_.medium_at[bodies_.top()]; }
    const WalkMedium& medium() const { return space_.media[medium_here()]; }

    // Of another medium that walks go into.
    bool is_entered(const WalkHit& hit) const {
        return hit.medium != 0 && hit.medium != kNoWalkMedium;
    }

    bool arrive(const WalkHit& hit) {
        if (hit.medium == kNoWalkMedium) return is_scattered_ ? reflect(hit) : meet();
        const float way = glm::distance(hit.position, position_);
        length_ += way;
        free_.set(hit.position, 0, 0);
        const FarSide far =
            find_far_side(space_, bodies_, position_, direction_, way, hit, counts_.rays);
        if (!far.has_room) return give_up(counts_.buried);
        if (!hit.is_own || far.is_several) {
            meet_other();
        }
        if (far.bodies.empty()) {
            return hit.is_own || space_.bodies ? arrive_at_boundary(hit, far) : meet();
        }
        return space_.medium_at[far.bodies.top()] == medium_here() ? pass(hit, far)
                                                                   : change_medium(hit, far);
    }

    bool pass(const WalkHit& hit, const FarSide& far) {
        bodies_ = far.bodies;
        position_ = hit.position + far.side * far.lift * hit.flat;
        return true;
    }

    // Light of one surface is either reflected or refracted, as Fresnel's reflectance says, with
    // unchanged weights.
    bool change_medium(const WalkHit& hit, const FarSide& far) {
        const std::uint8_t beyond = space_.medium_at[far.bodies.top()];
        const float ratio = space_.media[beyond].eta / medium().eta;
        meet_other();
        if (!is_matched(ratio)) {
            const Bend bend = bend_at(far.side * smooth_normal(space_, hit), far.side * hit.flat,
                                      direction_, ratio);
            if (!(random_.next() < bend.passed)) {
                is_reflected_ = true;
                position_ = hit.position - far.side * far.lift * hit.flat;
                direction_ = bend.reflected;
                return true;
            }
            direction_ = bend.refracted;
        }
        has_changed_ = true;
        weight_.enter(beyond);
        return pass(hit, far);
    }

    bool arrive_at_boundary(const WalkHit& hit, const FarSide& far) {
        const glm::vec3 flat = far.side * hit.flat;
        const glm::vec3 normal =
            far.side > 0 ? inner_boundary_normal(space_, hit, direction_) : flat;
        const float cosine = std::min(1.0f, glm::dot(direction_, normal));
        const float passed = boundary_transmittance(cosine, 1 / medium().eta);
        const bool counts = scatterings_ >= orders_.least || is_straight_ ||
                            (scatterings_ > 0 && (is_reflected_ || has_changed_));
        if (passed > 0 && (counts || (orders_.marks_once && scatterings_ > 0))) {
            leave(hit, normal, cosine, passed);
            exits_.back().is_once = !counts;
        }
        if (!is_scattered_ &&
            (orders_.fills_crossed || (!is_reflected_ && is_around_vertex(space_, hit, vertex_)))) {
            add_left(passed, counts_.filled);
        }
        add_left(passed, ends().left);
        is_reflected_ = true;
        position_ = hit.position - far.lift * flat;
        direction_ = glm::normalize(direction_ - 2 * glm::dot(direction_, normal) * normal);
        return weight_.scale(1 - passed) && survives();
    }

    void leave(const WalkHit& hit, glm::vec3 normal, float cosine, float passed) {
        const float eta = medium().eta;
        const auto outside = static_cast<float>(
            refracted_cosine(static_cast<double>(cosine), 1 / static_cast<double>(eta)));
        const glm::vec3 along = eta * (direction_ - cosine * normal);
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
        exit.material = hit.place == bodies_.top()
                            ? space_.scene->primitives[hit.primitive].material
                            : space_.material_at[bodies_.top()];
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
    bool is_scattered_ = false;                        // or taken for it
    bool is_straight_ = false;  // it went through another body before it scattered
    MediumStack bodies_;
};

}  // namespace

glm::vec3 follow_walk(const WalkSpace& space, const WalkGroup& group, const WalkStart& start,
                      const WalkOrders& orders, WalkRandom& random, std::vector<WalkExit>& exits,
                      WalkCounts& counts) {
    return Walk(space, group, start, orders, random, exits, counts).follow(start);
}

}  // namespace opaline::bake
