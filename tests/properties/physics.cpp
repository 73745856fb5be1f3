#include "tests/properties/physics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/properties/bake_again.h"
#include "tests/properties/build_scene.h"
#include "tests/properties/shown.h"

namespace opaline::tests {
namespace {

template <class Visit>
void for_each_value(const Shown& shown, Visit&& visit) {
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            visit(shown.vertices[p][v], fmt::format("vertex {} of primitive {}", v, p));
        }
    }
    for (const double value : shown.through_volumes) {
        visit(value, std::string("a line through volumes"));
    }
}

std::optional<Fault> find_unsound(const Shown& shown, const char* light, bool is_dark) {
    std::optional<Fault> fault;
    for_each_value(shown, [&](double value, const std::string& where) {
        if (fault || (std::isfinite(value) && value >= 0 && (!is_dark || value == 0))) return;
        fault = {"finite", fmt::format("{} under {} light: {}", value, light, where)};
    });
    return fault;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

// What so few walks and rays are off by, of the mean of a primitive and of a vertex.
constexpr double kNoiseOfMean = 0.06, kNoise = 0.3;

std::optional<Fault> find_bright(const BuiltScene& built, const Shown& shown, const char* light,
                                 double stated, double brightest = 1) {
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        if (shown.vertices[p].empty()) continue;
        const double average = mean_of(shown.vertices[p]);
        // Rows by view overshoot at vertices inside of other bodies, which nobody sees.
        double most = 0;
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            most = built.exposed[p][v] ? std::max(most, shown.vertices[p][v]) : most;
        }
        if (average > brightest * (1 + kNoiseOfMean + stated) ||
            most > brightest * (1 + kNoise + 3 * stated))
            return Fault{"bounds", fmt::format("{:.3f} in the mean, {:.3f} at most under {} light: "
                                               "primitive {} (stated error {:.3f})",
                                               average, most, light, p, stated)};
    }
    for (const double value : shown.through_volumes) {
        if (value > brightest * (1 + kNoise + 3 * stated))
            return Fault{"bounds", fmt::format("{:.3f} under {} light: a line through volumes",
                                               value, light)};
    }
    return std::nullopt;
}

std::optional<Fault> find_dark_or_bright(const BuiltScene& built, const Shown& shown,
                                         double stated) {
    double square = 0, count = 0;
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        if (built.shown[p] == 0) continue;
        std::vector<double> seen;
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            if (!built.exposed[p][v]) continue;
            seen.push_back(shown.vertices[p][v] / built.shown[p]);
            square += (seen.back() - 1) * (seen.back() - 1);
            count += 1;
        }
        const double average = mean_of(seen);
        if (!seen.empty() && std::abs(average - 1) > kNoiseOfMean + 1.5 * stated)
            return Fault{"furnace", fmt::format("primitive {} shows {:.3f} in the mean of {} "
                                                "vertices (stated error {:.3f})",
                                                p, average, seen.size(), stated)};
    }
    const double rms = std::sqrt(square / std::max(count, 1.0));
    if (rms > 1.5 * std::max(stated, kNoiseOfMean))
        return Fault{"stated error",
                     fmt::format("RMS {:.3f} in a furnace, {:.3f} stated", rms, stated)};
    for (const double value : shown.through_volumes) {
        if (std::abs(value - 1) > kNoise + stated)
            return Fault{"furnace", fmt::format("{:.3f} along a line through volumes", value)};
    }
    return std::nullopt;
}

// What a + factor b lights is that of a, and factor times that of b. Where one shows 0, rows of few
// bits may err below it; volumes do so at single steps of a line.
std::optional<Fault> find_nonlinear(const Shown& a, double factor, const Shown& b,
                                    const Shown& both) {
    constexpr double kRounding = 1e-4, kOfVolumes = 1e-2;
    std::vector<double> expected;
    for_each_value(a, [&](double value, const std::string&) { expected.push_back(value); });
    std::size_t i = 0;
    for_each_value(b, [&](double value, const std::string&) {
        double& sum = expected[i++];
        sum = sum > 0 && value > 0 ? sum + factor * value : -1;
    });
    const double most = expected.empty() ? 0 : std::ranges::max(expected);
    std::optional<Fault> fault;
    i = 0;
    for_each_value(both, [&](double value, const std::string& where) {
        const double sum = expected[i++];
        const bool is_line = i > expected.size() - both.through_volumes.size();
        const double allowed = (is_line ? kOfVolumes : kRounding) * most;
        if (fault || sum < 0 || std::abs(value - sum) <= allowed) return;
        fault = {"linear", fmt::format("{} instead of {}: {}", value, sum, where)};
    });
    return fault;
}

