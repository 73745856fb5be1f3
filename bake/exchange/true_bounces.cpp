#include "bake/exchange/true_bounces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/inside_media.h"
#include "bake/exchange/true_lobe.h"
#include "bake/plan/surface_albedo.h"
#include "bake/receivers/surface_samples.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

// Roulette ends nearly all paths before.
constexpr std::uint32_t kMostDepth = 64;

double luminance_of(Rgb c) {
    return static_cast<double>(formats::luminance(c));
}

float largest(Rgb c) {
    return std::max({c.r, c.g, c.b});
}

class TruePath {
  public:
    // `first_medium`: around where the paths begin.
    TruePath(const BounceTruth& truth, std::uint32_t first_medium, std::uint64_t key,
             std::span<double> irradiance)
        : truth_(truth),
          first_medium_(first_medium),
          key_(key),
          irradiance_(irradiance),
          from_sky_(irradiance.size()) {}

    // One path of `count`, the number-th.
    std::uint64_t follow(Receiver from, std::uint32_t number, std::uint32_t count) {
        Rgb weight = (1 / static_cast<float>(count)) * Rgb{1, 1, 1};
        rays_ = 0;
        is_mirrored_ = false;
        medium_ = first_medium_;
        lobe_.reset();
        for (std::uint32_t depth = 0; depth < kMostDepth; ++depth) {
            auto u = random_of(number, depth);
            if (depth == 0) {
                u[0] = std::fmod((static_cast<float>(number) + u[0]) / static_cast<float>(count),
                                 1.0f);
            }
            if (!step(from, {u[0], u[1]}, u[2], weight) ||
                !survives(static_cast<float>(count), u[3], weight)) {
                break;
            }
        }
        return rays_;
    }

    // One whose first ray is given: the direction is along.normal.
    std::uint64_t look(const Receiver& along, Rgb weight, std::uint32_t number) {
        const float most = largest(weight);
        rays_ = 0;
        if (!(most > 0)) return rays_;
        Receiver from;
        is_mirrored_ = false;
        medium_ = first_medium_;
        lobe_.reset();
        for (std::uint32_t depth = 0; depth < kMostDepth; ++depth) {
            const auto u = random_of(number, depth);
            if (!(depth == 0 ? meet(along.origin, along.normal, u[2], from, weight)
                             : step(from, {u[0], u[1]}, u[2], weight)) ||
                !survives(1 / most, u[3], weight)) {
                break;
            }
        }
        return rays_;
    }

  private:
    std::array<float, 4> random_of(std::uint32_t number, std::uint32_t depth) const {
        return random_uniform(truth_.light->seed, RandomStage::true_bounces, key_,
                              number * kMostDepth + depth);
    }

    // Roulette below 1 / scale.
    static bool survives(float scale, float u, Rgb& weight) {
        const float survival = std::min(1.0f, largest(weight) * scale);
        if (!(u < survival)) return false;
        weight = (1 / survival) * weight;
        return true;
    }

    // To the next surface, whose light counts. False: the path ends.
    bool step(Receiver& from, glm::vec2 u, float side_choice, Rgb& weight) {
        if (lobe_) {
            const auto onward = sample_true_lobe(*lobe_, u.x, u.y);
            if (!onward) return false;
            weight = weight * onward->weight;
            return meet(from.origin, onward->direction, side_choice, from, weight);
        }
        return from.normal != glm::vec3(0) &&
               meet(from.origin,
                    is_mirrored_ ? from.normal
                                 : make_frame(from.normal).to_world(to_hemisphere(u.x, u.y)),
                    side_choice, from, weight);
    }

