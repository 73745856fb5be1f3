#include "bake/refine/refine_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "bake/refine/watched_mesh.h"

namespace opaline::bake {
namespace {

constexpr double kShare = 0.5;             // of the squared error that a round halves
constexpr std::uint32_t kMostRounds = 64;  // an edge is halved after two or three
constexpr std::size_t kFewPoints = 512;    // by which a dense mesh is known to need no more

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
};

// What nothing looks at cannot be mended: beside it, half of the limit will do.
bool is_met(const RelativeErrors& error, std::size_t column, double limit) {
    return error.seen[column] + error.unseen[column] <= limit * limit ||
           error.seen[column] <= limit * limit / 4;
}

bool is_met(const RelativeErrors& error, double limit) {
    for (std::size_t c = 0; c < error.seen.size(); ++c) {
        if (!is_met(error, c, limit)) return false;
    }
    return true;
}

RelativeErrors sum_errors(const WatchedMesh& watched, const WatchedMesh::FirstLook& first) {
    RelativeErrors sum{{}, first.unseen};
    for (std::uint32_t t = 0; t < watched.mesh().size(); ++t) {
        if (!watched.is_watched(t)) continue;
        for (std::size_t c = 0; c < sum.seen.size(); ++c) {
            sum.seen[c] += watched.mesh().area(t) * watched.error(t)[c];
        }
    }
    for (std::size_t c = 0; c < sum.seen.size(); ++c) {
        sum.seen[c] = first.total[c] > 0 ? sum.seen[c] / first.total[c] : 0;
        sum.unseen[c] = first.total[c] > 0 ? sum.unseen[c] / first.total[c] : 0;
    }
    return sum;
}

struct RefineJob {
    const RefineLimits& limits;
    const Context& context;
    double shortest;  // edge [m]
    RefineReport& report;

    bool is_full(std::uint64_t added) const {
        report.is_bounded = report.is_bounded || added >= limits.most_added;
        return report.is_bounded || context.cancelled();
    }
};

// By what kinds of light err by too much; whether there was one to halve.
bool halve_worst(const RefineJob& job, const RelativeErrors& error, const ErrorColumns& total,
                 WatchedMesh& watched) {
    struct Candidate {
        double weight;
        std::uint32_t triangle;
    };
    std::vector<Candidate> candidates;
    double sum = 0;
    for (std::uint32_t t = 0; t < watched.mesh().size(); ++t) {
        if (!watched.is_watched(t) || watched.mesh().longest_edge(t) < 2 * job.shortest) continue;
        double weight = 0;
        for (std::size_t c = 0; c < total.size(); ++c) {
            if (!is_met(error, c, job.limits.error)) {
                weight += watched.mesh().area(t) * watched.error(t)[c] / total[c];
            }
        }
        if (weight > 0) candidates.push_back({weight, t});
        sum += weight;
    }
    std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::weight);
    double halved = 0;
    for (const Candidate& candidate : candidates) {
        if (halved >= kShare * sum || job.is_full(watched.mesh().added())) break;
        halved += candidate.weight;
        watched.halve(candidate.triangle);
    }
    return halved > 0;
}

void halve_where_light_changes(const RefineJob& job, WatchedMesh& watched) {
    const double wanted = job.limits.probes_per_receiver * static_cast<double>(job.report.given);
    const auto all = static_cast<std::size_t>(std::clamp(wanted, 256.0, 65536.0));
    const std::size_t few = std::min(all, kFewPoints);
    WatchedMesh::FirstLook first = watched.look_first(few, job.limits.seed);
    RelativeErrors error = sum_errors(watched, first);
    if (few < all && !is_met(error, job.limits.error)) {
        first = watched.look_first(all, job.limits.seed);
        error = sum_errors(watched, first);
    }
    job.report.error_before = job.report.error_after = error.worst();
    for (std::uint32_t round = 0; round < kMostRounds; ++round) {
        if (is_met(error, job.limits.error) || !halve_worst(job, error, first.total, watched)) {
            return;
        }
        watched.look_at_parts();
        if (job.context.cancelled()) return;
        error = sum_errors(watched, first);
        job.report.error_after = error.worst();
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
    if (limits.longest_edge > 0) {
        halve_long_edges(job, watched.mesh());
    } else {
        halve_where_light_changes(job, watched);
    }
    result.report.added = watched.mesh().added();
    result.report.rays = watched.rays();
    if (result.report.added > 0) result.scene = watched.mesh().take();
    return result;
}

}  // namespace opaline::bake
