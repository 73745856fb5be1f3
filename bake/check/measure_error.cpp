#include "bake/check/measure_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/check/bootstrap.h"
#include "bake/check/stored_luminance.h"
#include "bake/check/subject_truth.h"
#include "bake/check/surface_probes.h"
#include "bake/physics/fresnel.h"
#include "bake/receivers/used_vertices.h"

namespace opaline::bake {
namespace {

template <class Predicate>
std::vector<CheckedPair> collect_pairs(std::span<const EffectCheck> checks, Predicate&& wanted) {
    std::vector<CheckedPair> pairs;
    for (const EffectCheck& check : checks) {
        if (wanted(check)) {
            pairs.insert(pairs.end(), check.pairs.begin(), check.pairs.end());
        }
    }
    return pairs;
}

// Effects that were checked somewhere, each once, in order.
std::vector<std::string> name_effects(std::span<const EffectCheck> checks) {
    std::vector<std::string> names;
    for (const EffectCheck& check : checks) {
        if (!check.pairs.empty() &&
            std::find(names.begin(), names.end(), check.effect) == names.end()) {
            names.push_back(check.effect);
        }
    }
    return names;
}

// Of the checks that `wanted` chooses; zeros where they found nothing.
template <class Predicate>
MeasuredError measure(std::span<const EffectCheck> checks, std::span<const std::string> lights,
                      std::uint64_t seed, Predicate&& wanted) {
    MeasuredError measured;
    const std::vector<CheckedPair> pairs = collect_pairs(checks, wanted);
    if (pairs.empty()) return measured;
    for (const std::string& effect : name_effects(checks)) {
        const std::vector<CheckedPair> own = collect_pairs(checks, [&](const EffectCheck& check) {
            return wanted(check) && check.effect == effect;
        });
        if (!own.empty()) {
            measured.by_effect.push_back({effect, relative_rms(own)});
        }
    }
    for (std::size_t l = 0; l < lights.size(); ++l) {
        std::vector<CheckedPair> own;
        for (std::size_t i = l; i < pairs.size(); i += lights.size()) {
            own.push_back(pairs[i]);
        }
        measured.by_light.push_back({lights[l], relative_rms(own)});
    }
    const ErrorBounds bounds = bound_stated_error(pairs, lights.size(), seed);
    measured.rms_relative = bounds.rms;
    measured.ci95[0] = bounds.lowest;
    measured.ci95[1] = bounds.highest;
    return measured;
}

std::string describe_reference(std::span<const EffectCheck> checks,
                               std::span<const std::string> lights) {
    std::string text;
    for (const std::string& effect : name_effects(checks)) {
        const auto first =
            std::find_if(checks.begin(), checks.end(),
                         [&](const EffectCheck& check) { return check.effect == effect; });
        text += (text.empty() ? "" : "; ") + effect + ": " + first->reference;
    }
    for (std::size_t l = 0; l < lights.size(); ++l) {
        text += (l == 0 ? "; luminance under " : ", ") + lights[l];
    }
    return text;
}

std::uint32_t find_worst_between(std::span<const EffectCheck> checks, std::size_t lights) {
    std::map<std::uint32_t, double> squares;  // of the error, by primitive
    for (const EffectCheck& check : checks) {
        if (!check.between) continue;
        for (std::size_t i = 0; i < check.pairs.size(); ++i) {
            squares[check.primitive[i / lights]] +=
                check.pairs[i].error[0] * check.pairs[i].error[1];
        }
    }
    const auto worst =
        std::max_element(squares.begin(), squares.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return worst == squares.end() ? 0 : worst->first;
}

// Toward the eye inside the medium; 0 along the normal.
glm::vec3 seen_inside(const SubjectTruth& truth, const CheckPoint& point) {
    if (point.to_eye == glm::vec3(0)) return point.to_eye;
    const float eta = truth.parts.front().inputs.medium().eta;
    const float cosine = glm::dot(point.body.normal, point.to_eye);
    const auto inside =
        static_cast<float>(refracted_cosine(static_cast<double>(cosine), static_cast<double>(eta)));
    return glm::normalize((point.to_eye - cosine * point.body.normal) / eta +
                          inside * point.body.normal);
}

// Below index 1 nothing is seen beyond the critical angle.
bool enters_everywhere(const SubjectTruth& truth) {
    return truth.parts.front().inputs.medium().eta >= 1;
}

// `sent`: what volumes scatter to the subject; null: nothing.
EffectCheck check_subject(const SubjectTruth& truth, const SentTruth* sent,
                          const SubjectState& subject, const formats::AssetView& asset,
                          std::span<const CheckPoint> points, std::span<const TestLight> lights) {
    EffectCheck check;
    check.effect = truth.name();
    check.reference = truth.reference();
    const std::size_t step = truth.is_expensive()
                                 ? (points.size() + kMostExpensiveChecks - 1) / kMostExpensiveChecks
                                 : 1;
    for_each_block_in_order(
        points.size(), 1, truth.parts.front().inputs.context,
        [&](Range range) {
            CheckPoint point = points[range.begin];
            if (!subject.layout.all_orders || !enters_everywhere(truth)) {
                point.to_eye = glm::vec3(0);  // other models look along the normal alone
            }
            CheckedPoint found{point.primitive, {}, 0};
            if (point.material == subject.material && range.begin % step == 0) {
                const TruthReceiver at{point.receiver, point.body, point.key, point.behind,
                                       seen_inside(truth, point)};
                TwoEstimates expected = eval_truth(truth, at, found.rays);
                if (sent != nullptr) {
                    found.rays += add_sent_truth(*sent, at, lights, expected);
                }
                append_pairs(relight_point(asset, point, subject.layout, lights), expected,
                             found.pairs);
            }
            return found;
        },
        [&](Range, const CheckedPoint& found) { append_point(found, check); });
    return check;
}

// Primitives that something is simulated for.
std::vector<std::uint32_t> find_lit_primitives(const FinishedBake& bake) {
    std::vector<std::uint32_t> lit;
    for (const ReceiverSet& set : bake.inputs.receivers) {
        if (set.size() > 0 && has_truth(bake.inputs, state_of(bake.subjects, set.material))) {
            lit.push_back(set.primitive);
        }
    }
    return lit;
}

}  // namespace

double relative_rms(std::span<const CheckedPair> pairs) {
    double error = 0, reference = 0;
    for (const CheckedPair& p : pairs) {
        error += p.error[0] * p.error[1];
        reference += p.reference * p.reference;
    }
    // For errors near zero the noise of the estimates can make the mean product negative.
    return reference > 0 ? std::sqrt(std::max(0.0, error / reference)) : 0.0;
}

namespace {

// Few receivers, at the edges of shadows, cause most of an error. With a chance of e^-2 none of n
// drawn receivers is from a given share of 2/n of all, and resamples never contain them.
constexpr std::size_t kUnseen = 2;

struct Sums {
    double error = 0, reference = 0;
};

double ratio(const Sums& sums) {
    return sums.reference > 0 ? std::sqrt(std::max(0.0, sums.error / sums.reference)) : 0.0;
}

// Resample whole receivers, because the lights of one receiver are not independent.
std::vector<Sums> sum_receivers(std::span<const CheckedPair> pairs, std::size_t lights) {
    if (lights == 0) {
        return {};  // where nothing is relit no light is made
    }
    std::vector<Sums> of_receiver(pairs.size() / lights);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        of_receiver[i / lights].error += pairs[i].error[0] * pairs[i].error[1];
        of_receiver[i / lights].reference += pairs[i].reference * pairs[i].reference;
    }
    return of_receiver;
}

std::array<double, 2> resample(std::span<const Sums> of_receiver, std::uint64_t seed) {
    return bootstrap_interval(of_receiver.size(), seed,
                              [&](std::span<const std::size_t> receivers) {
                                  Sums all;
                                  for (const std::size_t r : receivers) {
                                      all.error += of_receiver[r].error;
                                      all.reference += of_receiver[r].reference;
                                  }
                                  return ratio(all);
                              });
}

}  // namespace

ErrorBounds bound_error(std::span<const CheckedPair> pairs, std::size_t lights,
                        std::uint64_t seed) {
    const std::array<double, 2> ends = resample(sum_receivers(pairs, lights), seed);
    return {relative_rms(pairs), ends[0], ends[1]};
}

ErrorBounds bound_stated_error(std::span<const CheckedPair> pairs, std::size_t lights,
                               std::uint64_t seed) {
    ErrorBounds bounds = bound_error(pairs, lights, seed);
    std::vector<Sums> of_receiver = sum_receivers(pairs, lights);
    const Sums worst = *std::ranges::max_element(of_receiver, {}, &Sums::error);
    of_receiver.insert(of_receiver.end(), kUnseen, worst);
    bounds.highest = std::max(bounds.highest, resample(of_receiver, seed)[1]);
    return bounds;
}

void append_pairs(const Luminance& found, const TwoEstimates& truth,
                  std::vector<CheckedPair>& pairs) {
    for (std::size_t l = 0; l < found.size(); ++l) {
        pairs.push_back({{found[l] - truth.first[l], found[l] - truth.second[l]},
                         0.5 * (truth.first[l] + truth.second[l])});
    }
}

void append_point(const CheckedPoint& point, EffectCheck& check) {
    if (!point.pairs.empty()) {
        check.pairs.insert(check.pairs.end(), point.pairs.begin(), point.pairs.end());
        check.primitive.push_back(point.primitive);
    }
    check.rays += point.rays;
}

ErrorReport summarise_checks(std::span<const EffectCheck> checks,
                             std::span<const std::string> lights, std::uint64_t seed) {
    ErrorReport report;
    const auto count = [&](bool between) {
        return static_cast<std::uint32_t>(
            collect_pairs(checks, [&](const EffectCheck& c) { return c.between == between; })
                .size() /
            lights.size());
    };
    const std::vector<CheckedPair> all =
        collect_pairs(checks, [](const EffectCheck&) { return true; });
    if (all.empty()) return report;
    static_cast<MeasuredError&>(report) =
        measure(checks, lights, seed, [](const EffectCheck&) { return true; });
    report.at_receivers =
        measure(checks, lights, seed, [](const EffectCheck& c) { return !c.between; });
    report.between = measure(checks, lights, seed, [](const EffectCheck& c) { return c.between; });
    report.receivers_checked = count(false);
    report.points_between_checked = count(true);
    report.worst_between = find_worst_between(checks, lights.size());
    report.reference = describe_reference(checks, lights);
    double squares = 0;
    std::vector<double> magnitude;
    for (const CheckedPair& p : all) {
        squares += p.reference * p.reference;
        magnitude.push_back(0.5 * std::abs(p.error[0] + p.error[1]));
    }
    std::sort(magnitude.begin(), magnitude.end());
    const double rms = std::sqrt(squares / static_cast<double>(all.size()));
    if (rms > 0) {
        report.p95_relative =
            magnitude[static_cast<std::size_t>(0.95 * static_cast<double>(magnitude.size() - 1))] /
            rms;
        report.max_relative = magnitude.back() / rms;
    }
    return report;
}

ErrorReport check_file(const FinishedBake& bake, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced) {
    const std::uint64_t seed = bake.knobs.seed;
    const std::size_t all = count_receivers(bake.inputs.receivers);
    const formats::SlotsView slots = bake.inputs.facts.slots.view();
    const std::vector<std::uint32_t> used = find_used_vertices(bake.inputs.scene, slots);
    std::vector<std::uint32_t> drawn =
        draw_evenly(used.size(), count_checked(used.size(), bake.knobs.cubemap_size),
                    RandomStage::held_back_receivers, seed);
    for (std::uint32_t& receiver : drawn) {
        receiver = used[receiver];
    }
    std::vector<CheckPoint> receivers = make_check_points(bake.inputs.receivers, slots, drawn);
    std::vector<CheckPoint> between =
        draw_surface_probes(bake.inputs.scene, bake.inputs.rays, find_lit_primitives(bake),
                            {drawn.size(), seed, static_cast<std::uint32_t>(all)}, context);
    move_to_copies(bake.inputs.scene, seed, receivers);
    move_to_copies(bake.inputs.scene, seed, between);
    turn_thin_walled(bake.inputs.scene, receivers);
    turn_thin_walled(bake.inputs.scene, between);
    std::vector<glm::vec3> normals;
    for (const formats::Primitive& p : bake.inputs.scene.primitives) {
        normals.insert(normals.end(), p.normal.begin(), p.normal.end());
    }
    turn_views(normals, seed, receivers);
    turn_views(normals, seed, between);
    std::vector<EffectCheck> checks;
    BakeInputs dimmed = bake.inputs;
    dimmed.between = bake.volumes != nullptr ? &bake.volumes->space : nullptr;
    for (const SubjectState& subject : bake.subjects) {
        const SubjectTruth truth =
            make_subject_truth(dimmed, subject, bake.knobs, {}, bake.lights, context);
        if (truth.parts.empty()) {
            continue;  // black: no error
        }
        std::optional<SentTruth> sent;
        if (bake.volumes != nullptr && bake.volumes->sent != nullptr) {
            sent.emplace(make_sent_truth(bake, *bake.volumes->sent, subject, context));
        }
        for (const auto* points : {&receivers, &between}) {
            EffectCheck check =
                check_subject(truth, sent ? &*sent : nullptr, subject, asset, *points, bake.lights);
            check.between = points == &between;
            traced += check.rays;
            checks.push_back(std::move(check));
        }
    }
    std::vector<std::string> names;
    for (const TestLight& light : bake.lights) {
        names.push_back(light.name);
    }
    return summarise_checks(checks, names, seed);
}

}  // namespace opaline::bake
