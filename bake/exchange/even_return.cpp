#include "bake/exchange/even_return.h"

#include <algorithm>
#include <cmath>

#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// [m], the longest of the bands'.
double transport_length(const formats::Medium& medium) {
    const double forward = formats::mean_cosine(medium.phase);
    const auto length = [&](float sigma_s, float sigma_a) {
        return 1 / std::max((1 - forward) * double{sigma_s} + double{sigma_a}, 1e-12);
    };
    return std::max({length(medium.sigma_s.r, medium.sigma_a.r),
                     length(medium.sigma_s.g, medium.sigma_a.g),
                     length(medium.sigma_s.b, medium.sigma_a.b)});
}

}  // namespace

void EvenReturn::Flux::add(const Flux& other, double weight) {
    arriving += weight * other.arriving;
    for (std::size_t b = 0; b < leaving.size(); ++b) {
        leaving[b] += weight * other.leaving[b];
    }
}

// Points are summed up in cubes of four transport mean free paths; around a point are its cube and
// those that touch it.
EvenReturn::EvenReturn(const formats::Medium& medium) : side_(4 * transport_length(medium)) {}

EvenReturn::Cube EvenReturn::cube_of(glm::vec3 position) const {
    constexpr double kFarthest = 0x1p52;
    const auto at = [&](float x) {
        return static_cast<std::int64_t>(
            std::clamp(std::floor(double{x} / side_), -kFarthest, kFarthest));
    };
    return {at(position.x), at(position.y), at(position.z)};
}

void EvenReturn::add(glm::vec3 position, float arriving, const BandColour& leaving) {
    const Flux own{double{arriving}, {double{leaving[0]}, double{leaving[1]}, double{leaving[2]}}};
    cubes_[cube_of(position)].add(own, 1);
    all_.add(own, 1);
    count_ += 1;
}

BandColour EvenReturn::share(glm::vec3 position) const {
    constexpr double kOfAll = 4;  // weight of the mean over all points, in points
    Flux sum;
    if (count_ > 0) {
        sum.add(all_, kOfAll / count_);
    }
    const Cube own = cube_of(position);
    for (std::int64_t n = 0; n < 27; ++n) {
        const auto near =
            cubes_.find({own[0] + n % 3 - 1, own[1] + n / 3 % 3 - 1, own[2] + n / 9 - 1});
        if (near != cubes_.end()) {
            sum.add(near->second, 1);
        }
    }
    BandColour share{};
    for (std::size_t b = 0; b < share.size(); ++b) {
        share[b] = sum.arriving > 0
                       ? static_cast<float>(std::clamp(sum.leaving[b] / sum.arriving, 0.0, 1.0))
                       : 0;
    }
    return share;
}

}  // namespace opaline::bake
