#include "bake/check/check_suns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"
#include "bake/check/model_pairs.h"
#include "bake/reference/random_stream.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"

namespace opaline::bake {
namespace {

using Suns = ModelErrorReport::Suns;

// At a fixed number of events the noise of the squared error falls as the root of their number,
// because a path serves all. 64 stand 25 degrees apart.
constexpr std::uint32_t kSuns = 64;

// [rad] of each
constexpr auto kRadius = static_cast<float>(Suns::degrees / 2 * std::numbers::pi / 180);

// Effort, in that of one light: as much as the check takes for white, studio and sky.
constexpr double kLights = 3;

// A spiral, evenly spread.
glm::vec3 sun_direction(std::uint32_t sun) {
    const double place = sun + 0.5, height = 1 - 2 * place / kSuns,
                 azimuth = 2 * std::numbers::pi * place / std::numbers::phi;
    const double across = std::sqrt(1 - height * height);
    return {static_cast<float>(across * std::cos(azimuth)), static_cast<float>(height),
            static_cast<float>(across * std::sin(azimuth))};
}

// Of irradiance 1 where it is faced.
formats::Environment make_sun(std::uint32_t sun) {
    const glm::vec3 d = sun_direction(sun);
    formats::DistantDisc disc;
    disc.direction = {d.x, d.y, d.z};
    disc.angular_radius = kRadius;
    const auto radiance = static_cast<float>(1 / formats::disc_solid_angle(disc.angular_radius));
    disc.radiance = {radiance, radiance, radiance};
    formats::Environment sky;
    sky.discs.push_back(disc);
    return sky;
}

// Light of one sun at one receiver, over groups of samples that are stratified among each other.
struct Tally {
    double sum = 0, squares = 0, group = 0;

    void end_group() {
        sum += group;
        squares += group * group;
        group = 0;
    }
    double variance_of_mean(double groups) const {
        const double mean = sum / groups;
        return std::max(0.0, squares / groups - mean * mean) / (groups - 1);
    }
};

// Of one receiver: all suns.
struct SunTallies {
    std::vector<Tally> sun = std::vector<Tally>(kSuns);
    std::uint64_t events = 0;
};

class SunTracer {
  public:
    SunTracer(const ModelScenes& scenes, const ModelCheckOptions& options)
        : seed_(options.seed), spaces_(held_light_spaces(scenes, no_light_, options)) {
        for (std::uint32_t s = 0; s < kSuns; ++s) {
            direction_.push_back(sun_direction(s));
        }
    }

    SunTallies trace(const ReferenceReceiver& receiver, std::uint32_t number,
                     std::uint32_t first_group, std::uint32_t groups) const {
        SunTallies tallies;
        for (std::uint32_t g = first_group; g < first_group + groups; ++g) {
            for (std::uint32_t s = 0; s < RandomStream::kGroup; ++s) {
                for (std::size_t i = 0; i < spaces_.size(); ++i) {
                    RandomStream random(seed_of_space(seed_, i), number,
                                        g * RandomStream::kGroup + s);
                    const PathSample sample = trace_receiver(spaces_[i], receiver, random);
                    tallies.events += sample.events;
                    add(sample, tallies);
                }
            }
            std::ranges::for_each(tallies.sun, &Tally::end_group);
        }
        return tallies;
    }

  private:
    void add(const PathSample& sample, SunTallies& tallies) const {
        const glm::vec3 w = sample.sky;
        if (w == glm::vec3(0)) return;
        for (std::uint32_t s = 0; s < kSuns; ++s) {
            if (glm::dot(direction_[s], sample.to_sky) > cosine_) {
                const auto light = static_cast<double>(formats::luminance({w.x, w.y, w.z}));
                tallies.sun[s].group += light * radiance_ / RandomStream::kGroup;
                return;
            }
        }
    }

    std::uint64_t seed_;
    formats::Environment black_;
    LightSampler no_light_ = make_light_sampler(black_, glm::mat3(1.0f));
    std::vector<PathSpace> spaces_;
    std::vector<glm::vec3> direction_;
    float cosine_ = static_cast<float>(std::cos(kRadius));
    double radiance_ = 1 / formats::disc_solid_angle(kRadius);
};

std::vector<ReferenceReceiver> find_refracting(const ReferenceScene& scene,
                                               std::span<const ReferenceReceiver> receivers) {
    std::vector<ReferenceReceiver> found;
    std::ranges::copy_if(receivers, std::back_inserter(found), [&](const ReferenceReceiver& r) {
        return r.medium != formats::kNone && !is_matched(scene.media[r.medium].eta);
    });
    return found;
}

}  // namespace

formats::Result<std::optional<ModelErrorReport::Suns>> check_suns(
    const ModelScenes& scenes, const formats::AssetView& asset,
    std::span<const ReferenceReceiver> receivers, const ModelCheckOptions& options,
    const Context& context) {
    const std::vector<ReferenceReceiver> refracting = find_refracting(scenes.held(), receivers);
    if (refracting.empty()) return std::optional<Suns>();
    const SunTracer tracer(scenes, options);
    std::vector<SunTallies> traced(refracting.size());
    const auto trace = [&](std::uint32_t first_group, std::uint32_t groups) {
        std::uint64_t events = 0;
        for_each_block_in_order(
            refracting.size(), 1, context,
            [&](Range range) {
                return tracer.trace(refracting[range.begin],
                                    static_cast<std::uint32_t>(range.begin), first_group, groups);
            },
            [&](Range range, const SunTallies& own) {
                for (std::uint32_t s = 0; s < kSuns; ++s) {
                    Tally& all = traced[range.begin].sun[s];
                    all.sum += own.sun[s].sum;
                    all.squares += own.sun[s].squares;
                }
                events += own.events;
            });
        return events;
    };
    constexpr std::uint32_t kPilot = 16;
    const auto pilot = static_cast<double>(std::max<std::uint64_t>(trace(0, kPilot), 1));
    const double affordable =
        kPilot * (kLights * static_cast<double>(options.max_events) / pilot - 1);
    const auto more = static_cast<std::uint32_t>(std::clamp(affordable, 0.0, 0x1p24));
    if (!context.cancelled()) {
        trace(kPilot, more);
    }
    if (context.cancelled()) return interrupted();
    const double groups = kPilot + more;
    std::vector<ModelPair> pairs;  // sun by sun
    for (std::uint32_t s = 0; s < kSuns; ++s) {
        const runtime::LightVector light =
            runtime::project_environment(make_sun(s), asset.cubemap_size, {}, context.threads);
        const std::vector<double> baked = relight_receivers(asset, refracting, {.vector = light});
        for (std::size_t r = 0; r < refracting.size(); ++r) {
            const Tally& tally = traced[r].sun[s];
            const double truth = tally.sum / groups;
            pairs.push_back({baked[r] - truth, truth, tally.variance_of_mean(groups)});
        }
    }
    Suns report;
    const MeanSquares all = sum_up(pairs);
    report.rms_relative = all.rms_relative();
    report.bias = all.bias();
    report.noise = all.noise();
    report.suns = kSuns;
    report.receivers_checked = static_cast<std::uint32_t>(refracting.size());
    report.samples = (kPilot + more) * RandomStream::kGroup;
    std::ranges::copy(model_interval(pairs, refracting.size(), options.seed), report.ci95);
    return std::optional(report);
}

}  // namespace opaline::bake
