#include "bake/lab/sweep/analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace opaline::bake {
namespace {

// From the fine end, rungs with hardly less error than the one before: another error dominates.
std::size_t count_unsaturated(std::span<const Convergence> rungs) {
    constexpr double kLeastGain = 0.9;
    std::size_t count = rungs.size();
    while (count >= 2 && rungs[count - 1].error > kLeastGain * rungs[count - 2].error) {
        --count;
    }
    return count;
}

// Ladders that converge: of what all effects share, then of each effect's knobs.
std::vector<Ladder> converging_ladders(const SweepSubject& subject) {
    std::vector<Ladder> ladders{Ladders::resolution, Ladders::coefficients};
    for (const KnobSpec* knob : subject.knobs) {
        ladders.push_back(ladder_of(*knob));
    }
    for (const ChosenKnob& chosen : subject.chosen) {
        ladders.push_back(ladder_of(*chosen.knob));
    }
    return ladders;
}

struct Member {
    double value = 0;
    const PointRecord* record = nullptr;
};

std::vector<Member> members_of(const SweepResult& result, const Ladder& ladder) {
    std::vector<Member> members;
    for (const PointRecord& record : result.points) {
        for (const Rung& rung : record.point.rungs) {
            if (rung.ladder == ladder) {
                const auto count = ladder.theory.value;
                members.push_back({count != nullptr ? count(rung.value) : rung.value, &record});
            }
        }
    }
    std::sort(members.begin(), members.end(), [&](const Member& a, const Member& b) {
        return ladder.theory.fine_is_small ? a.value > b.value : a.value < b.value;
    });
    return members;
}

// A rung next to the finest shares most of its error and looks too good. Half of a surface's
// coefficients vanish, so "all" counts as half.
bool is_near(const Ladder& ladder, double value, double finest) {
    const double near = ladder == Ladders::coefficients ? 4.01 : 2.01;
    return ladder.theory.rate_by_cosine == nullptr && value > 0 && finest > 0 &&
           std::max(value, finest) <= near * std::min(value, finest);
}

// Of surfaces, volumes and layers.
std::vector<double> all_luminance(const PointRecord& record) {
    std::vector<double> all = record.luminance;
    all.insert(all.end(), record.volume_luminance.begin(), record.volume_luminance.end());
    all.insert(all.end(), record.layer_radiance.begin(), record.layer_radiance.end());
    return all;
}

std::optional<LadderFit> fit_ladder(const SweepResult& result, const Ladder& ladder) {
    const auto theory = convergence_theory(ladder, result.mean_cosine);
    const std::vector<Member> members = members_of(result, ladder);
    if (!theory || members.size() < 3) return std::nullopt;
    const Member& finest = members.back();
    LadderFit fit{ladder, *theory, finest.record->point.label, {}, std::nullopt};
    std::vector<Convergence> fitted;
    for (std::size_t i = 0; i + 1 < members.size(); ++i) {
        const Convergence rung{
            members[i].value,
            relative_difference(all_luminance(*members[i].record), all_luminance(*finest.record)),
            members[i].record->seconds};
        fit.rungs.push_back(rung);
        if (!is_near(ladder, rung.value, finest.value)) {
            fitted.push_back(rung);
        }
    }
    fit.fit = fit_slope(fitted, theory->semi_log);
    return fit;
}

// Against samples of its own truth, none of which it shares: nothing is too near.
LadderFit fit_reference(const ReferenceLadder& reference) {
    auto theory = convergence_theory(Ladders::reference_samples, 0);
    LadderFit fit{
        Ladders::reference_samples,
        std::move(*theory),
        std::to_string(reference.truth_samples) + " other samples under " + reference.light,
        {},
        std::nullopt};
    for (const ReferenceRung& rung : reference.rungs) {
        fit.rungs.push_back({static_cast<double>(rung.samples), rung.error, rung.seconds});
    }
    fit.fit = fit_slope(fit.rungs, fit.theory.semi_log);
    return fit;
}

bool meet(const double (&a)[2], const double (&b)[2]) {
    return a[0] <= b[1] && b[0] <= a[1];
}

std::optional<Answer> answer_of(std::span<const CostPoint> time, std::span<const CostPoint> bytes) {
    for (const double error : {0.01, 0.02, 0.05, 0.005, 0.1, 0.002, 0.2, 0.001, 0.5}) {
        const double seconds = front_cost_at(time, error), size = front_cost_at(bytes, error);
        if (seconds > 0 && size > 0) {
            const double half = front_cost_at(time, error / 2);
            return Answer{error, seconds, size, half > 0 ? half / seconds : 0.0};
        }
    }
    return std::nullopt;
}

// Indices of the points of each way to choose, in the order in which they were first made.
std::vector<std::vector<std::size_t>> group_by_choices(const SweepResult& result) {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        const auto same = std::ranges::find_if(groups, [&](const auto& group) {
            return result.points[group.front()].choices == result.points[i].choices;
        });
        if (same == groups.end()) {
            groups.push_back({i});
        } else {
            same->push_back(i);
        }
    }
    return groups;
}

