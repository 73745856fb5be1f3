#include "bake/lab/sweep/ladders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::array kQualities{Quality::draft, Quality::preview, Quality::production,
                                Quality::reference};

Knobs preset_knobs(const LadderRequest& request, Quality quality) {
    BakeOptions wanted;
    wanted.quality = quality;
    wanted.effects = request.options.effects;
    wanted.simulate_all = request.options.simulate_all;
    wanted.seed = request.options.seed;
    return *resolve_knobs(request.effects, wanted);  // a preset alone is always possible
}

double coefficient_count(const Knobs& knobs) {
    return static_cast<double>(
        std::min<std::size_t>(knobs.coefficients, formats::cubemap_texels(knobs.cubemap_size)));
}

std::string label_of(const KnobSpec& knob, double value) {
    const std::string pattern(knob.label);
    const std::size_t at = pattern.find("%g");
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return pattern.substr(0, at) + text + pattern.substr(at + 2);
}

// The choice of that name among the subject's knobs; 0 where there is none, or it is the automatic
// one.
std::size_t find_word(const KnobSpec& knob, std::string_view word) {
    const auto found = std::ranges::find(knob.words, word);
    return found == knob.words.end() ? 0 : static_cast<std::size_t>(found - knob.words.begin());
}

// As the user would give it.
void give(Knobs& knobs, const KnobSpec& knob, double value) {
    knobs.set(knob, value);
    if (knob.exact_if_given) {
        knobs.given.push_back(&knob);
    }
}

std::string coefficients_text(const Knobs& knobs) {
    return knobs.coefficients == kAllCoefficients ? "all" : std::to_string(knobs.coefficients);
}

// The list under construction: a setting that is there already gets another rung.
struct Points {
    const SweepSubject& subject;
    std::vector<SweepPoint> list{};

    void add(std::string label, Ladder ladder, double value, const Knobs& wanted) {
        const Knobs knobs = settle(wanted);
        const auto same = std::find_if(list.begin(), list.end(), [&](const SweepPoint& p) {
            return same_bake(p.knobs, knobs, subject);
        });
        if (same == list.end()) {
            list.push_back({std::move(label), {{ladder, value}}, knobs});
        } else if (std::none_of(same->rungs.begin(), same->rungs.end(),
                                [&](const Rung& r) { return r.ladder == ladder; })) {
            same->rungs.push_back({ladder, value});
        }
    }
};

void add_transport_ladders(Points& points, const Knobs& base) {
    for (const std::uint32_t n : {8u, 16u, 32u, 64u}) {
        Knobs knobs = base;
        knobs.cubemap_size = n;
        points.add("N = " + std::to_string(n), Ladders::cubemap, n, knobs);
        knobs.coefficients = kAllCoefficients;
        knobs.code_bits = 16;
        points.add("N = " + std::to_string(n) + ", all coefficients, 16 bits", Ladders::resolution,
                   n, knobs);
    }
    for (const std::uint32_t m : {16u, 32u, 64u, 128u, 256u, 512u, 1024u, kAllCoefficients}) {
        Knobs knobs = base;
        knobs.coefficients = m;
        points.add("M = " + coefficients_text(knobs), Ladders::coefficients,
                   coefficient_count(knobs), knobs);
    }
    Knobs knobs = base;
    knobs.code_bits = 16;
    points.add("16-bit codes", Ladders::code_bits, 16, knobs);
    points.add("8-bit codes", Ladders::code_bits, 8, base);
}

// Every choice in three presets: its cost, and the error that it cannot go below.
void add_choices(Points& points, const LadderRequest& request) {
    for (const KnobSpec* knob : points.subject.knobs) {
        for (std::size_t word = 1; word < knob->words.size(); ++word) {
            for (const Quality quality : {Quality::draft, Quality::preview, Quality::production}) {
                Knobs knobs = preset_knobs(request, quality);
                const auto value = static_cast<double>(word);
                give(knobs, *knob, value);
                points.add(
                    std::string(knob->words[word]) + ", " + std::string(quality_name(quality)),
                    ladder_of(*knob), value, knobs);
            }
        }
    }
}

void add_knob_ladders(Points& points, const Knobs& base) {
    for (const KnobSpec* knob : points.subject.knobs) {
        for (const double value : knob->ladder) {
            Knobs knobs = base;
            give(knobs, *knob, value);
            points.add(label_of(*knob, value), ladder_of(*knob), value, knobs);
        }
    }
    for (const auto& [choice, word, knob] : points.subject.chosen) {
        for (const double value : knob->ladder) {
            Knobs knobs = base;
            give(knobs, *choice, static_cast<double>(word));
            give(knobs, *knob, value);
            points.add(label_of(*knob, value), ladder_of(*knob), value, knobs);
        }
    }
    if (!points.subject.in_media) return;
    for (const bool exact : {false, true}) {
        Knobs knobs = base;
        knobs.exact_rays = exact;
        points.add(exact ? "rays instead of light maps" : "light maps", Ladders::exact_rays,
                   exact ? 1 : 0, knobs);
    }
}

