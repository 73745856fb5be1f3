#include "bake/effects/multiple/walks/band_weights.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr float kMostExponent = 80;  // e to that is finite
constexpr float kThin = 0.6931472f;  // optical depth where half scatters by itself

bool is_split(float sigma_t, float distance) {
    return distance * sigma_t <= kThin;
}

float crossing_chance(float sigma_t, float distance) {
    return is_split(sigma_t, distance) ? 0.5f : std::exp(-sigma_t * distance);
}

}  // namespace

BandWeights::BandWeights(const WalkSpace& space, const WalkGroup& group)
    : space_(space), groups_(space.bands.size()), flies_as_(group.flies_as) {
    enter(0);
    bool may_split = true;
    for (std::size_t g = 0; g < groups_; ++g) {
        const float sigma_t = medium_->sigma_t[g];
        all_walks_ += group.walks[g];
        may_split = may_split && sigma_t > 0;
        first_reach_ = std::max(first_reach_, kThin / sigma_t);
        for (std::size_t b = 0; b < 3; ++b) {
            if (space.bands[g].member[b]) {
                group_[b] = g;
                // What crosses several clear bodies counts as well.
                has_light_[b] = space.media.size() > 1 || space.media.front().albedo[b] > 0;
            }
        }
    }
    first_reach_ = may_split ? first_reach_ : 0;
    for (std::size_t g = 0; g < groups_; ++g) {
        density_[g] = group.walks[g] / all_walks_;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        own_[b] = has_light_[b] ? 1 : 0;
        value_[b] = own_[b] / all_walks_;
    }
}

void BandWeights::enter(std::uint8_t medium) {
    medium_ = &space_.media[medium];
    sigma_t_ = medium_->sigma_t[flies_as_];
    if (groups_ > 1) {
        for (std::size_t g = 0; g < groups_; ++g) {
            // Without extinction no flight is drawn that ends in a collision.
            log_ratio_[g] = sigma_t_ > 0 ? std::log(medium_->sigma_t[g]) - std::log(sigma_t_) : 0;
        }
    }
}

double BandWeights::left() const {
    double sum = 0, bands = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += static_cast<double>(value_[b]);
        bands += has_light_[b] ? 1 : 0;
    }
    return static_cast<double>(all_walks_) * sum / std::max(1.0, bands);
}

std::array<double, 3> BandWeights::take_absorbed() {
    std::array<double, 3> taken{};
    for (std::size_t b = 0; b < 3; ++b) {
        taken[b] = static_cast<double>(all_walks_) * static_cast<double>(absorbed_[b]);
    }
    absorbed_ = {};
    return taken;
}

// Of a band the share `kept` goes on, and the rest is absorbed.
void BandWeights::lose(std::size_t band, float kept) {
    absorbed_[band] += (1 - kept) * value_[band];
    value_[band] *= kept;
    own_[band] *= kept;
}

// The density of a flight in each group over its density in the group that drew it, times `scale`.
BandWeights::PerGroup BandWeights::flight_factors(float length, bool collides, float scale) const {
    const float log_scale = scale == 1 ? 0 : std::log(scale);
    PerGroup factors{1, 1, 1};
    for (std::size_t g = 0; g < groups_; ++g) {
        float exponent = (sigma_t_ - medium_->sigma_t[g]) * length + log_scale;
        exponent = collides ? exponent + log_ratio_[g] : exponent;
        // 0 in the group that the flight is drawn from.
        factors[g] = exponent == 0 ? 1 : std::exp(std::min(kMostExponent, exponent));
    }
    return factors;
}

bool BandWeights::reweigh(const PerGroup& light, const PerGroup& density) {
    float sum = 0;
    for (std::size_t g = 0; g < groups_; ++g) {
        density_[g] *= density[g];
        sum += density_[g];
    }
    constexpr float kLeast = 1e-30f;  // smaller probabilities underflow
    if (!(sum > kLeast)) return false;
    for (float& d : density_) {
        d /= sum;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        value_[b] = value_[b] * light[group_[b]] / sum;  // in this order: finite
    }
    return left() > 0;
}

bool BandWeights::fly(float length, bool collides) {
    if (groups_ > 1) {
        const PerGroup factors = flight_factors(length, collides, 1);
        if (!reweigh(factors, factors)) return false;
    }
    return !medium_->absorbs_in_flight || absorb_in_flight(length);
}

