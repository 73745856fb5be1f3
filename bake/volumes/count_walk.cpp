#include "bake/volumes/count_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/rng.h"

namespace opaline::bake {

float CostRandom::operator()() {
    if (used_ == number_.size()) {
        number_ = random_uniform(0, RandomStage::volume_costs, sample_, draw_++);
        used_ = 0;
    }
    return number_[used_++];
}

glm::vec3 CostRandom::direction() {
    const float z = 1 - 2 * (*this)(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * (*this)();
    return {r * std::cos(angle), r * std::sin(angle), z};
}

WalkCount count_walk(const DensitySpace& space, glm::vec3 at, CostRandom& random) {
    constexpr float kForever = std::numeric_limits<float>::infinity();
    constexpr float kRoulette = 0.25f;
    constexpr std::size_t kGreen = 1;
    constexpr int kMost = 2048;
    WalkCount count;
    glm::vec3 direction = random.direction();
    float weight = 1;
    for (int n = 0; n < kMost; ++n) {
        ++count.flights;
        const Collision hit = sample_flight(space, kGreen, at, direction, kForever, random);
        if (!hit.happens) {
            break;
        }
        at += hit.distance * direction;
        const DensityVolume& own = space.volumes[hit.volume];
        weight *= own.albedo_at(at)[kGreen];
        if (weight < kRoulette) {
            if (random() * kRoulette >= weight) {
                break;
            }
            weight = kRoulette;
        }
        ++count.collisions;
        const SampledCosine sampled = sample_scaled(own.phase, random());
        const float sine = std::sqrt(std::max(0.0f, 1 - sampled.cosine * sampled.cosine));
        const float angle = 2 * std::numbers::pi_v<float> * random();
        direction = glm::normalize(make_frame(direction).to_world(
            {sine * std::cos(angle), sine * std::sin(angle), sampled.cosine}));
    }
    return count;
}

}  // namespace opaline::bake