    // The same along a ray; `next`: where it goes on from, along its normal where it is mirrored.
    bool meet(glm::vec3 origin, glm::vec3 direction, float side_choice, Receiver& next,
              Rgb& weight) {
        const BounceLight& light = *truth_.light;
        PacketHits hits = closest_of_one(light.rays, origin, direction);
        ++rays_;
        MirroredRay ray{
            .origin = origin, .direction = direction, .share = weight, .medium = medium_};
        while (hits.hit[0] != 0 &&
               go_on_inside(light.space(),
                            end_of_ray(light.scene, ray.origin, ray.direction, hits, 0), ray,
                            light.seed + 1)) {
            if (!(ray.largest() > 0) || ray.inside >= kMostInside) return false;
            hits = closest_of_one(light.rays, ray.origin, ray.direction);
            ++rays_;
            is_mirrored_ = true;
        }
        origin = ray.origin, direction = ray.direction, weight = ray.share;
        medium_ = ray.medium;
        const SeenSide side = hits.hit[0] != 0 ? side_of_hit(light.scene, hits, 0) : SeenSide{};
        if (hits.hit[0] == 0 && lobe_ && !is_mirrored_) {
            add_smooth_sky(origin, direction, weight);
        } else if (hits.hit[0] == 0 && is_mirrored_) {
            add_node(light.tree.sky_node(direction), weight);
        }
        is_mirrored_ = false;
        lobe_.reset();
        if (!side.is_seen) return false;
        const RowLayout& layout = light.layouts[hits.material[0]];
        const formats::Material& material = light.scene.materials[hits.material[0]];
        const bool is_medium = material.medium && !material.sheet;
        if (!sends_light(layout) && !is_medium) return false;
        const SurfacePoint point =
            make_surface_point(light.scene, {hits.primitive[0], hits.first_index[0]},
                               {1 - hits.u[0] - hits.v[0], hits.u[0], hits.v[0]});
        if (is_medium) {
            const MirroredRay on = mirror(light.space(),
                                          {point.position, direction, hits.distance[0],
                                           hits.error[0], hits.material[0], side},
                                          {1, 1, 1}, 0);
            add_node(
                light.tree.find(point.position, {hits.material[0], side.behind, side.normal}, 0),
                share_of_radiosity(material, on.largest()) * weight);
            next = {on.origin, on.direction};
            weight = on.largest() * weight;
            is_mirrored_ = on.largest() > 0;
            return is_mirrored_;
        }
        const SurfaceSample sample = make_surface_sample(light.scene, point, 0);
        const glm::vec3 lift = sample.receiver.origin - point.position;
        Receiver front = sample.receiver,
                 back{point.position - glm::dot(lift, point.normal) * point.normal, -sample.normal};
        if (side.behind) {
            std::swap(front, back);
        }
        const auto& sheet = material.sheet;
        Rgb diffuse, mirrored{0, 0, 0};
        const auto lobe = eval_lobe(
            light.scene, layout,
            surface_place(light.scene, point.primitive, point.first_index, point.barycentric));
        std::optional<TrueLobe> seen;
        if (lobe) {
            seen =
                make_true_lobe(lobe->surface, front.normal, side.normal, front.origin, direction);
            diffuse = seen->albedo.diffuse * lobe->color;
            mirrored = seen->albedo.specular;
            rays_ += add_mirrored_suns(light.rays, truth_.suns, *seen,
                                       std::numbers::pi_v<float> * weight, irradiance_);
        } else {
            diffuse = eval_surface_albedo(light.scene, layout, point).diffuse;
        }
        if (!sheet && !lobe) {
            weight = weight * diffuse;
            add_sky(front, weight);
            next = front;
            return true;
        }
        const Rgb reflect = sheet ? diffuse * sheet->reflect : diffuse,
                  transmit = sheet ? diffuse * sheet->transmit : Rgb{0, 0, 0};
        if (!lobe || largest(reflect) > 0) add_sky(front, weight * reflect);
        if (sheet) add_sky(back, weight * transmit);
        const float reflected = largest(reflect), through = largest(transmit);
        const float by_lobe = largest(mirrored), all = reflected + through + by_lobe;
        if (!(all > 0)) return false;
        // One of three; the side of a sheet without a lobe is chosen first.
        const float lobe_share = by_lobe / all;
        if (side_choice >= 1 - lobe_share) {
            lobe_ = seen;
            next = front;
            weight = (1 / lobe_share) * weight;
            return true;
        }
        const float share = reflected / all;
        const bool is_reflected = side_choice < share;
        next = is_reflected ? front : back;
        weight = is_reflected ? (1 / share) * (weight * reflect)
                              : (1 / (1 - share - lobe_share)) * (weight * transmit);
        return true;
    }

