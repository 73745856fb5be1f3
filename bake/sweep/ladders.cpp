#include "bake/sweep/ladders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "bake/plan/plan_rules.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::array kQualities{Quality::draft, Quality::preview, Quality::production,
                                Quality::reference};

Knobs preset_knobs(Quality quality, const BakeOptions& options) {
    BakeOptions wanted;
    wanted.quality = quality;
    wanted.effects = options.effects;
    wanted.simulate_all = options.simulate_all;
    wanted.seed = options.seed;
    return *resolve_knobs(wanted);  // a preset alone is always possible
}

// What resolve_knobs does to a user's choice.
Knobs settle(Knobs knobs) {
    knobs.single_cubemap = std::min(knobs.single_cubemap, knobs.cubemap_size);
    if (knobs.coefficients >= formats::cubemap_texels(knobs.cubemap_size)) {
        knobs.coefficients = kAllCoefficients;
    }
    return knobs;
}

double coefficient_count(const Knobs& knobs) {
    return static_cast<double>(
        std::min<std::size_t>(knobs.coefficients, formats::cubemap_texels(knobs.cubemap_size)));
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
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
        points.add("N = " + std::to_string(n), Ladder::cubemap, n, knobs);
        knobs.coefficients = kAllCoefficients;
        knobs.code_bits = 16;
        points.add("N = " + std::to_string(n) + ", all coefficients, 16 bits", Ladder::resolution,
                   n, knobs);
    }
    for (const std::uint32_t m : {16u, 32u, 64u, 128u, 256u, 512u, 1024u, kAllCoefficients}) {
        Knobs knobs = base;
        knobs.coefficients = m;
        points.add("M = " + coefficients_text(knobs), Ladder::coefficients,
                   coefficient_count(knobs), knobs);
    }
    Knobs knobs = base;
    knobs.code_bits = 16;
    points.add("16-bit codes", Ladder::code_bits, 16, knobs);
    points.add("8-bit codes", Ladder::code_bits, 8, base);
}

void add_multiple_ladders(Points& points, const Knobs& base) {
    for (const std::uint32_t s : {1000u, 2000u, 4000u, 8000u, 16000u, 32000u, 64000u}) {
        Knobs knobs = base;
        knobs.samples = s;
        knobs.exact_samples = true;
        points.add(std::to_string(s) + " samples", Ladder::samples, s, knobs);
    }
    for (const double epsilon : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 0.0}) {
        Knobs knobs = base;
        knobs.tolerance = epsilon;
        points.add("epsilon = " + number(epsilon), Ladder::tolerance, epsilon, knobs);
    }
}

void add_single_ladders(Points& points, const Knobs& base, bool anisotropic) {
    for (const std::uint32_t d : {1u, 2u, 4u, 6u, 8u, 16u, 32u}) {
        Knobs knobs = base;
        knobs.depth_samples = d;
        points.add(std::to_string(d) + (d == 1 ? " depth" : " depths"), Ladder::depth_samples, d,
                   knobs);
    }
    for (const std::uint32_t n : {8u, 16u, 32u}) {
        Knobs knobs = base;
        knobs.single_cubemap = n;
        points.add("single scattering at N = " + std::to_string(n), Ladder::single_cubemap, n,
                   knobs);
    }
    if (anisotropic) {
        for (const std::uint32_t k : {1u, 4u, 9u, 16u, 25u}) {
            Knobs knobs = base;
            knobs.phase_terms = k;
            points.add("K = " + std::to_string(k), Ladder::phase_terms, k, knobs);
        }
    }
    for (const bool exact : {false, true}) {
        Knobs knobs = base;
        knobs.exact_rays = exact;
        points.add(exact ? "rays instead of light maps" : "light maps", Ladder::exact_rays,
                   exact ? 1 : 0, knobs);
    }
}

