#include "bake/effects/multiple/walks/walk_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/physics/fresnel.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// Of walks in a cube of that diagonal as the albedo tends to 1: eta^2 4 V / (S mean_free_path
// escape) (README.md, "The estimator").
double mean_events(std::span<const WalkMedium> media, float diagonal) {
    float densest = 0;
    double escape = 1, eta = 0;
    for (const WalkMedium& medium : media) {
        densest = std::max({densest, medium.sigma_t[0], medium.sigma_t[1], medium.sigma_t[2]});
        eta = std::max(eta, static_cast<double>(medium.eta));
        escape = std::min(escape, 1 - fresnel_moments(static_cast<double>(medium.eta)).external);
    }
    return std::max(1.0, eta * eta) * static_cast<double>(diagonal) * static_cast<double>(densest) /
           std::max(1e-3, escape);
}

int count_along(const WalkSpace& space, glm::vec3 point, glm::vec3 direction) {
    constexpr int kMostCrossings = 10000;  // ends a line that rounding holds up
    int shells = 0;
    WalkHit hit;
    for (int i = 0; i < kMostCrossings &&
                    find_hit(space, point, direction, std::numeric_limits<float>::infinity(), hit);
         ++i) {
        const bool leaves = glm::dot(direction, hit.flat) > 0;
        if (hit.is_own) {
            shells += leaves ? 1 : -1;
        }
        point = hit.position + (leaves ? 2 : -2) * hit.error * hit.flat;
    }
    return shells;
}

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
    if (std::ranges::all_of(sigma_t, [](float s) { return s == 0; })) return;
    std::size_t group = 0;
    const auto fits = [&] {
        for (std::size_t m = 0; m < sigma_t.size(); ++m) {
            if (!is_alike(all.media[m].sigma_t[group], sigma_t[m])) return false;
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

WalkSpace make_walk_space(const formats::Scene& scene, const EmbreeScene& triangles,
                          std::uint32_t material, bool grey, std::span<const std::uint32_t> inner,
                          bool meet) {
    std::vector<std::uint32_t> materials{material};
    materials.insert(materials.end(), inner.begin(), inner.end());
    std::vector<const formats::Medium*> given;
    given.reserve(materials.size());
    for (const std::uint32_t m : materials) {
        given.push_back(&*scene.materials[m].medium);
    }
    WalkMedia media = make_walk_media(given, grey);
    WalkSpace space;
    space.scene = &scene;
    space.triangles = &triangles;
    space.material = material;
    space.eta = given.front()->eta;
    space.is_grey = grey;
    space.bands = std::move(media.bands);
    space.media = std::move(media.media);
    space.medium_of.assign(scene.materials.size(), kNoWalkMedium);
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const std::uint8_t place = media.place[m];
        space.medium_of[materials[m]] = place;
        if (given[m]->variation && place != kNoWalkMedium && !space.bands.empty()) {
            space.media[place].field.emplace(scene, materials[m]);
        }
    }
    const BodiesAt bodies(scene, triangles);
    space.place_of.assign(scene.materials.size(), kNoPlace);
    for (const std::uint32_t m : bodies.order()) {
        if (space.medium_of[m] == kNoWalkMedium) continue;
        if (space.medium_at.empty() || space.medium_at.back() != space.medium_of[m]) {
            space.medium_at.push_back(space.medium_of[m]);
            space.material_at.push_back(m);
        }
        space.place_of[m] = static_cast<std::uint16_t>(space.medium_at.size() - 1);
    }
    std::vector<std::uint8_t> is_member;
    for (const std::uint8_t medium : space.medium_of) {
        is_member.push_back(medium != kNoWalkMedium ? 1 : 0);
    }
    if (meet || bodies.has_faces_on_faces(scene, is_member)) {
        space.bodies.emplace(bodies);
    }
    // Three that are effectively isotropic (README.md, "The light at an exit"). Where media follow
    // one another, the length of a walk does not predict its direction.
    space.diffuse_after =
        space.media.size() > 1
            ? std::numeric_limits<std::uint32_t>::max()
            : static_cast<std::uint32_t>(std::ceil(
                  3 / (1 - std::min(0.999, std::abs(formats::mean_cosine(given.front()->phase))))));
    space.low = glm::vec3(std::numeric_limits<float>::max());
    space.high = glm::vec3(std::numeric_limits<float>::lowest());
    for (const formats::Primitive& p : scene.primitives) {
        if (space.medium_of[p.material] != kNoWalkMedium) {
            for (const std::uint32_t i : p.index) {
                space.low = glm::min(space.low, p.position[i]);
                space.high = glm::max(space.high, p.position[i]);
            }
        }
    }
    if (!(space.low.x <= space.high.x)) {
        space.bands.clear();
        return space;
    }
    const glm::vec3 size = space.high - space.low;
    const float diagonal = glm::length(size);
    space.low -= glm::vec3(1e-3f * diagonal);
    space.high += glm::vec3(1e-3f * diagonal);
    constexpr float kCell = 0.01f;  // of the diagonal
    space.clearance = ClearanceGrid(scene, 0.5f * (space.low + space.high),
                                    0.5f * (space.high - space.low), kCell * diagonal);
    space.cell = kCell * diagonal;
    space.mean_events = mean_events(space.media, diagonal);
    // A hundred times the mean is no walk that goes on for good.
    space.most_events =
        static_cast<std::uint32_t>(std::min(1000 + 100 * space.mean_events, 200000.0));
    return space;
}

MediumStack bodies_at_start(const WalkSpace& space, glm::vec3 point) {
    return bodies_at_start(*space.bodies, space.place_of, space.place_of[space.material], point);
}

int count_shells(const WalkSpace& space, glm::vec3 point, glm::vec3 direction) {
    // Along no axis, edge or diagonal of common models.
    const std::array<glm::vec3, 5> lines{direction,
                                         {0.36f, 0.48f, 0.8f},
                                         {-0.8f, 0.36f, -0.48f},
                                         {0.48f, -0.8f, 0.36f},
                                         {-0.64f, -0.48f, 0.6f}};
    std::array<int, lines.size()> found{};
    for (std::size_t l = 0; l < lines.size(); ++l) {
        found[l] = count_along(space, point, lines[l]);
        const auto end = found.begin() + static_cast<std::ptrdiff_t>(l);
        if (std::find(found.begin(), end, found[l]) != end) return found[l];
    }
    return found.front();
}

double transport_mean_free_path(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    double densest = 0;
    const auto visit = [&](float sigma_s, float sigma_a) {
        if (sigma_s > 0) {
            densest = std::max(
                densest, (1 - g) * static_cast<double>(sigma_s) + static_cast<double>(sigma_a));
        }
    };
    visit(medium.sigma_s.r, medium.sigma_a.r);
    visit(medium.sigma_s.g, medium.sigma_a.g);
    visit(medium.sigma_s.b, medium.sigma_a.b);
    return densest > 0 ? 1 / densest : 0;
}

double shortest_transport_path(std::span<const formats::Medium* const> media) {
    double least = 0;
    for (const formats::Medium* medium : media) {
        const double path = transport_mean_free_path(*medium);
        least = path > 0 && (least == 0 || path < least) ? path : least;
    }
    return least;
}

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
