#include "bake/effects/multiple/walks/walk_media.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

std::array<float, 3> bands_of(const formats::Rgb& c) {
    return {c.r, c.g, c.b};
}

// Extinction [1/m] of the flights of a band; 0 where it is not scattered.
float flight_extinction(const formats::Medium& medium, std::size_t band) {
    const float sigma_s = bands_of(medium.sigma_s)[band];
    return sigma_s > 0 ? sigma_s + bands_of(medium.sigma_a)[band] : 0;
}

// Walks of media whose extinctions differ by less are the same to rounding.
bool is_alike(float group, float band) {
    constexpr float kSame = 1e-5f;
    return std::abs(group - band) <= kSame * band;
}

// Adds a band to the group that flies like it in all media, or to a group of its own.
void add_band(std::size_t band, std::span<const formats::Medium* const> distinct, WalkMedia& all) {
    std::vector<float> sigma_t;
    for (const formats::Medium* medium : distinct) {
        sigma_t.push_back(flight_extinction(*medium, band));
    }
    if (std::ranges::all_of(sigma_t, [](float s) { return s == 0; })) {
        return;
    }
    std::size_t group = 0;
    const auto fits = [&] {
        for (std::size_t m = 0; m < sigma_t.size(); ++m) {
            if (!is_alike(all.media[m].sigma_t[group], sigma_t[m])) {
                return false;
            }
        }
        return true;
    };
    while (group < all.bands.size() && !fits()) {
        ++group;
    }
    if (group == all.bands.size()) {
        all.bands.push_back({sigma_t[0], {}, {}});
        for (std::size_t m = 0; m < sigma_t.size(); ++m) {
            all.media[m].sigma_t[group] = sigma_t[m];
        }
    }
    all.bands[group].member[band] = true;
    for (std::size_t m = 0; m < sigma_t.size(); ++m) {
        if (sigma_t[m] > 0) {
            all.media[m].albedo[band] = bands_of(distinct[m]->sigma_s)[band] / sigma_t[m];
        } else {
            all.media[m].absorption[band] = bands_of(distinct[m]->sigma_a)[band];
        }
    }
    all.bands[group].albedo[band] = all.media[0].albedo[band];
}

}  // namespace

bool is_same_medium(const formats::Medium& a, const formats::Medium& b) {
    const auto same = [](const formats::Rgb& x, const formats::Rgb& y) {
        return x.r == y.r && x.g == y.g && x.b == y.b;
    };
    return !a.variation && !b.variation && same(a.sigma_s, b.sigma_s) &&
           same(a.sigma_a, b.sigma_a) && a.eta == b.eta && a.phase.type == b.phase.type &&
           a.phase.g == b.phase.g && a.phase.rms_angle == b.phase.rms_angle &&
           a.phase.cosine == b.phase.cosine && a.phase.value == b.phase.value;
}

WalkMedia make_walk_media(std::span<const formats::Medium* const> given, bool grey) {
    WalkMedia all;
    std::vector<const formats::Medium*> distinct;
    for (const formats::Medium* medium : given) {
        const auto found = std::ranges::find_if(
            distinct, [&](const formats::Medium* d) { return is_same_medium(*d, *medium); });
        if (found != distinct.end()) {
            all.place.push_back(static_cast<std::uint8_t>(found - distinct.begin()));
        } else if (distinct.size() == kMostWalkMedia) {
            all.place.push_back(kNoWalkMedium);
        } else {
            all.place.push_back(static_cast<std::uint8_t>(distinct.size()));
            distinct.push_back(medium);
            all.media.push_back({.eta = medium->eta, .phase = make_phase_table(medium->phase)});
        }
    }
    for (std::size_t b = 0; b < (grey ? 1 : 3); ++b) {
        add_band(b, distinct, all);
    }
    for (WalkMedium& medium : all.media) {
        medium.absorbs_in_flight =
            std::ranges::any_of(medium.absorption, [](float a) { return a > 0; });
    }
    return all;
}

}  // namespace opaline::bake
