#include "bake/refine/refine_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "bake/refine/watched_mesh.h"

namespace opaline::bake {
namespace {

constexpr double kShare = 0.5;             // of the squared error that a round halves
constexpr std::uint32_t kMostRounds = 64;  // an edge is halved after two or three
constexpr std::size_t kFewPoints = 512;    // by which a dense mesh is known to need no more
constexpr double kLeastPoints = 2048, kMostPoints = 65536;

// Edges that are not halved any more [m].
double shortest_edge(const formats::Scene& scene) {
    constexpr double kFinest = 2e-4;  // of the scene's diagonal
    // Middles of edges must stay apart from their ends in single precision.
    constexpr double kRounding = 1e-5;  // of the largest coordinate
    constexpr double kFar = std::numeric_limits<double>::infinity();
    glm::dvec3 low(kFar), high(-kFar);
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3& x : p.position) {
            low = glm::min(low, glm::dvec3(x));
            high = glm::max(high, glm::dvec3(x));
        }
    }
    if (!(low.x <= high.x)) return 0;
    const glm::dvec3 most = glm::max(glm::abs(low), glm::abs(high));
    return std::max(kFinest * glm::length(high - low),
                    kRounding * std::max({most.x, most.y, most.z}));
}

// Relative mean squares: where triangles are watched, and elsewhere.
struct RelativeErrors {
    ErrorColumns seen{}, unseen{};

    double worst() const {
        double most = 0;
        for (std::size_t c = 0; c < seen.size(); ++c) {
            most = std::max(most, seen[c] + unseen[c]);
        }
        return std::sqrt(most);
    }
    double worst_seen() const { return std::sqrt(std::max(0.0, std::ranges::max(seen))); }
};

bool is_met(const RelativeErrors& error, std::size_t column, double limit) {
    return error.seen[column] + error.unseen[column] <= limit * limit;
}

bool is_met(const RelativeErrors& error, double limit) {
    for (std::size_t c = 0; c < error.seen.size(); ++c) {
        if (!is_met(error, c, limit)) return false;
    }
    return true;
}

RelativeErrors sum_errors(const WatchedMesh& watched) {
    const ErrorColumns& total = watched.total();
    RelativeErrors sum{{}, watched.unseen()};
    for (std::uint32_t t = 0; t < watched.mesh().size(); ++t) {
        if (!watched.is_watched(t)) continue;
        for (std::size_t c = 0; c < total.size(); ++c) {
            sum.seen[c] += watched.mesh().area(t) * watched.error(t)[c];
        }
    }
    for (std::size_t c = 0; c < total.size(); ++c) {
        sum.seen[c] = total[c] > 0 ? sum.seen[c] / total[c] : 0;
        sum.unseen[c] = total[c] > 0 ? sum.unseen[c] / total[c] : 0;
    }
    return sum;
}

// The limit is met where triangles are watched, and no more of the rest is found.
bool is_stuck(const RelativeErrors& before, const RelativeErrors& now, double limit) {
    constexpr double kFound = 0.05;
    for (std::size_t c = 0; c < now.seen.size(); ++c) {
        if (!is_met(now, c, limit) &&
            (now.seen[c] > limit * limit || now.unseen[c] < (1 - kFound) * before.unseen[c])) {
            return false;
        }
    }
    return true;
}

// Most of what errs too much lies in triangles without a point.
bool needs_more_points(const RelativeErrors& error, double limit) {
    for (std::size_t c = 0; c < error.seen.size(); ++c) {
        if (!is_met(error, c, limit) && error.unseen[c] > limit * limit / 2) return true;
    }
    return false;
}

struct RefineJob {
    const RefineLimits& limits;
    const Context& context;
    double shortest;  // edge [m]
    RefineReport& report;

    bool is_full(std::uint64_t added) const {
        if (added >= limits.most_added) report.end = RefineEnd::receivers;
        return report.is_bounded() || context.cancelled();
    }
};

// Halves by what kinds of light err too much; whether there was anything to halve. Triangles that
// err by less than the limit themselves stay, whatever others do.
bool halve_worst(const RefineJob& job, const RelativeErrors& error, WatchedMesh& watched) {
    struct Candidate {
        double weight;
        std::uint32_t triangle;
        double rank = 0;
    };
    std::vector<Candidate> candidates;
    const double limit = job.limits.error * job.limits.error;
    double sum = 0;
    for (std::uint32_t t = 0; t < watched.mesh().size(); ++t) {
        if (!watched.is_watched(t) || watched.mesh().longest_edge(t) < 2 * job.shortest) continue;
        double own = 0;
        for (std::size_t c = 0; c < watched.total().size(); ++c) {
            if (!is_met(error, c, job.limits.error)) {
                own += watched.error(t)[c] * watched.area() / watched.total()[c];
            }
        }
        if (own <= limit) continue;
        candidates.push_back({watched.mesh().area(t) * own, t});
        sum += candidates.back().weight;
    }
    // Alike ones come in their own order, whatever rounding makes of them.
    for (Candidate& candidate : candidates) {
        candidate.rank = std::round(1e6 * candidate.weight / sum);
    }
    std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::rank);
    double halved = 0;
    for (const Candidate& candidate : candidates) {
        if (halved >= kShare * sum || job.is_full(watched.mesh().added())) break;
        halved += candidate.weight;
        watched.halve(candidate.triangle);
    }
    return halved > 0;
}

