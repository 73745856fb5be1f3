#include "bake/plan/stage_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/plan/plan_rules.h"
#include "bake/receivers/kd_order.h"
#include "bake/scattering/dipole.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

constexpr double kTruthRays = 12.0 * 64 * 64;  // truth.h: a cube map of 64, half of it

// What one band costs of what three do; measured.
constexpr double kGreyEntry = 0.8, kGreyLookUp = 0.8, kGreyUnpacking = 0.4;

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

// Coefficients that a sample or node keeps: below its horizon they vanish.
double kept_by_samples(const Knobs& knobs) {
    return std::min(static_cast<double>(sample_coefficients(knobs)), texels(knobs.cubemap_size));
}

std::array<Dipole, 3> dipoles_of(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    const auto make = [&](float sigma_s, float sigma_a) {
        return make_dipole(DipoleKind::better, (1 - g) * static_cast<double>(sigma_s),
                           static_cast<double>(sigma_a), static_cast<double>(medium.eta));
    };
    return {make(medium.sigma_s.r, medium.sigma_a.r), make(medium.sigma_s.g, medium.sigma_a.g),
            make(medium.sigma_s.b, medium.sigma_a.b)};
}

// Of the walks that a medium's reflectance is found by, band by band; equal neighbours share one.
double walk_events(const formats::Medium& medium) {
    constexpr double kPaths = 65536, kLeastAbsorbed = 1e-3;
    const double g = formats::mean_cosine(medium.phase);
    const std::array<std::array<float, 2>, 3> bands{{{medium.sigma_s.r, medium.sigma_a.r},
                                                     {medium.sigma_s.g, medium.sigma_a.g},
                                                     {medium.sigma_s.b, medium.sigma_a.b}}};
    double events = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        const auto [sigma_s, sigma_a] = bands[b];
        if (sigma_s > 0 && (b == 0 || bands[b] != bands[b - 1])) {
            const double absorbed = static_cast<double>(sigma_a / (sigma_s + sigma_a));
            events += kPaths * count_walk_events(1 - std::max(absorbed, kLeastAbsorbed), g,
                                                 static_cast<double>(medium.eta));
        }
    }
    return events;
}

}  // namespace

double count_rays(std::uint32_t cubemap_size) {
    return 2 * texels(cubemap_size);
}

double count_walk_events(double albedo, double g, double eta) {
    // Absorption ends a walk after a number of events that grows as the root of its inverse; the
    // boundary turns walks back.
    const double s = std::sqrt((1 - albedo) * (1 - albedo * g));
    const double back = std::max(0.0, eta - 1);
    return 1 + (4.9 + 16.6 * back) / (s + (0.4 + 3.8 * back) * s * s);
}

double expected_samples(const formats::Medium& medium, double area, const Knobs& knobs) {
    const double least = 2000 * knobs.samples_per_path;  // count_samples, medium_profile.h
    const double most = knobs.samples;
    if (knobs.exact_samples) {
        return most;
    }
    double depth = HUGE_VAL;
    for (const Dipole& d : dipoles_of(medium)) {
        depth = dipole_total(d) > 0 ? std::min(depth, d.z_real) : depth;
    }
    return std::clamp(knobs.samples_per_path * area / (depth * depth), std::min(least, most), most);
}

double count_weights(const formats::Medium& medium, const MaterialFacts& facts, double samples,
                     double tolerance) {
    constexpr double kWidth = 1.2;      // gather_profile.cpp: of the profile, in spacings
    constexpr double kRounding = 1.44;  // nodes have 1/2 to 1 of the area that would do
    const double sample_area = facts.area / samples;
    const double reach = std::sqrt(facts.area / pi);
    double count = 0;
    // Rings, evenly spaced in the logarithm of their radius.
    constexpr int kRings = 48;
    const auto dipoles = dipoles_of(medium);
    double smallest = HUGE_VAL;
    for (const Dipole& d : dipoles) {
        smallest = dipole_total(d) > 0 ? std::min(smallest, d.z_real) : smallest;
    }
    if (!std::isfinite(smallest)) {
        return 0;
    }
    const double nearest = std::min(0.1 * std::max(smallest, std::sqrt(sample_area)), 0.5 * reach);
    const double step = std::log(reach / nearest) / kRings;
    const auto far = [&](const Dipole& d, double r) {
        const double wanted = kWidth * std::sqrt(sample_area);
        const double b2 = std::max(0.0, wanted * wanted - d.z_real * d.z_real);
        return eval_dipole(d, std::sqrt(r * r + b2));
    };
    const auto may_take = [&](double r, double patch) {
        const double side = std::sqrt(patch);
        for (const Dipole& d : dipoles) {
            const double change = far(d, std::max(0.0, r - 0.5 * side)) - far(d, r + 0.7 * side);
            if (patch * change > tolerance * dipole_total(d)) {
                return false;
            }
        }
        return true;
    };
    for (int i = 0; i < kRings; ++i) {
        const double inner = i == 0 ? 0 : nearest * std::exp(step * i);
        const double outer = nearest * std::exp(step * (i + 1));
        const double r = 0.5 * (inner + outer);
        double patch = facts.area;
        while (patch > sample_area && !may_take(r, patch)) {
            patch *= 0.84;
        }
        const double taken = patch / kRounding;
        count += pi * (outer * outer - inner * inner) /
                 (taken < kSamplesPerLeaf * sample_area ? sample_area : taken);
    }
    return std::min(count, samples);
}

Work direct_rows_work(const CostInput& input, double receivers, bool occluded) {
    // Scenes took 1 to 2.2 times what the ball does: rays of some pass closer by more.
    constexpr double kClutter = 1.5;
    const double ray =
        occluded ? kClutter * input.rates.coherent_ray.at(input.triangles) : input.rates.open_cell;
    return {0, receivers * count_rays(input.knobs.cubemap_size) * ray};
}

