#include "bake/effects/transmission/straight_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/effects/transmission/view_fit.h"
#include "bake/exchange/seen_light.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// The light of exits over the cube map, row by row.
class Splat {
  public:
    Splat(const DenseRow& row, std::uint32_t terms, double cosine)
        : row_(row),
          terms_(terms),
          solid_angle_(formats::texel_solid_angles(row.cubemap_size)),
          dense_(std::size_t{terms} * row.bands * row.size()) {
        for (std::uint32_t s = 0; s < kParts; ++s) {
            const double c = 1 - (1 - cosine) * (s + 0.5) / kParts, sine = std::sqrt(1 - c * c);
            const double azimuth = 2 * std::numbers::pi * s * (std::numbers::phi - 1);
            disc_[s] = glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), c));
        }
    }

    // `factor`: of each row. The texels' values are means of densities: a part of the exit's light
    // over the texel's solid angle.
    void add(const StraightExit& exit, std::span<const float> factor) {
        const Frame frame = make_frame(exit.direction);
        const std::size_t face = solid_angle_.size();
        const std::size_t values = std::size_t{terms_} * row_.bands;
        std::array<float, kMostValues> value;
        for (std::uint32_t k = 0; k < terms_; ++k) {
            for (std::uint32_t b = 0; b < row_.bands; ++b) {
                value[k * row_.bands + b] = factor[k] * exit.weight[b];
            }
        }
        for (const glm::vec3& part : disc_) {
            const glm::vec3 w = frame.to_world(part);
            const std::size_t j = formats::texel_index(row_.cubemap_size, {w.x, w.y, w.z});
            const auto density = static_cast<float>(1 / (kParts * solid_angle_[j % face]));
            float* const to = &dense_[j * values];
            for (std::size_t i = 0; i < values; ++i) {
                to[i] += density * value[i];
            }
        }
    }

    // Limits each texel's rows. What this takes from their sum over texels is returned to all
    // texels in proportion to their mean: each view shows as much of even light as before.
    void limit(const NonNegativeViews& limit) {
        const std::size_t texels = row_.size();
        std::vector<double> mean(texels), taken(terms_);
        for (std::uint32_t b = 0; b < row_.bands; ++b) {
            double sum = 0;
            std::fill(taken.begin(), taken.end(), 0.0);
            for (std::size_t j = 0; j < texels; ++j) {
                const double area = solid_angle_[j % solid_angle_.size()];
                add_totals(j, b, area, taken);
                mean[j] = limit.apply(&at(j, 0, b), row_.bands);
                add_totals(j, b, -area, taken);
                sum += area * mean[j];
            }
            for (std::size_t j = 0; j < texels && sum > 0; ++j) {
                for (std::uint32_t k = 0; k < terms_; ++k) {
                    at(j, k, b) += static_cast<float>(taken[k] * mean[j] / sum);
                }
            }
        }
    }

    // To the rows from the first one on.
    void add_to(const DenseRow& row) const {
        const std::size_t values = std::size_t{terms_} * row_.bands;
        std::vector<float> own(row.size());
        for (std::uint32_t k = 0; k < terms_; ++k) {
            for (std::uint32_t b = 0; b < row.bands; ++b) {
                for (std::size_t j = 0; j < own.size(); ++j) {
                    own[j] = dense_[j * values + k * row_.bands + b];
                }
                formats::haar_forward_cube(std::span<float>(own), row.cubemap_size);
                const std::span<float> to = row.plane(k, b);
                for (std::size_t j = 0; j < own.size(); ++j) {
                    to[j] += own[j];
                }
            }
        }
    }

  private:
    float& at(std::size_t texel, std::uint32_t k, std::uint32_t band) {
        return dense_[(texel * terms_ + k) * row_.bands + band];
    }

    void add_totals(std::size_t texel, std::uint32_t band, double area, std::span<double> total) {
        for (std::uint32_t k = 0; k < terms_; ++k) {
            total[k] += area * static_cast<double>(at(texel, k, band));
        }
    }

    static constexpr std::uint32_t kParts = 16;
    static constexpr std::size_t kMostValues = 27;  // nine harmonics in three bands

    const DenseRow& row_;
    std::uint32_t terms_;
    std::vector<double> solid_angle_;
    std::array<glm::vec3, kParts> disc_{};
    std::vector<float> dense_;  // texel by texel
};

