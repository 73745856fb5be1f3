#include "bake/effects/emitters/emitter_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCheckedReceivers = 32, kPathsOfHalf = 2048;
constexpr double kCrease = 1e-3;  // of the scene's radius
double luminance_of(const glm::dvec3& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

// Irradiance that the file states: opaque receivers have one row.
double stored_irradiance(const EmitterCheck& check, std::uint32_t primitive, std::size_t vertex) {
    double sum = 0;
    for (const formats::EmitterBlock& block : check.emitters.blocks_of(primitive)) {
        const formats::Rgb value = block_value(check.emitters, block, vertex);
        sum += std::numbers::pi * luminance_of({value.r, value.g, value.b});
    }
    return sum;
}

// Whether a surface is so near that paths between both would lose their way in rounding: in a
// crease.
bool is_in_crease(const EmitterCheck& check, const Receiver& receiver, float near) {
    RayPacket packet = rays_from(receiver.origin);
    const Frame frame = make_frame(receiver.normal);
    LaneMask lanes{};
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 8;
        const float slope = i < 8 ? 0.2f : 1.0f;
        set_lane(packet, lanes, i,
                 glm::normalize(frame.to_world({std::cos(turn), std::sin(turn), slope})), near);
    }
    check.rays.occluded(lanes, packet);
    return std::ranges::any_of(packet.tfar, [](float t) { return t < 0; });
}

struct CheckedReceiver {
    double stored = 0;
    std::array<double, 2> truth{};
    std::uint64_t rays = 0;
};

}  // namespace

EmitterErrorReport check_emitters(const EmitterCheck& check, std::uint64_t seed,
                                  const Context& context, std::uint64_t& rays) {
    struct Place {
        std::uint32_t primitive;
        std::size_t vertex;
    };
    std::vector<Place> places;
    const auto near = static_cast<float>(kCrease * check.sources.front().radius);
    for (std::uint32_t p = 0; p < check.primitives.size(); ++p) {
        if (check.primitives[p].shading != formats::Shading::diffuse) continue;
        for (std::size_t v = 0; v < check.receivers[p].size(); ++v) {
            const Receiver& receiver = check.receivers[p].outside[v];
            if (receiver.normal != glm::vec3(0) && !is_in_crease(check, receiver, near)) {
                places.push_back({p, v});
            }
        }
    }
    EmitterErrorReport report;
    const std::size_t count = std::min<std::size_t>(places.size(), kCheckedReceivers);
    const TrueSources sources = collect_true_sources(check.sources);
    double error = 0, squares = 0, reference = 0;
    for_each_block_in_order(
        count, 1, context,
        [&](Range range) {
            // One of each of `count` equal parts of the receivers.
            const auto x = random_uniform(seed, RandomStage::true_gather, range.begin, 0xffffffffu);
            const auto at = static_cast<std::size_t>(
                (static_cast<double>(range.begin) + static_cast<double>(x[0])) *
                static_cast<double>(places.size()) / static_cast<double>(count));
            const Place place = places[std::min(at, places.size() - 1)];
            CheckedReceiver checked;
            checked.stored = stored_irradiance(check, place.primitive, place.vertex);
            for (std::size_t half = 0; half < 2; ++half) {
                checked.truth[half] = luminance_of(trace_irradiance(
                    check, sources, check.receivers[place.primitive].outside[place.vertex],
                    kPathsOfHalf, seed, 2 * range.begin + half, checked.rays));
            }
            return checked;
        },
        [&](Range, CheckedReceiver&& checked) {
            const double square =
                (checked.stored - checked.truth[0]) * (checked.stored - checked.truth[1]);
            error += square;
            squares += square * square;
            reference += checked.truth[0] * checked.truth[1];
            rays += checked.rays;
            ++report.receivers_checked;
        });
    // Where the truth's noise hides the error, report the standard error of the sum.
    const auto n = static_cast<double>(count);
    const double standard_error =
        count > 1 ? std::sqrt(std::max(0.0, squares - error * error / n) * n / (n - 1)) : 0;
    report.rms_relative =
        reference > 0 ? std::sqrt(std::max(error, standard_error) / reference) : 0;
    return report;
}

}  // namespace opaline::bake