std::optional<CostPair> pair_of(const std::optional<CostPair>& pair,
                                const std::vector<std::size_t>& group) {
    return pair ? std::optional(CostPair{group[pair->better], group[pair->other]}) : std::nullopt;
}

ChoiceLine line_of(const SweepResult& result, const std::vector<std::size_t>& group,
                   const std::vector<bool>& on_front) {
    ChoiceLine line{result.points[group.front()].choices, {}};
    for (std::size_t k = 0; k < group.size(); ++k) {
        if (on_front[k]) {
            line.front.push_back(group[k]);
        }
    }
    std::ranges::sort(line.front, {}, [&](std::size_t i) { return result.points[i].seconds; });
    return line;
}

// Fronts, pairs and answer within one way to choose.
void analyse_group(const SweepResult& result, const std::vector<std::size_t>& group,
                   SweepAnalysis& analysis) {
    std::vector<CostPoint> time, bytes, total;
    for (const std::size_t i : group) {
        const PointRecord& record = result.points[i];
        time.push_back({record.seconds, record.error.rms_relative});
        bytes.push_back({static_cast<double>(record.bytes), record.error.rms_relative});
        total.push_back({record.seconds, record.total.rms_relative});
    }
    const std::vector<bool> on_time = pareto_front(time), on_bytes = pareto_front(bytes),
                            on_total = pareto_front(total);
    for (std::size_t k = 0; k < group.size(); ++k) {
        analysis.standing[group[k]] = {on_time[k], on_bytes[k], times_the_front(time, k),
                                       times_the_front(bytes, k), on_total[k]};
    }
    analysis.lines.push_back(line_of(result, group, on_total));
    if (std::ranges::find(group, result.truth) != group.end()) {
        analysis.answer = answer_of(time, bytes);
        analysis.equal_time = pair_of(equal_cost_pair(time), group);
        analysis.equal_error = pair_of(equal_error_pair(time), group);
    }
}

bool beats(const CostPoint& a, const CostPoint& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

// Range of errors in which a picture shows a difference.
bool is_visible(const CostPoint& p) {
    return p.error >= 2e-3 && p.error <= 0.5;
}

bool within(double a, double b, double factor) {
    return a > 0 && b > 0 && std::max(a, b) <= factor * std::min(a, b);
}

// The pair, `alike` in one thing, whose other thing differs most; `ratio` > 1 counts.
template <class Alike, class Ratio>
std::optional<CostPair> widest_pair(std::span<const CostPoint> points, Alike&& alike,
                                    Ratio&& ratio) {
    constexpr double kWorthShowing = 1.2;
    const std::vector<bool> front = pareto_front(points);
    std::optional<CostPair> widest;
    double most = kWorthShowing;
    for (std::size_t a = 0; a < points.size(); ++a) {
        for (std::size_t b = 0; front[a] && b < points.size(); ++b) {
            if (a != b && is_visible(points[a]) && is_visible(points[b]) &&
                alike(points[a], points[b]) && ratio(points[a], points[b]) > most) {
                most = ratio(points[a], points[b]);
                widest = CostPair{a, b};
            }
        }
    }
    return widest;
}

}  // namespace