void add_grid(Points& points, const Knobs& base) {
    for (const std::uint32_t n : {8u, 16u, 32u, 64u}) {
        for (const std::uint32_t m : {16u, 32u, 64u, 128u, 256u, 512u, 1024u}) {
            // Many coefficients with a coarse map, or few with a fine one, are never efficient.
            if (m > 2 * n * n || 16 * m < n * n) continue;
            Knobs knobs = base;
            knobs.cubemap_size = n;
            knobs.coefficients = m;
            const std::string label = "N = " + std::to_string(n) + ", M = " + std::to_string(m);
            points.add(label, Ladders::grid, n, knobs);
            // The error of 8-bit codes shows where little is truncated.
            if (m >= 256) {
                knobs.code_bits = 16;
                points.add(label + ", 16 bits", Ladders::grid, n, knobs);
            }
        }
    }
}

// Step 0 is near the base; each step doubles what most knobs cost.
void add_diagonal(Points& points, const Knobs& base) {
    for (int step = -2; step <= 2; ++step) {
        Knobs knobs = base;
        knobs.cubemap_size = step < 0 ? 16 : step < 2 ? 32 : 64;
        knobs.coefficients = static_cast<std::uint32_t>(std::ldexp(128, step));
        for (const KnobSpec* knob : points.subject.knobs) {
            if (!knob->diagonal.empty()) {
                knobs.set(*knob, *(knob->diagonal.begin() + (step + 2)));
            }
        }
        points.add("all knobs " + std::string(step < 0 ? "" : "+") + std::to_string(step),
                   Ladders::diagonal, step, knobs);
    }
}

// One effect's knobs of the truths, number `at` of those beneath the preset.
Knobs with_truths(const LadderRequest& request, Knobs knobs, std::size_t at) {
    for (const EffectDescriptor& effect : request.effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (at < knob->truths.size()) {
                knobs.set(*knob, knob->truths[at]);
            }
        }
    }
    return knobs;
}

// Of nothing but layers.
std::vector<SweepPoint> make_layer_truths(const LadderRequest& request) {
    Points points{request.subject};
    const Knobs reference = preset_knobs(request, Quality::reference);
    points.list.push_back({"tables finer than reference", {}, with_truths(request, reference, 0)});
    points.add("reference", Ladders::preset, 3, reference);
    points.add("production", Ladders::preset, 2, preset_knobs(request, Quality::production));
    return std::move(points.list);
}

// The plan of volumes if those whose way was chosen went by that word.
std::vector<PlanEntry> choose_word(std::span<const PlanEntry> plan, std::string_view word) {
    std::vector<PlanEntry> changed(plan.begin(), plan.end());
    for (PlanEntry& entry : changed) {
        if (!entry.choice.empty()) {
            entry.choice = word;
        }
    }
    return changed;
}

// Knobs of volumes that have no use but by another choice.
void add_chosen_knobs(const EffectTable& effects, std::span<const PlanEntry> plan,
                      SweepSubject& subject) {
    for (const KnobSpec* choice : subject.knobs) {
        for (std::size_t word = 1; word < choice->words.size(); ++word) {
            const std::vector<PlanEntry> other = choose_word(plan, choice->words[word]);
            for (const EffectDescriptor& effect : effects.effects) {
                for (const KnobSpec* knob : effect.knobs) {
                    if (effect.kind == Subject::Kind::volume && !subject.has(*knob) &&
                        knob->matters({}, other)) {
                        subject.chosen.push_back({choice, word, knob});
                    }
                }
            }
        }
    }
}

}  // namespace

bool SweepSubject::has(const KnobSpec& knob) const {
    return std::find(knobs.begin(), knobs.end(), &knob) != knobs.end();
}