// The views of a point and what they find.
struct PointViews {
    TransmissionViews set;
    StraightLight found;
};

// The same spiral around every normal: spirals turned at random each miss something else, which
// draws dots.
PointViews follow_views(const StraightBody& body, const BodyPoint& point,
                        const StraightStart& start, std::uint32_t views, std::uint64_t& rays) {
    PointViews own;
    own.set = spread_views(point.normal, body.eta, views, {0.5f, 0.5f});
    rays += follow_straight(body, start, own.set.seen, own.found);
    leave_out(own.set, own.found.past);
    return own;
}

// Of even light, what arrives from the sky and from surfaces, in the brightest band.
double share_found(const PointViews& own, std::uint32_t bands) {
    std::array<double, 3> share{};
    for (const auto* exits : {&own.found.exits, &own.found.blocked, &own.found.inside}) {
        for (const StraightExit& exit : *exits) {
            for (std::uint32_t b = 0; b < bands; ++b) {
                share[b] += own.set.weight[exit.view] * static_cast<double>(exit.weight[b]);
            }
        }
    }
    return *std::max_element(share.begin(), share.end());
}

PointViews follow_enough(const StraightBody& body, const BodyPoint& point, std::uint32_t views,
                         std::uint64_t& rays) {
    constexpr double kLittle = 0.02;
    const StraightStart start = make_straight_start(body, point, rays);
    PointViews own = follow_views(body, point, start, views, rays);
    return share_found(own, body.bands) > kLittle
               ? follow_views(body, point, start, kFinerViews * views, rays)
               : own;
}

// Factors of the rows of `layout` for each view.
std::vector<float> fit_rows(const TransmissionViews& views, const RowLayout& layout) {
    const std::uint32_t terms = straight_terms(layout);
    std::vector<float> factors = fit_views(views, terms);
    if (terms > 1) return factors;
    for (float& factor : factors) {
        factor /= static_cast<float>(layout.view_of_constant());
    }
    return factors;
}

// Under a sun at one rim of the views, a fit of degree 1 shows three times its mean light, below
// zero, at the other rim. Nine rows would lose too much of how views differ.
constexpr std::uint32_t kLimitedTerms = 4;

// [sr], of one of so many views.
double solid_angle_of(double views) {
    return 2 * std::numbers::pi * (1 - spread_cosine(views));
}

}  // namespace

double spread_cosine(double views) {
    return 1 - 1 / views;
}

std::uint32_t straight_terms(const RowLayout& layout) {
    constexpr std::uint32_t kMost = 9;
    return layout.separate || layout.at_entry
               ? 1
               : std::clamp(layout.all_harmonics(), std::uint32_t{1}, kMost);
}