Work encode_work(const CostInput& input, std::uint32_t rows, std::uint32_t bands,
                 double receivers) {
    const double texel = bands == 1 ? input.rates.encode_grey : input.rates.encode_colour;
    return {0, receivers * rows * texels(input.knobs.cubemap_size) * texel};
}

Work albedo_work(const CostInput& input, const formats::Medium& medium) {
    return {0, walk_events(medium) * input.rates.walk_event};
}

Work profile_work(const CostInput& input, const formats::Medium& medium) {
    // make_medium_profile: these two are not matched to a walk.
    if (medium.profile == formats::Medium::Profile::classic ||
        medium.fidelity == formats::Medium::Fidelity::paper) {
        return {};
    }
    return albedo_work(input, medium);
}

Work samples_work(const CostInput& input, const formats::Medium& medium, const MaterialFacts& facts,
                  bool occluded) {
    const Rates& rates = input.rates;
    const Knobs& knobs = input.knobs;
    const double samples = expected_samples(medium, facts.area, knobs);
    const double own = texels(knobs.cubemap_size);
    Work work{samples * rates.place_sample, 0};
    const double seen = !occluded          ? 0.5 * rates.open_cell  // half are below the horizon
                        : knobs.exact_rays ? 0.5 * rates.coherent_ray.at(input.triangles)
                                           : rates.shared_texel.at(input.triangles);
    work.shared += samples * own * (seen + rates.truncate_texel);
    // build_cluster_tree: each level adds all samples up; each node is truncated.
    const double levels = std::max(1.0, std::ceil(std::log2(samples / kSamplesPerLeaf)) + 1);
    const double nodes = 2 * samples / kSamplesPerLeaf;
    work.shared += samples * levels * kept_by_samples(knobs) * rates.sum_entry +
                   nodes * own * rates.truncate_texel;
    return work;
}

Work multiple_rows_work(const CostInput& input, const formats::Medium& medium,
                        const MaterialFacts& facts, std::uint32_t bands, double receivers) {
    const double samples = expected_samples(medium, facts.area, input.knobs);
    const double weights = count_weights(medium, facts, samples, input.knobs.tolerance);
    const double entry = input.rates.gather_entry * (bands == 1 ? kGreyEntry : 1);
    return {0,
            receivers * weights * (input.rates.take_weight + kept_by_samples(input.knobs) * entry)};
}

Work light_maps_work(const CostInput& input, const MaterialFacts& facts) {
    return input.knobs.exact_rays
               ? Work{}
               : Work{0, facts.triangles * input.rates.body_triangle.at(input.triangles)};
}

Work single_rows_work(const CostInput& input, const MaterialFacts& facts, std::uint32_t terms,
                      std::uint32_t bands, double receivers) {
    const Rates& rates = input.rates;
    const bool grey = bands == 1;
    const double coarse = texels(input.knobs.single_cubemap);
    const double nodes = receivers * input.knobs.depth_samples;
    const double unpacked =
        receivers * terms * coarse * rates.unpack_texel * (grey ? kGreyUnpacking : 1);
    if (input.knobs.exact_rays) {
        constexpr double kRaysPerTexel = 4, kRaysPerPacket = 16;
        return {0, nodes * coarse * kRaysPerTexel / kRaysPerPacket *
                           rates.entry_packet.at(input.triangles) +
                       unpacked};
    }
    // TranslucentRecipe::batch_bytes: each batch renders all views anew.
    constexpr double kBatchBytes = 2147483648.0;
    const double batches = std::ceil(receivers * coarse * terms * (grey ? 2 : 4) / kBatchBytes);
    const double edge =
        std::sqrt(facts.area / std::max(facts.triangles, 1.0) * 4 / std::numbers::sqrt3);
    const double pixels = std::pow(
        std::clamp(
            edge > 0 ? 4 * static_cast<double>(glm::length(facts.high - facts.low)) / edge : 128.0,
            128.0, 2048.0),
        2);
    const double view = input.triangles * rates.draw_triangle + pixels * rates.draw_pixel;
    return {0, receivers * rates.place_nodes.at(input.triangles) + batches * coarse * view +
                   nodes * coarse * (grey ? kGreyLookUp : 1) *
                       (rates.look_up.at(input.triangles) + (terms - 1) * rates.look_up_term) +
                   unpacked};
}

Work openness_work(const CostInput& input, double glossy_receivers, bool occluded) {
    const double above = 0.5 * texels(kOpennessCubemap);
    return {0, glossy_receivers * (occluded ? input.rates.openness.at(input.triangles)
                                            : above * input.rates.open_cell)};
}

Work direct_check_work(const CostInput& input, double checked, bool occluded) {
    return {0,
            checked * kTruthRays *
                (occluded ? input.rates.coherent_ray.at(input.triangles) : input.rates.open_cell)};
}

Work medium_check_work(const CostInput& input, const MaterialFacts& facts, const RowLayout& layout,
                       double checked, const TruthEffort& effort) {
    const Rates& rates = input.rates;
    double each = 0;
    if (layout.multiple) {
        each += facts.triangles * rates.split_triangle +
                2 * effort.points * rates.surface_point.at(input.triangles);
    }
    if (layout.single_terms > 0) {
        constexpr double kPackets = 97;  // true_single.cpp: a cube map of 8, and the suns
        each += effort.depth_samples * kPackets * rates.entry_packet.at(input.triangles);
    }
    return {0, checked * each};
}

}  // namespace opaline::bake