// How the error falls with receivers: by the root of their number where shadows have edges, hardly
// where each look finds what no receiver tells of, such as hair that shades hair.
class Returns {
  public:
    // Whether twice as many receivers have lowered it by less than an eighth.
    bool are_small(std::uint64_t added, double error) {
        constexpr std::uint64_t kFew = 1000;  // at first errors rise, as more is seen
        constexpr double kNoticed = 0.875;
        const auto half =
            std::ranges::find_if(rounds_.rbegin(), rounds_.rend(),
                                 [&](const Round& round) { return 2 * round.added <= added; });
        const bool found =
            added >= kFew && half != rounds_.rend() && error > kNoticed * half->error;
        rounds_.push_back({added, error});
        return found;
    }

  private:
    struct Round {
        std::uint64_t added;
        double error;
    };
    std::vector<Round> rounds_;
};

// How far the error has come from where it was to the limit, in per cent; 100 ends.
void tell_progress(const RefineJob& job, double share) {
    if (!job.context.on_progress) return;
    constexpr std::uint64_t kWhole = 100;
    const double part = std::clamp(share, 0.0, 1.0) * static_cast<double>(kWhole);
    job.context.on_progress({"refinement", static_cast<std::uint64_t>(part), kWhole});
}

void halve_where_light_changes(const RefineJob& job, WatchedMesh& watched) {
    const double wanted = job.limits.probes_per_receiver * static_cast<double>(job.report.given);
    const auto all = static_cast<std::size_t>(std::clamp(wanted, kLeastPoints, kMostPoints));
    std::size_t points = std::min(all, kFewPoints);
    watched.look_first(points, job.limits.seed);
    RelativeErrors error = sum_errors(watched);
    while (points < all && needs_more_points(error, job.limits.error)) {
        if (job.context.cancelled()) return;
        points = std::min(all, 4 * points);
        watched.look_first(points, job.limits.seed);
        error = sum_errors(watched);
    }
    job.report.error_before = job.report.error_after = error.worst();
    RefineEnd& end = job.report.end;
    Returns returns;
    for (std::uint32_t round = 0; round < kMostRounds && !is_met(error, job.limits.error);
         ++round) {
        if (job.report.is_bounded()) return;
        if (!halve_worst(job, error, watched)) {
            if (!job.report.is_bounded()) end = RefineEnd::edges;
            return;
        }
        watched.look_at_parts();
        if (job.context.cancelled()) return;
        const RelativeErrors before = std::exchange(error, sum_errors(watched));
        job.report.error_after = error.worst();
        if (is_stuck(before, error, job.limits.error)) {
            end = RefineEnd::points;
            return;
        }
        if (returns.are_small(watched.mesh().added(), error.worst_seen())) {
            end = RefineEnd::returns;
            return;
        }
        const double whole = std::log(job.report.error_before / job.limits.error);
        tell_progress(job, 0.99 * std::log(job.report.error_before / error.worst()) / whole);
    }
}

void halve_long_edges(const RefineJob& job, SplitMesh& mesh) {
    const double limit = std::max(job.limits.longest_edge, job.shortest);
    std::vector<SplitMesh::Half> halves;
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        while (mesh.longest_edge(t) > limit) {
            if (job.is_full(mesh.added())) return;
            mesh.halve(t, halves);
            halves.clear();
        }
    }
}

}  // namespace

RefinedScene refine_scene(const formats::Scene& scene, const RayScene& rays,
                          std::span<const LampSources> lamps, const RefineLimits& limits,
                          const Context& context) {
    RefinedScene result;
    for (const formats::Primitive& p : scene.primitives) {
        result.report.given += p.position.size();
    }
    const double shortest = shortest_edge(scene);
    const RefineJob job{limits, context, shortest, result.report};
    WatchedMesh watched(scene, rays, lamps, limits.cubemap_size, shortest, context);
    if (watched.mesh().size() == 0) return result;
    tell_progress(job, 0);
    if (limits.longest_edge > 0) {
        halve_long_edges(job, watched.mesh());
    } else {
        halve_where_light_changes(job, watched);
    }
    tell_progress(job, 1);
    result.report.added = watched.mesh().added();
    result.report.rays = watched.rays();
    if (result.report.added > 0) result.scene = watched.mesh().take();
    return result;
}

}  // namespace opaline::bake
