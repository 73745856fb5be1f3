#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/base/ordered_parallel.h"
#include "bake/reference/path.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Count, mean and spread of samples, per channel. Those added one by one are a group, whose
/// samples may be stratified among each other; groups that are merged are independent.
struct Moments {
    double count = 0;
    glm::dvec3 mean{0};
    glm::dvec3 squares{0};  ///< sum of squared deviations of samples from the mean
    double groups = 0;
    glm::dvec3 group_squares{0};  ///< the same of the groups' means, times the count of each

    void add(glm::dvec3 sample);
    void merge(const Moments& other);
    /// Variance of the mean: the square of its standard error. Of fewer than kFewGroups groups from
    /// the samples, as if they were independent: too large where they are stratified. 0 for fewer
    /// than two samples.
    glm::dvec3 variance_of_mean() const;
    static constexpr double kFewGroups = 4;
};

/// Effort of an estimate.
struct EstimateOptions {
    std::uint32_t samples = 64;  ///< for each pixel or receiver, >= 1
    /// number of the first sample: the estimate over samples 0 to 99 equals those over 0 to 49 and
    /// 50 to 99, merged
    std::uint32_t first = 0;
    /// 0: no limit; else also stop after the round in which the time runs out, with equal sample
    /// counts
    double seconds = 0;
    std::uint64_t seed = 0;
};

struct Estimate {
    std::vector<Moments> pixel;
    std::uint32_t samples = 0;  ///< taken for each
    std::uint64_t lost = 0;     ///< lost paths (PathSample)
    std::uint64_t events = 0;   ///< of all paths
    double seconds = 0;
};

/// Estimates `count` pixels. `sample(pixel, random)`, a PathSample, must be a pure function; it
/// runs on all threads. The result has the same bits for any number of threads, unless `seconds`
/// limits the number of samples. Errors: interrupted.
template <class Sample>
formats::Result<Estimate> estimate_pixels(std::uint32_t count, const EstimateOptions& options,
                                          const Context& context, Sample&& sample) {
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    // A round takes some samples of every pixel, in pieces of equal size, so that few pixels also
    // occupy all threads. The pieces do not depend on the number of threads; each is a group of
    // stratified samples.
    constexpr std::uint32_t kPerPiece = RandomStream::kGroup;
    const std::uint32_t pieces = std::clamp(256 / std::max(count, 1u), 1u, 64u);
    struct Piece {
        Moments moments;
        std::uint64_t lost = 0, events = 0;
    };
    Estimate estimate;
    estimate.pixel.resize(count);
    const std::uint64_t total = std::uint64_t{count} * options.samples;
    while (estimate.samples < options.samples && count > 0) {
        const std::uint32_t first = estimate.samples;
        const std::uint32_t round = std::min(kPerPiece * pieces, options.samples - first);
        const std::uint32_t parts = (round + kPerPiece - 1) / kPerPiece;
        for_each_block_in_order(
            std::size_t{count} * parts, std::max<std::size_t>(parts, 16), context,
            [&](Range range) {
                std::vector<Piece> block;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    const auto pixel = static_cast<std::uint32_t>(i / parts);
                    const auto part = static_cast<std::uint32_t>(i % parts);
                    Piece piece;
                    const std::uint32_t end = std::min(round, (part + 1) * kPerPiece);
                    // Dense media take long: a stop is heard between paths.
                    for (std::uint32_t s = part * kPerPiece; s < end && !context.cancelled(); ++s) {
                        RandomStream random(options.seed, pixel, options.first + first + s);
                        const PathSample one = sample(pixel, random);
                        piece.moments.add(glm::dvec3(one.radiance));
                        piece.lost += one.lost ? 1 : 0;
                        piece.events += one.events;
                    }
                    block.push_back(piece);
                }
                return block;
            },
            [&](Range range, const std::vector<Piece>& block) {
                for (std::size_t i = 0; i < block.size(); ++i) {
                    estimate.pixel[(range.begin + i) / parts].merge(block[i].moments);
                    estimate.lost += block[i].lost;
                    estimate.events += block[i].events;
                }
                if (context.on_progress) {
                    context.on_progress(
                        {"reference",
                         std::uint64_t{count} * first + range.end * std::uint64_t{round} / parts,
                         total});
                }
            });
        if (context.cancelled()) {
            return formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted",
                                       "nothing was written");
        }
        estimate.samples += round;
        estimate.seconds = elapsed();
        if (options.seconds > 0 && estimate.seconds >= options.seconds) break;
    }
    return estimate;
}

}  // namespace opaline::bake