bool has_lamps(const SceneWords& words) {
    return std::ranges::any_of(words.things, [](const Thing& t) {
        return t.kind == ThingKind::lamp || t.kind == ThingKind::glow || t.kind == ThingKind::bulb;
    });
}

}  // namespace

std::optional<Fault> find_fault(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto baked = bake_coarsely(built.scene, 1);
    if (!baked) return Fault{"bakes", baked.error().diagnostics.front().fault};
    const auto lines = lines_through_volumes(built.scene);
    const auto see = [&](const LightOfAll& light) {
        return show(*baked, built.scene.origin, lines, light);
    };
    const bool in_balance = built.in_balance;
    const double stated = stated_of(*baked);
    const LightOfAll even = even_light(in_balance), half = half_sky(in_balance),
                     sun = sun_of(1e30f), none = no_sky(false);
    if (auto fault = find_unsound(see(even_light(true)), "even", false)) return fault;
    if (auto fault = find_unsound(see(sun), "a sun's", false)) return fault;
    if (auto fault = find_unsound(see(none), "no", true)) return fault;
    const Shown in_furnace = see(even);
    if (built.is_furnace) {
        if (auto fault = find_dark_or_bright(built, in_furnace, stated)) return fault;
    }
    if (auto fault = find_bright(built, in_furnace, "even", stated)) return fault;
    if (auto fault = find_bright(built, see(half), "half the sky's", stated)) return fault;
    const LightOfAll all = half_sky(true), dim = even_light(false);
    constexpr float kBrighter = 3;
    if (auto fault =
            find_nonlinear(see(all), kBrighter, see(dim), see(sum(all, scaled(kBrighter, dim)))))
        return fault;
    if (built.sent && has_lamps(words)) {
        if (auto fault = find_bright(built, see(no_sky(true)), "lamps'", stated, *built.sent))
            return fault;
    }
    return find_fault_again(built, *baked, words.again);
}

std::string inspect(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto baked = bake_coarsely(built.scene, 1);
    if (!baked) return baked.error().diagnostics.front().fault;
    std::string text;
    for (const bake::StageReport& stage : baked->stages) {
        if (stage.seconds > 0.1) text += fmt::format("{}: {:.1f} s\n", stage.name, stage.seconds);
    }
    const Shown shown =
        show(*baked, built.scene.origin, lines_through_volumes(built.scene), even_light(true));
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        double least = 1e30, most = 0, sum = 0, count = 0;
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            if (!built.exposed[p][v]) continue;
            least = std::min(least, shown.vertices[p][v]);
            most = std::max(most, shown.vertices[p][v]);
            sum += shown.vertices[p][v];
            count += 1;
        }
        text += fmt::format(
            "{}: {} of {} vertices seen, {:.3f} to {:.3f}, mean {:.3f} of {:.3f}; all {:.3f}\n",
            built.scene.primitives[p].name, count, shown.vertices[p].size(), least, most,
            sum / count, built.shown[p], mean_of(shown.vertices[p]));
    }
    for (const double value : shown.through_volumes) {
        text += fmt::format("{:.3f} ", value);
    }
    text += fmt::format("stated {:.3f}, of even light {:.3f}\n", baked->error.rms_relative,
                        stated_of(*baked));
    text += describe_again(built, *baked, words.again);
    for (const formats::Diagnostic& warning : baked->warnings) {
        text += warning.where + ": " + warning.fault + "\n";
    }
    return text;
}

}  // namespace opaline::tests