std::optional<Slope> fit_slope(std::span<const Convergence> rungs, bool semi_log) {
    std::vector<Convergence> useful;
    for (const Convergence& rung : rungs) {
        if (rung.error > 0 && (semi_log || rung.value > 0)) {
            useful.push_back(rung);
        }
    }
    const std::size_t count = count_unsaturated(useful);
    if (count < 2) return std::nullopt;
    Slope fit;
    double mean_x = 0, mean_y = 0;
    std::vector<double> x, y;
    for (std::size_t i = 0; i < useful.size(); ++i) {
        if (i >= count) {
            fit.saturated.push_back(useful[i].value);
            continue;
        }
        fit.used.push_back(useful[i].value);
        x.push_back(semi_log ? useful[i].value : std::log(useful[i].value));
        y.push_back(std::log(useful[i].error));
        mean_x += x.back() / static_cast<double>(count);
        mean_y += y.back() / static_cast<double>(count);
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < count; ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (xx == 0) return std::nullopt;
    fit.slope = xy / xx;
    fit.intercept = mean_y - fit.slope * mean_x;
    double residual = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double r = y[i] - fit.intercept - fit.slope * x[i];
        residual += r * r;
    }
    if (count > 2) {
        fit.standard_error = std::sqrt(residual / static_cast<double>(count - 2) / xx);
    }
    return fit;
}

std::optional<Theory> convergence_theory(const Ladder& ladder, double g) {
    const KnobTheory& theory = ladder.theory;
    const bool semi_log = theory.rate_by_cosine != nullptr;
    const double rate = semi_log ? theory.rate_by_cosine(g) : theory.rate;
    return rate == 0 ? std::nullopt
                     : std::optional(Theory{rate, semi_log, std::string(theory.label),
                                            std::string(theory.words)});
}

SweepAnalysis analyse_sweep(const SweepResult& result) {
    SweepAnalysis analysis;
    analysis.standing.resize(result.points.size());
    for (const std::vector<std::size_t>& group : group_by_choices(result)) {
        analyse_group(result, group, analysis);
    }
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        const PointRecord& record = result.points[i];
        if (i != record.finest) {
            ++analysis.checks;
            analysis.checks_agreeing += meet(record.against_finest.ci95, record.error.ci95) ? 1 : 0;
        }
    }
    for (const Ladder& ladder : converging_ladders(result.subject)) {
        if (auto fit = fit_ladder(result, ladder)) {
            analysis.fits.push_back(std::move(*fit));
        }
    }
    if (result.reference) {
        analysis.fits.push_back(fit_reference(*result.reference));
    }
    return analysis;
}

std::vector<bool> pareto_front(std::span<const CostPoint> points) {
    std::vector<bool> front(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        front[i] = std::none_of(points.begin(), points.end(),
                                [&](const CostPoint& other) { return beats(other, points[i]); });
    }
    return front;
}

double times_the_front(std::span<const CostPoint> points, std::size_t index) {
    double cheapest = points[index].cost;
    for (const CostPoint& p : points) {
        if (p.error <= points[index].error) {
            cheapest = std::min(cheapest, p.cost);
        }
    }
    return cheapest > 0 ? points[index].cost / cheapest : 1.0;
}

double front_cost_at(std::span<const CostPoint> points, double error) {
    const std::vector<bool> front = pareto_front(points);
    const CostPoint* above = nullptr;  // the most accurate one that errs more
    const CostPoint* below = nullptr;  // the least accurate one that does not
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!front[i] || points[i].error <= 0) continue;
        if (points[i].error > error) {
            above = above == nullptr || points[i].error < above->error ? &points[i] : above;
        } else {
            below = below == nullptr || points[i].error > below->error ? &points[i] : below;
        }
    }
    if (below == nullptr || (above == nullptr && below->error < error)) return -1;
    if (below->error == error) return below->cost;
    const double share = std::log(error / above->error) / std::log(below->error / above->error);
    return above->cost * std::pow(below->cost / above->cost, share);
}

std::optional<CostPair> equal_cost_pair(std::span<const CostPoint> points) {
    return widest_pair(
        points, [](const CostPoint& a, const CostPoint& b) { return within(a.cost, b.cost, 1.25); },
        [](const CostPoint& a, const CostPoint& b) { return b.error / a.error; });
}

std::optional<CostPair> equal_error_pair(std::span<const CostPoint> points) {
    return widest_pair(
        points,
        [](const CostPoint& a, const CostPoint& b) { return within(a.error, b.error, 1.15); },
        [](const CostPoint& a, const CostPoint& b) { return b.cost / a.cost; });
}

}  // namespace opaline::bake