    void add_sky(const Receiver& at, Rgb weight) {
        std::ranges::fill(from_sky_, 0.0);
        const auto u =
            random_uniform(truth_.light->seed, RandomStage::true_bounces, key_of(at), 0xffffffffu);
        rays_ += add_sun_irradiance(truth_.light->rays, truth_.suns, at, 1, from_sky_);
        rays_ += add_smooth_irradiance(truth_.light->rays, truth_.smooth, at, 1, {u[0], u[1]},
                                       from_sky_);
        for (std::size_t l = 0; l < from_sky_.size(); ++l) {
            irradiance_[l] += luminance_of(weight) * from_sky_[l];
        }
    }

    // Where a lobe mirrors it. The suns are those of add_mirrored_suns.
    void add_smooth_sky(glm::vec3 origin, glm::vec3 direction, Rgb weight) {
        const double factor = std::numbers::pi * luminance_of(weight) *
                              let_through(truth_.smooth.between, origin, direction);
        const float* const radiance = truth_.smooth.towards(direction);
        for (std::size_t l = 0; l < from_sky_.size(); ++l) {
            irradiance_[l] += factor * static_cast<double>(radiance[l]);
        }
    }

    void add_node(std::uint32_t node, Rgb weight) {
        if (node == formats::kNone) return;
        const std::vector<float> row = truth_.light->tree.rows().row(node);
        const std::uint32_t bands = truth_.light->bands;
        const std::size_t texels = row.size() / bands;
        for (std::size_t l = 0; l < from_sky_.size(); ++l) {
            std::array<double, 3> band{};
            for (std::uint32_t b = 0; b < 3; ++b) {
                band[b] = b < bands
                              ? relit(std::span(row).subspan(b * texels, texels), truth_.coarse[l])
                              : band[0];
            }
            irradiance_[l] +=
                luminance_of(weight * Rgb{static_cast<float>(band[0]), static_cast<float>(band[1]),
                                          static_cast<float>(band[2])});
        }
    }

    const BounceTruth& truth_;
    std::uint32_t first_medium_;
    std::uint64_t key_;
    std::span<double> irradiance_;
    std::vector<double> from_sky_;
    std::uint64_t rays_ = 0;
    std::uint32_t medium_ = formats::kNone;  // that the path is inside of
    bool is_mirrored_ = false;               // where the path goes next is known
    std::optional<TrueLobe> lobe_;           // or in which lobe
};

}  // namespace

BounceTruth make_bounce_truth(std::shared_ptr<const BounceLight> light,
                              std::span<const TestLight> lights, const DensitySpace* between) {
    BounceTruth truth;
    truth.suns = make_sun_rays(lights, 4, between);
    truth.smooth = make_smooth_lights(lights, between);
    std::vector<TestLight> coarse(lights.begin(), lights.end());
    project_test_lights(coarse, light->cubemap_size);
    for (TestLight& own : coarse) {
        truth.coarse.push_back(std::move(own.coarse));
    }
    truth.light = std::move(light);
    return truth;
}

std::uint64_t add_true_bounces(const BounceTruth& truth, const Receiver& at, std::uint64_t key,
                               std::uint32_t count, std::span<double> irradiance) {
    std::uint64_t rays = 0;
    const MediumAround around = medium_around(truth.light->space(), at);
    if (around.is_deep) return 0;
    TruePath path(truth, around.material, key, irradiance);
    for (std::uint32_t i = 0; i < count; ++i) {
        rays += path.follow(at, i, count);
    }
    return rays;
}

std::uint64_t add_true_view(const BounceTruth& truth, const Receiver& along, Rgb weight,
                            std::uint64_t key, std::uint32_t number, std::span<double> luminance) {
    return TruePath(truth, medium_around(truth.light->space(), along).material, key, luminance)
        .look(along, std::numbers::inv_pi_v<float> * weight, number);
}

}  // namespace opaline::bake
