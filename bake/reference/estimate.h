#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
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

/// Estimates `count` pixels. `sample(pixel, random)` must be a pure function; it runs on all
/// threads. The result has the same bits for any number of threads, unless `seconds` limits the
/// number of samples. Errors: interrupted.
formats::Result<Estimate> estimate_pixels(
    std::uint32_t count, const EstimateOptions& options, const Context& context,
    const std::function<PathSample(std::uint32_t pixel, RandomStream& random)>& sample);

}  // namespace opaline::bake
