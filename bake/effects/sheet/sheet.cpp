#include "bake/effects/sheet/sheet.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bake/exchange/other_light.h"
#include "bake/lights/true_irradiance.h"
#include "bake/receivers/other_side.h"
#include "bake/scene/coverage.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// Under `white` both sides receive 1; the shares of both add up.
PlanEntry decide(const PlanInput& input) {
    PlanEntry entry;
    const formats::Sheet& sheet = *input.material.sheet;
    const formats::Rgb seen = input.material.base_color * (sheet.reflect + sheet.transmit);
    entry.bound =
        static_cast<double>(std::max({seen.r, seen.g, seen.b}) * input.subject.brightest_vertex *
                            formats::diffuse_share(input.material));
    entry.has_bands = true;
    if (!is_wanted(input.knobs, "sheet")) {
        entry.reason = "left out by --effects";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = sheet.clear > 0 ? "the glass scatters nothing, or nearly"
                                       : "the thin-walled surface scatters nothing, or nearly";
    } else {
        entry.reason = "the thin-walled surface scatters light to both of its sides";
    }
    return entry;
}

constexpr std::array<DecisionRule, 1> kRules{
    {{"sheet",
      [](const PlanInput& input) { return is_thin_walled(input) && !is_wall(input.material); },
      decide,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.constant = layout.constant || entry.on;
      }}}};

struct Directions : Prepared {
    DirectionSet set;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto directions = std::make_unique<Directions>();
    if (has_environment(inputs.bake.light)) {
        directions->set = make_direction_set(inputs.knobs.cubemap_size);
    }
    return directions;
}

const formats::Sheet& sheet_of(const EffectInputs& inputs) {
    return *inputs.bake.scene.materials[inputs.material].sheet;
}

// What stands for a colour in one band of a row.
float in_band(formats::Rgb c, std::uint32_t band, std::uint32_t bands) {
    return bands == 1 ? formats::luminance(c) : std::array<float, 3>{c.r, c.g, c.b}[band];
}

// T_0 = (r E+ + t E-) / pi, T_1 = (t E+ + r E-) / pi, E+ and E- the irradiance transport of the
// side of the normal and of the other one.
std::uint64_t add_environment(const EffectInputs& inputs, const GatherReceiver& receiver,
                              const DenseRow& row) {
    const auto& directions = static_cast<const Directions&>(*inputs.own.prepared).set;
    const formats::Sheet& sheet = sheet_of(inputs);
    std::vector<float> front(row.size()), back(row.size());
    std::uint64_t rays = gather_irradiance(inputs.outside(), directions, receiver.outside, front) +
                         gather_irradiance(inputs.outside(), directions,
                                           other_side(receiver.outside, receiver.inside), back);
    formats::haar_forward_cube(std::span<float>(front), row.cubemap_size);
    formats::haar_forward_cube(std::span<float>(back), row.cubemap_size);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        const float r = std::numbers::inv_pi_v<float> * in_band(sheet.reflect, band, row.bands);
        const float t = std::numbers::inv_pi_v<float> * in_band(sheet.transmit, band, row.bands);
        const std::span<float> before = row.plane(0, band), behind = row.plane(1, band);
        for (std::size_t k = 0; k < front.size(); ++k) {
            before[k] += r * front[k] + t * back[k];
            behind[k] += t * front[k] + r * back[k];
        }
    }
    return rays;
}

// What rows take of one side's irradiance by other light.
OtherLightShare share_of(formats::Rgb c, std::uint32_t term, std::uint32_t bands) {
    OtherLightShare share{term, {}};
    for (std::uint32_t band = 0; band < bands; ++band) {
        share.factor[band] = std::numbers::inv_pi_v<float> * in_band(c, band, bands);
    }
    return share;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    std::uint64_t rays =
        has_environment(inputs.bake.light) ? add_environment(inputs, receiver, row) : 0;
    const formats::Sheet& sheet = sheet_of(inputs);
    const auto share = [&](formats::Rgb c, std::uint32_t term) {
        return share_of(c, term, row.bands);
    };
    rays += add_other_light(light_of(inputs), receiver.outside,
                            {share(sheet.reflect, 0), share(sheet.transmit, 1)}, row);
    rays += add_other_light(light_of(inputs), other_side(receiver.outside, receiver.inside),
                            {share(sheet.transmit, 0), share(sheet.reflect, 1)}, row);
    return rays;
}

struct Truth : Prepared {
    ReflectionTruth truth;
    std::optional<BounceTruth> other;
};

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort, std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->truth = make_reflection_truth(lights, inputs.bake.between);
    truth->other = true_light_of(inputs, lights);
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& own = static_cast<const Truth&>(prepared);
    const formats::Sheet& sheet = sheet_of(inputs);
    TwoEstimates seen = eval_reflection(own.truth, inputs.bake.rays, receiver.outside, rays);
    const TwoEstimates through = eval_reflection(
        own.truth, inputs.bake.rays, other_side(receiver.outside, receiver.inside), rays);
    auto r = static_cast<double>(formats::luminance(sheet.reflect)),
         t = static_cast<double>(formats::luminance(sheet.transmit));
    if (receiver.behind) {
        std::swap(r, t);
    }
    for (std::size_t l = 0; l < seen.first.size(); ++l) {
        seen.first[l] = r * seen.first[l] + t * through.first[l];
        seen.second[l] = r * seen.second[l] + t * through.second[l];
    }
    const std::uint64_t key = 2 * std::uint64_t{receiver.key};
    rays += add_true_other_light(own.other, receiver.outside, key, r, seen);
    rays += add_true_other_light(own.other, other_side(receiver.outside, receiver.inside), key + 1,
                                 t, seen);
    return seen;
}

}  // namespace

EffectDescriptor describe_sheet(Effect id) {
    return {.id = id,
            .name = "sheet",
            .help = "light reflected and transmitted by thin-walled surfaces",
            .rules = kRules,
            .prepare = {.run = prepare},
            .gather = {.add = add,
                       .work =
                           [](const SubjectCost& c) {
                               return irradiance_work(c.input, 2 * c.receivers, c.layout.occluded);
                           }},
            .truth = {.reference = "both sides: rays to the suns, and to all else one a texel of "
                                   "6 x 64 x 64",
                      .make = make_truth,
                      .eval = eval,
                      .work =
                          [](const SubjectCost& c, TruthEffort) {
                              Work work = true_irradiance_work(c);
                              work += true_irradiance_work(c);
                              return work;
                          }},
            .adds_other_light = true};
}

}  // namespace opaline::bake
