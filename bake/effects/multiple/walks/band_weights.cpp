#include "bake/effects/multiple/walks/band_weights.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr float kThin = 0.6931472f;  // optical depth where half scatters by itself

float collision_chance(float sigma_t, float distance) {
    return distance * sigma_t <= kThin ? 0.5f : -std::expm1(-sigma_t * distance);
}

}  // namespace

BandWeights::BandWeights(const WalkSpace& space, const WalkGroup& group)
    : space_(space), sigma_t_(space.bands[group.flies_as].sigma_t) {
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        const WalkBands& bands = space.bands[g];
        all_walks_ += group.walks[g];
        first_reach_ = std::max(first_reach_, kThin / bands.sigma_t);
        log_ratio_[g] = std::log(bands.sigma_t) - std::log(sigma_t_);
        for (std::size_t b = 0; b < 3; ++b) {
            if (bands.member[b]) {
                group_[b] = g;
                albedo_[b] = bands.albedo[b];
            }
        }
    }
    full_ = 1 / all_walks_;
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        density_[g] = group.walks[g] / all_walks_;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        value_[b] = albedo_[b] > 0 ? full_ : 0;
    }
}

float BandWeights::largest() const {
    return std::max({value_[0], value_[1], value_[2]});
}

double BandWeights::left() const {
    double sum = 0, bands = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += static_cast<double>(value_[b]);
        bands += albedo_[b] > 0 ? 1 : 0;
    }
    return static_cast<double>(all_walks_) * sum / std::max(1.0, bands);
}

// What a flight is worth in each group, over what it is worth in the one it is drawn from.
BandWeights::PerGroup BandWeights::flight_factors(float length, bool collides) const {
    constexpr float kMost = 80;  // e to that is finite
    PerGroup factors{1, 1, 1};
    for (std::size_t g = 0; g < space_.bands.size(); ++g) {
        const float exponent = (sigma_t_ - space_.bands[g].sigma_t) * length;
        factors[g] = std::exp(std::min(kMost, collides ? exponent + log_ratio_[g] : exponent));
    }
    return factors;
}

bool BandWeights::reweigh(const PerGroup& light, const PerGroup& density) {
    float sum = 0;
    for (std::size_t g = 0; g < space_.bands.size(); ++g) {
        density_[g] *= density[g];
        sum += density_[g];
    }
    if (!(sum > 0)) {
        return false;  // so unlikely that numbers do not tell
    }
    for (float& d : density_) {
        d /= sum;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        value_[b] *= light[group_[b]] / sum;
    }
    return largest() > 0;
}

bool BandWeights::fly(float length, bool collides) {
    if (space_.bands.size() == 1) {
        return true;
    }
    const PerGroup factors = flight_factors(length, collides);
    return reweigh(factors, factors);
}

float BandWeights::first_collision_chance(float distance) const {
    return collision_chance(sigma_t_, distance);
}

bool BandWeights::cross_first(float distance) {
    const float own = 1 - first_collision_chance(distance);
    PerGroup light{}, density{};
    for (std::size_t g = 0; g < space_.bands.size(); ++g) {
        const float sigma_t = space_.bands[g].sigma_t;
        light[g] = std::exp(-sigma_t * distance) / own;
        density[g] = (1 - collision_chance(sigma_t, distance)) / own;
    }
    const bool goes_on = reweigh(light, density);
    full_ = largest();
    return goes_on;
}

bool BandWeights::collide_first(float length, float distance) {
    const float own = -std::expm1(-sigma_t_ * distance) / first_collision_chance(distance);
    PerGroup light = flight_factors(length, true), density = light;
    for (std::size_t g = 0; g < space_.bands.size(); ++g) {
        const float sigma_t = space_.bands[g].sigma_t;
        const float scattered = -std::expm1(-sigma_t * distance);
        light[g] *= own;
        density[g] *= scattered > 0 ? own * collision_chance(sigma_t, distance) / scattered : 0;
    }
    const bool goes_on = reweigh(light, density);
    full_ = largest();
    return goes_on;
}

bool BandWeights::absorb() {
    for (std::size_t b = 0; b < 3; ++b) {
        value_[b] *= albedo_[b];
    }
    return largest() > 0;
}

bool BandWeights::scale(float factor) {
    for (float& v : value_) {
        v *= factor;
    }
    return largest() > 0;
}

}  // namespace opaline::bake
