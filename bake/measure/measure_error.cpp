#include "bake/measure/measure_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kLeastChecked = 16, kMostChecked = 256, kReceiversPerCheck = 40;

double dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
    }
    return sum;
}

// Different receivers, in ascending order.
std::vector<std::uint32_t> draw_receivers(std::size_t count, std::uint64_t seed) {
    const std::size_t wanted =
        std::min(count, std::clamp(count / kReceiversPerCheck, kLeastChecked, kMostChecked));
    std::vector<std::uint32_t> drawn;
    // One from each of `wanted` equal runs: spread over all primitives, never twice the same.
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const double u =
            static_cast<double>(random_uniform(seed, RandomStage::held_back_receivers, i)[0]);
        drawn.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(u * static_cast<double>(end - begin))));
    }
    return drawn;
}

// One receiver under one light.
struct Pair {
    double error = 0, reference = 0;
};

struct Checked {
    std::vector<Pair> pairs;
    std::uint64_t rays = 0;
};

Checked check_receiver(const RayScene& rays, const DirectionSet& fine, const Receiver& receiver,
                       std::uint32_t index, const formats::SparseRowsView& rows,
                       std::span<const TestLight> lights) {
    const std::size_t size = lights.front().coarse.size();
    std::vector<float> stored(size), dense(4 * size);
    formats::decode_row(rows, {0, rows.rows(), 1, 0, 0}, index, 0, stored);
    Checked checked;
    checked.rays = gather_irradiance(rays, fine, receiver, dense);
    formats::haar_forward_cube(std::span<float>(dense), fine.cubemap_size);
    for (const TestLight& light : lights) {
        const double reference = dot(dense, light.fine) * std::numbers::inv_pi;
        checked.pairs.push_back({dot(stored, light.coarse) - reference, reference});
    }
    return checked;
}

double relative_rms(std::span<const Pair> pairs) {
    double error = 0, reference = 0;
    for (const Pair& p : pairs) {
        error += p.error * p.error;
        reference += p.reference * p.reference;
    }
    return reference > 0 ? std::sqrt(error / reference) : 0.0;
}

// Percentile bootstrap: resampling whole receivers, since one receiver's lights are not
// independent.
void bootstrap(std::span<const Pair> pairs, std::size_t lights, std::uint64_t seed,
               double (&interval)[2]) {
    constexpr std::uint32_t kResamples = 1000;
    const std::size_t receivers = pairs.size() / lights;
    std::vector<double> estimate(kResamples);
    std::vector<Pair> resample;
    for (std::uint32_t r = 0; r < kResamples; ++r) {
        resample.clear();
        for (std::size_t i = 0; i < receivers; ++i) {
            const double u =
                static_cast<double>(random_uniform(seed, RandomStage::bootstrap, i, r)[0]);
            const auto chosen = static_cast<std::size_t>(u * static_cast<double>(receivers));
            const auto own = pairs.subspan(chosen * lights, lights);
            resample.insert(resample.end(), own.begin(), own.end());
        }
        estimate[r] = relative_rms(resample);
    }
    std::sort(estimate.begin(), estimate.end());
    interval[0] = estimate[static_cast<std::size_t>(0.025 * kResamples)];
    interval[1] = estimate[static_cast<std::size_t>(0.975 * kResamples)];
}

}  // namespace

ErrorReport measure_direct_error(const RayScene& rays, std::span<const Receiver> receivers,
                                 const formats::SparseRowsView& rows,
                                 std::span<const TestLight> lights, std::uint64_t seed,
                                 const Context& context) {
    ErrorReport report;
    report.reference =
        "dense, unquantised transport at twice the cube map resolution; luminance under white, "
        "sun:30,60, sun:150,35, sun:270,15, studio and sky:3,35";
    if (receivers.empty() || lights.empty()) {
        return report;
    }
    const DirectionSet fine = make_direction_set(2 * rows.cubemap_size);
    const std::vector<std::uint32_t> drawn = draw_receivers(receivers.size(), seed);
    std::vector<Pair> pairs;
    for_each_block_in_order(
        drawn.size(), 1, context,
        [&](Range range) {
            const std::uint32_t index = drawn[range.begin];
            return check_receiver(rays, fine, receivers[index], index, rows, lights);
        },
        [&](Range, Checked checked) {
            pairs.insert(pairs.end(), checked.pairs.begin(), checked.pairs.end());
            report.rays += checked.rays;
        });
    if (pairs.empty()) {
        return report;  // cancelled
    }
    report.receivers_checked = static_cast<std::uint32_t>(pairs.size() / lights.size());
    report.rms_relative = relative_rms(pairs);
    bootstrap(pairs, lights.size(), seed, report.ci95);
    double squares = 0;
    std::vector<double> magnitude;
    for (const Pair& p : pairs) {
        squares += p.reference * p.reference;
        magnitude.push_back(std::abs(p.error));
    }
    std::sort(magnitude.begin(), magnitude.end());
    const double rms = std::sqrt(squares / static_cast<double>(pairs.size()));
    if (rms > 0) {
        report.p95_relative =
            magnitude[static_cast<std::size_t>(0.95 * static_cast<double>(magnitude.size() - 1))] /
            rms;
        report.max_relative = magnitude.back() / rms;
    }
    report.by_effect = {{"direct", report.rms_relative}};
    return report;
}

}  // namespace opaline::bake