std::uint64_t add_straight(const StraightBody& body, const BodyPoint& point, std::uint32_t views,
                           const RowLayout& layout, const DenseRow& row,
                           const BounceLight* surfaces) {
    if (point.normal == glm::vec3(0)) return 0;
    std::uint64_t rays = 0;
    const PointViews own = follow_enough(body, point, views, rays);
    const auto& set = own.set;
    const auto& found = own.found;
    const std::array<const std::vector<StraightExit>*, 2> met{&found.blocked, &found.inside};
    const bool sees_surfaces =
        surfaces != nullptr && !(found.blocked.empty() && found.inside.empty());
    if (found.exits.empty() && !sees_surfaces) return rays;
    const std::uint32_t terms = straight_terms(layout);
    std::vector<float> factors = fit_rows(set, layout);
    if (terms > 1) {
        std::vector<double> even(set.seen.size());
        const auto limit_with = [&](std::span<const StraightExit> exits) {
            for (const StraightExit& exit : exits) {
                even[exit.view] += static_cast<double>(
                    body.bands == 1 ? exit.weight[0]
                                    : exit.weight[0] + exit.weight[1] + exit.weight[2]);
            }
            limit_fit(set, terms, even, factors);
        };
        limit_with(found.exits);
        if (sees_surfaces) {
            for (const auto* some : met) {
                limit_with(*some);  // before surfaces as bright as the sky
            }
        }
    }
    Splat splat(row, terms, spread_cosine(views));
    const auto factors_of = [&](const StraightExit& exit) {
        return std::span<const float>(factors).subspan(std::size_t{exit.view} * terms, terms);
    };
    for (const StraightExit& exit : found.exits) {
        splat.add(exit, factors_of(exit));
    }
    if (terms == kLimitedTerms) {
        splat.limit({set, point.normal, body.eta, terms});
    }
    splat.add_to(row);
    if (sees_surfaces) {
        std::vector<SurfaceView> looks;
        looks.reserve(found.blocked.size() + found.inside.size());
        for (const auto* some : met) {
            for (const StraightExit& exit : *some) {
                if (some == &found.inside && !exit.is_opaque) continue;  // walks have its light
                looks.push_back({exit.origin, exit.direction, exit.weight, factors_of(exit)});
            }
        }
        rays += add_seen_light(*surfaces, looks, solid_angle_of(views), row.cubemap_size, row.bands,
                               row.values);
    }
    return rays;
}

std::uint64_t add_straight_lamps(const StraightBody& body, const BodyPoint& point,
                                 std::uint32_t views, const RowLayout& layout, const DenseRow& row,
                                 const LampBounces& lamps) {
    if (point.normal == glm::vec3(0)) return 0;
    std::uint64_t rays = 0;
    const PointViews own = follow_enough(body, point, views, rays);
    const std::uint32_t terms = straight_terms(layout);
    const std::vector<float> factors = fit_rows(own.set, layout);
    std::vector<SurfaceView> looks;
    for (const auto* some : {&own.found.exits, &own.found.blocked, &own.found.inside}) {
        for (const StraightExit& exit : *some) {
            const auto factor =
                std::span<const float>(factors).subspan(std::size_t{exit.view} * terms, terms);
            std::array<float, 3> weight = exit.weight;
            for (float& w : weight) {
                w /= exit.eta * exit.eta;
            }
            looks.push_back({exit.origin, exit.direction, weight, factor});
        }
    }
    std::vector<float> values(std::size_t{terms} * row.bands * row.size());
    const DenseRow seen{values, row.cubemap_size, terms, row.bands};
    rays += add_seen_lamps(lamps, looks, solid_angle_of(views),
                           key_of({point.position, point.normal}), seen);
    const std::size_t stride = row.bands * row.size();
    if (terms == kLimitedTerms) {
        const NonNegativeViews limit(own.set, point.normal, body.eta, terms);
        for (std::size_t i = 0; i < stride; ++i) {
            limit.apply(&values[i], stride);
        }
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        row.values[i] += values[i];
    }
    return rays;
}

CrossingViews look_through(const StraightBody& body, const BodyPoint& point, std::uint32_t views,
                           std::uint64_t& rays) {
    CrossingViews crossing{{}, solid_angle_of(views)};
    if (point.normal == glm::vec3(0)) return crossing;
    const StraightStart start = make_straight_start(body, point, rays);
    const PointViews own = follow_views(body, point, start, views, rays);
    const double leaves = 1 - fresnel_moments(body.eta).external;
    for (const auto* some : {&own.found.blocked, &own.found.inside}) {
        for (const StraightExit& exit : *some) {
            if (some == &own.found.inside && !exit.is_opaque) continue;
            const auto share = static_cast<float>(leaves * own.set.weight[exit.view]);
            SurfaceView view{exit.origin, exit.direction, {}, {}};
            for (std::size_t b = 0; b < view.weight.size(); ++b) {
                view.weight[b] = share * exit.weight[body.bands == 1 ? 0 : b];
            }
            crossing.views.push_back(view);
        }
    }
    return crossing;
}

}  // namespace opaline::bake