SweepSubject sweep_subject(const EffectTable& effects, const formats::Scene& scene,
                           std::span<const PlanEntry> plan, const Knobs& knobs) {
    SweepSubject subject;
    subject.has_surfaces = !scene.primitives.empty();
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if ((effect.kind != Subject::Kind::volume && effect.kind != Subject::Kind::layer) ||
                !knob->matters({}, plan)) {
                continue;
            }
            (effect.kind == Subject::Kind::volume ? subject.has_volumes : subject.has_layers) =
                true;
            subject.knobs.push_back(knob);
        }
    }
    add_chosen_knobs(effects, plan, subject);
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        const auto decisions = entries_of(plan, m);
        if (decisions.empty()) continue;
        const RowLayout layout = layout_material(effects, scene.materials[m], decisions, knobs);
        for (const EffectDescriptor& effect : effects.effects) {
            if (!acts_on(effect, decisions, layout)) continue;
            subject.in_media = subject.in_media || effect.inside_media;
            for (const KnobSpec* knob : effect.knobs) {
                const bool matters = knob->matters == nullptr || knob->matters(layout, decisions);
                if (matters && !subject.has(*knob)) {
                    subject.knobs.push_back(knob);
                }
            }
        }
    }
    return subject;
}

bool same_bake(const Knobs& a, const Knobs& b, const SweepSubject& subject) {
    const bool same_rows = a.cubemap_size == b.cubemap_size && a.coefficients == b.coefficients &&
                           a.code_bits == b.code_bits && a.separate_terms == b.separate_terms;
    const bool same_request =
        a.effects == b.effects && a.simulate_all == b.simulate_all && a.seed == b.seed;
    return same_request && (same_rows || subject.is_layer_alone()) &&
           (!subject.in_media || a.exact_rays == b.exact_rays) &&
           std::all_of(subject.knobs.begin(), subject.knobs.end(),
                       [&](const KnobSpec* knob) {
                           return a[*knob] == b[*knob] &&
                                  (!knob->exact_if_given || a.is_given(*knob) == b.is_given(*knob));
                       }) &&
           std::ranges::all_of(subject.chosen, [&](const ChosenKnob& chosen) {
               return a[*chosen.choice] != static_cast<double>(chosen.word) ||
                      a[*chosen.knob] == b[*chosen.knob];
           });
}

std::vector<SweepPoint> make_ladders(const LadderRequest& request, Quality base) {
    Points points{request.subject};
    for (std::size_t q = 0; q < kQualities.size(); ++q) {
        points.add(std::string(quality_name(kQualities[q])), Ladders::preset,
                   static_cast<double>(q), preset_knobs(request, kQualities[q]));
    }
    add_choices(points, request);
    const Knobs knobs = preset_knobs(request, base);
    if (request.subject.in_media || request.subject.has_volumes || request.subject.has_layers) {
        add_diagonal(points, knobs);
    }
    if (request.subject.has_surfaces) {
        add_transport_ladders(points, knobs);
    }
    add_knob_ladders(points, knobs);
    if (request.subject.has_surfaces) {
        add_grid(points, knobs);
    }
    return std::move(points.list);
}

std::vector<SweepPoint> make_truths(const LadderRequest& request) {
    if (request.subject.is_layer_alone()) return make_layer_truths(request);
    Points points{request.subject};
    Knobs reference = preset_knobs(request, Quality::reference);
    std::string of;  // the choice, where there is one
    for (const KnobSpec* knob : request.subject.knobs) {
        if (const std::size_t word = find_word(*knob, request.choices); word > 0) {
            give(reference, *knob, static_cast<double>(word));
            of = request.choices + ", ";
        }
    }
    const bool is_opaque = !request.subject.in_media && !request.subject.has_volumes;
    if (is_opaque) {
        Knobs finest = reference;
        finest.cubemap_size = 128;
        points.add("N = 128, all coefficients, 16 bits", Ladders::resolution, 128, finest);
    }
    if (of.empty()) {
        points.add("reference", Ladders::preset, 3, reference);
    } else {
        points.list.push_back({of + "reference", {}, reference});
    }
    // Then the knobs that cost most for the least: rays, coefficients, samples, at last resolution.
    struct Rows {
        std::uint32_t cubemap, coefficients;
    };
    constexpr std::array<Rows, 6> kRows{{{64, kAllCoefficients},
                                         {64, 1024},
                                         {32, kAllCoefficients},
                                         {32, 1024},
                                         {32, 512},
                                         {16, kAllCoefficients}}};
    for (std::size_t at = is_opaque ? 1 : 0; at < kRows.size(); ++at) {
        Knobs knobs = with_truths(request, reference, at);
        knobs.exact_rays = false;
        knobs.cubemap_size = kRows[at].cubemap;
        knobs.coefficients = kRows[at].coefficients;
        knobs = settle(std::move(knobs));
        points.list.push_back({of + "N = " + std::to_string(knobs.cubemap_size) +
                                   ", M = " + coefficients_text(knobs) + ", 16 bits, fine",
                               {},
                               knobs});
    }
    return std::move(points.list);
}

}  // namespace opaline::bake