void add_grid(Points& points, const Knobs& base) {
    for (const std::uint32_t n : {8u, 16u, 32u, 64u}) {
        for (const std::uint32_t m : {16u, 32u, 64u, 128u, 256u, 512u, 1024u}) {
            // Many coefficients of a coarse map, or few of a fine one, are never a good buy.
            if (m > 2 * n * n || 16 * m < n * n) {
                continue;
            }
            Knobs knobs = base;
            knobs.cubemap_size = n;
            knobs.coefficients = m;
            const std::string label = "N = " + std::to_string(n) + ", M = " + std::to_string(m);
            points.add(label, Ladder::grid, n, knobs);
            // What eight bits cost shows where little is truncated.
            if (m >= 256) {
                knobs.code_bits = 16;
                points.add(label + ", 16 bits", Ladder::grid, n, knobs);
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
        knobs.samples = static_cast<std::uint32_t>(std::ldexp(16000, step));
        knobs.tolerance = std::ldexp(2e-3, -2 * step);
        knobs.depth_samples = static_cast<std::uint32_t>(6 + 2 * step);
        knobs.single_cubemap = step < 1 ? 8 : 16;
        points.add("all knobs " + std::string(step < 0 ? "" : "+") + std::to_string(step),
                   Ladder::diagonal, step, knobs);
    }
}

}  // namespace

std::string_view ladder_name(Ladder ladder) {
    constexpr std::array<std::string_view, 14> names{
        "preset",     "cubemap", "resolution",    "coefficients",     "code_bits",
        "samples",    "epsilon", "depth_samples", "phase_terms",      "single_cubemap",
        "exact_rays", "grid",    "diagonal",      "reference_samples"};
    return names[static_cast<std::size_t>(ladder)];
}

SweepSubject sweep_subject(const std::vector<PlanEntry>& plan, const formats::Scene& scene) {
    SweepSubject subject;
    for (const PlanEntry& entry : plan) {
        if (!entry.on) {
            continue;
        }
        subject.direct = subject.direct || entry.effect == "direct";
        subject.multiple = subject.multiple || entry.effect == "multiple";
        if (entry.effect == "single") {
            subject.single = true;
            const auto& medium = scene.materials[entry.material].medium;
            subject.anisotropic =
                subject.anisotropic || (medium && formats::mean_cosine(medium->phase) != 0);
        }
        subject.anisotropic = subject.anisotropic || entry.effect == "single.terms";
    }
    return subject;
}

bool same_bake(const Knobs& a, const Knobs& b, const SweepSubject& subject) {
    const bool same_rows = a.cubemap_size == b.cubemap_size && a.coefficients == b.coefficients &&
                           a.code_bits == b.code_bits && a.separate_terms == b.separate_terms &&
                           a.effects == b.effects && a.simulate_all == b.simulate_all &&
                           a.seed == b.seed;
    const bool same_multiple = a.samples == b.samples && a.exact_samples == b.exact_samples &&
                               (a.exact_samples || a.samples_per_path == b.samples_per_path) &&
                               a.tolerance == b.tolerance;
    const bool same_single = a.depth_samples == b.depth_samples && a.phase_terms == b.phase_terms &&
                             a.phase_tolerance == b.phase_tolerance &&
                             a.single_cubemap == b.single_cubemap;
    const bool media = subject.multiple || subject.single;
    return same_rows && (!subject.multiple || same_multiple) && (!subject.single || same_single) &&
           (!media || a.exact_rays == b.exact_rays);
}

std::vector<SweepPoint> make_ladders(const SweepSubject& subject, const BakeOptions& options,
                                     Quality base) {
    Points points{subject};
    for (std::size_t q = 0; q < kQualities.size(); ++q) {
        points.add(std::string(quality_name(kQualities[q])), Ladder::preset, static_cast<double>(q),
                   preset_knobs(kQualities[q], options));
    }
    const Knobs knobs = preset_knobs(base, options);
    if (subject.multiple || subject.single) {
        add_diagonal(points, knobs);
    }
    add_transport_ladders(points, knobs);
    if (subject.multiple) {
        add_multiple_ladders(points, knobs);
    }
    if (subject.single) {
        add_single_ladders(points, knobs, subject.anisotropic);
    }
    add_grid(points, knobs);
    return std::move(points.list);
}

std::vector<SweepPoint> make_truths(const SweepSubject& subject, const BakeOptions& options) {
    Points points{subject};
    const Knobs reference = preset_knobs(Quality::reference, options);
    Knobs knobs = reference;
    if (!subject.multiple && !subject.single) {
        knobs.cubemap_size = 128;
        points.add("N = 128, all coefficients, 16 bits", Ladder::resolution, 128, knobs);
    }
    points.add("reference", Ladder::preset, 3, reference);
    // Then what costs most for the least: rays, coefficients, samples and at last resolution.
    const auto add = [&] {
        points.list.push_back({"N = " + std::to_string(knobs.cubemap_size) +
                                   ", M = " + coefficients_text(settle(knobs)) + ", 16 bits, fine",
                               {},
                               settle(knobs)});
    };
    knobs = reference;
    knobs.exact_rays = false;
    knobs.tolerance = 1e-4;
    knobs.single_cubemap = 32;
    if (subject.multiple || subject.single) {
        add();
    }
    knobs.samples = 150000;
    knobs.coefficients = 1024;
    add();
    knobs.cubemap_size = 32;
    knobs.coefficients = kAllCoefficients;
    add();
    knobs.samples = 60000;
    knobs.tolerance = 3e-4;
    knobs.depth_samples = 10;
    knobs.single_cubemap = 16;
    knobs.coefficients = 1024;
    add();
    knobs.samples = 20000;
    knobs.coefficients = 512;
    add();
    knobs.cubemap_size = 16;
    knobs.coefficients = kAllCoefficients;
    add();
    return std::move(points.list);
}

}  // namespace opaline::bake