bool BandWeights::cross_ball(float length, float scatterings) {
    if (groups_ > 1) {
        // Densities of hundreds of flights underflow. Only their ratios are computed.
        PerGroup factors{};
        float most = 0;
        for (std::size_t g = 0; g < groups_; ++g) {
            factors[g] = (sigma_t_ - medium_->sigma_t[g]) * length +
                         (scatterings > 0 ? scatterings * log_ratio_[g] : 0);
            most = std::max(most, factors[g] + std::log(density_[g]));
        }
        for (float& factor : factors) {
            factor = std::exp(std::min(kMostExponent, factor - most));
        }
        if (!reweigh(factors, factors)) return false;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        if (own_[b] > 0) {
            lose(b, std::pow(medium_->albedo[b], scatterings));
        }
    }
    return medium_->absorbs_in_flight ? absorb_in_flight(length) : left() > 0;
}

// Bands that are not scattered here.
bool BandWeights::absorb_in_flight(float length) {
    for (std::size_t b = 0; b < 3; ++b) {
        lose(b, std::exp(-medium_->absorption[b] * length));
    }
    return left() > 0;
}

float BandWeights::first_crossing_chance(float distance) const {
    return crossing_chance(sigma_t_, distance);
}

bool BandWeights::cross_first(float distance) {
    const float chance = crossing_chance(sigma_t_, distance);
    PerGroup light{}, density{};
    for (std::size_t g = 0; g < groups_; ++g) {
        const float sigma_t = medium_->sigma_t[g], crossing = std::exp(-sigma_t * distance);
        light[g] = crossing / chance;
        density[g] = crossing_chance(sigma_t, distance) / chance;
        own_full_[g] = is_split(sigma_t, distance) ? 2 * crossing : 1;
    }
    return begin(light, density);
}

bool BandWeights::collide_first(float length, float distance) {
    const auto scattered = [&](float sigma_t) { return -std::expm1(-sigma_t * distance); };
    const auto chance = [&](float sigma_t) {
        return is_split(sigma_t, distance) ? 0.5f : scattered(sigma_t);
    };
    const PerGroup light = flight_factors(length, true, scattered(sigma_t_) / chance(sigma_t_));
    PerGroup density{};
    for (std::size_t g = 0; g < groups_; ++g) {
        const float sigma_t = medium_->sigma_t[g];
        own_full_[g] = scattered(sigma_t) / chance(sigma_t);
        density[g] = own_full_[g] > 0 ? light[g] / own_full_[g] : 0;
    }
    return begin(light, density);
}

bool BandWeights::begin(const PerGroup& light, const PerGroup& density) {
    for (std::size_t b = 0; b < 3; ++b) {
        own_[b] *= own_full_[group_[b]];
    }
    return reweigh(light, density);
}

bool BandWeights::absorb(const std::array<float, 3>& albedo) {
    for (std::size_t b = 0; b < 3; ++b) {
        lose(b, albedo[b]);
    }
    return left() > 0;
}

bool BandWeights::scale(float factor) {
    for (std::size_t b = 0; b < 3; ++b) {
        value_[b] *= factor;
        own_[b] *= factor;
    }
    return left() > 0;
}

float BandWeights::survival_chance(std::size_t group) const {
    constexpr float kSmall = 0.4f, kAfter = 0.8f, kLeast = 1e-6f;
    float largest = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        largest = std::max(largest, group_[b] == group ? own_[b] : 0);
    }
    const float chance =
        largest < kSmall * own_full_[group] ? largest / (kAfter * own_full_[group]) : 1;
    return chance < kLeast ? 0 : chance;
}

bool BandWeights::survives(float u) {
    PerGroup chance{}, light{}, density{};
    bool risks = false;
    for (std::size_t g = 0; g < groups_; ++g) {
        chance[g] = survival_chance(g);
        risks |= chance[g] < 1;
    }
    if (!risks) return true;
    const float own = chance[flies_as_];
    if (!(u < own)) return false;
    for (std::size_t g = 0; g < groups_; ++g) {
        light[g] = 1 / own;
        density[g] = chance[g] / own;
    }
    for (std::size_t b = 0; b < 3; ++b) {
        own_[b] /= chance[group_[b]] > 0 ? chance[group_[b]] : 1;
    }
    return reweigh(light, density);
}

}  // namespace opaline::bake
