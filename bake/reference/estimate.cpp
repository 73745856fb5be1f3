#include "bake/reference/estimate.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"

namespace opaline::bake {

void Moments::add(glm::dvec3 sample) {
    groups = std::max(groups, 1.0);
    count += 1;
    const glm::dvec3 deviation = sample - mean;
    mean += deviation / count;
    squares += deviation * (sample - mean);
}

void Moments::merge(const Moments& other) {
    if (other.count == 0) return;
    const double sum = count + other.count;
    const glm::dvec3 deviation = other.mean - mean;
    mean += deviation * (other.count / sum);
    const glm::dvec3 between = deviation * deviation * (count * other.count / sum);
    squares += other.squares + between;
    group_squares += other.group_squares + between;
    groups += other.groups;
    count = sum;
}

glm::dvec3 Moments::variance_of_mean() const {
    if (groups >= kFewGroups) return group_squares / (count * (groups - 1));
    return count > 1 ? squares / (count * (count - 1)) : glm::dvec3(0);
}

formats::Result<Estimate> estimate_pixels(
    std::uint32_t count, const EstimateOptions& options, const Context& context,
    const std::function<PathSample(std::uint32_t pixel, RandomStream& random)>& sample) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(Clock::now() - start).count();
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
        if (context.cancelled()) return interrupted();
        estimate.samples += round;
        estimate.seconds = elapsed();
        if (options.seconds > 0 && estimate.seconds >= options.seconds) break;
    }
    return estimate;
}

}  // namespace opaline::bake
