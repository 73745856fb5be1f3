#include "bake/refine/refine_scene.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bake/base/rng.h"
#include "bake/receivers/surface_points.h"
#include "bake/refine/proxy_rows.h"
#include "bake/refine/split_mesh.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kShare = 0.5;             // of the squared error that a round halves
constexpr std::uint32_t kMostRounds = 64;  // an edge is halved after two or three
constexpr double kFinest = 2e-4;           // shortest edge, of the scene's diagonal
constexpr std::size_t kColumns = 1 + ProxyTracer::kMostLamps;
using Columns = std::array<double, kColumns>;  // of the distant light, and of lamps

struct Look {
    glm::vec3 weight;   // of the triangle's corners
    std::uint32_t row;  // of the proxies
    bool is_middle;     // of the longest edge
};

// What is known of a triangle.
struct Watched {
    std::vector<Look> looks;
    bool is_watched = false;  // some point of it, or of what it was part of, was looked at
    Columns error{};          // mean square between its corners
};

class Refiner {
  public:
    Refiner(const formats::Scene& scene, const RayScene& rays, std::span<const LampSources> lamps,
            const RefineLimits& limits, const Context& context)
        : limits_(limits),
          context_(context),
          mesh_(scene),
          tracer_(mesh_.scene(), rays, limits.cubemap_size, lamps),
          rows_(tracer_.no_rows()),
          solid_angle_(formats::texel_solid_angles(limits.cubemap_size)),
          watched_(mesh_.size()),
          vertex_row_(scene.primitives.size()) {
        for (std::size_t p = 0; p < vertex_row_.size(); ++p) {
            vertex_row_[p].resize(scene.primitives[p].position.size(), formats::kNone);
            report_.given += scene.primitives[p].position.size();
        }
        measure_scene();
    }

    RefinedScene run() {
        if (mesh_.size() > 0) {
            if (limits_.longest_edge > 0) {
                halve_long_edges();
            } else if (report_.given > 0) {
                halve_where_light_changes();
            }
        }
        report_.added = mesh_.added();
        RefinedScene result{std::nullopt, report_};
        if (report_.added > 0) result.scene = mesh_.take();
        return result;
    }

  private:
    void measure_scene() {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        glm::dvec3 low(kFar), high(-kFar), most(0);
        for (const formats::Primitive& p : mesh_.scene().primitives) {
            for (const glm::vec3& x : p.position) {
                low = glm::min(low, glm::dvec3(x));
                high = glm::max(high, glm::dvec3(x));
                most = glm::max(most, glm::abs(glm::dvec3(x)));
            }
        }
        const double diagonal = report_.given > 0 ? glm::length(high - low) : 0;
        // Middles of edges must stay apart from their ends in single precision.
        const double rounding = 1e-5 * std::max({most.x, most.y, most.z});
        shortest_ = std::max(kFinest * diagonal, rounding);
    }

    bool is_full() {
        report_.is_bounded = report_.is_bounded || mesh_.added() >= limits_.most_added;
        return report_.is_bounded || context_.cancelled();
    }

    void halve_long_edges() {
        const double limit = std::max(limits_.longest_edge, shortest_);
        std::vector<SplitMesh::Half> halves;
        for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
            while (mesh_.longest_edge(t) > limit) {
                if (is_full()) return;
                mesh_.halve(t, halves);
                halves.clear();
            }
        }
    }

    void halve_where_light_changes() {
        look_first();
        if (!(std::ranges::max(total_) > 0)) return;  // nothing to see
        std::vector<std::uint32_t> fresh;
        for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
            if (watched_[t].is_watched) fresh.push_back(t);
        }
        for (std::uint32_t round = 0; round < kMostRounds; ++round) {
            look_at(fresh);
            if (context_.cancelled()) return;
            measure(fresh);
            if (round == 0) add_unseen();
            const Columns error = sum_errors();
            (round == 0 ? report_.error_before : report_.error_after) = worst(error);
            if (round == 0) report_.error_after = report_.error_before;
            if (worst(error) <= limits_.error) return;
            fresh = halve_worst(error);
            if (fresh.empty()) return;
        }
    }

    // One point in each of many equal parts of the surface.
    void look_first() {
        std::vector<std::uint32_t> all(mesh_.scene().primitives.size());
        std::iota(all.begin(), all.end(), 0u);
        const AreaTable table = make_area_table(mesh_.scene(), all);
        area_ = table.total();
        if (!(area_ > 0)) return;
        const double wanted = limits_.probes_per_receiver * static_cast<double>(report_.given);
        first_ = static_cast<std::size_t>(std::clamp(wanted, 256.0, 65536.0));
        std::vector<ProxyPoint> points;
        std::uint32_t t = 0;
        for (const SurfacePoint& at : scatter_points(mesh_.scene(), table, first_, false,
                                                     limits_.seed, RandomStage::refine_probes)) {
            while (mesh_[t].primitive != at.primitive || mesh_[t].first_index != at.first_index) {
                ++t;  // both in the scene's order
            }
            watched_[t].looks.push_back(
                {at.barycentric, static_cast<std::uint32_t>(points.size()), false});
            watched_[t].is_watched = true;
            points.push_back({at.primitive, at.first_index, at.barycentric});
        }
        trace(points);
        if (context_.cancelled()) return;
        for (std::size_t row = 0; row < points.size(); ++row) {
            const Columns square = square_of(static_cast<std::uint32_t>(row), {});
            for (std::size_t c = 0; c < kColumns; ++c) {
                total_[c] += area_ / static_cast<double>(points.size()) * square[c];
            }
        }
    }

    void trace(std::span<const ProxyPoint> points) {
        report_.rays += tracer_.append(points, context_, rows_);
    }

    // A place of a triangle, a little inside it: on an edge rays may start in a wall.
    ProxyPoint point_in(std::uint32_t triangle, glm::vec3 weight) const {
        const SplitMesh::Triangle& t = mesh_[triangle];
        const double way = 0.05 * shortest_ / mesh_.longest_edge(triangle);
        weight = glm::mix(weight, glm::vec3(1.0f / 3.0f), static_cast<float>(way));
        return {t.primitive, t.first_index,
                weight.x * t.weight[0] + weight.y * t.weight[1] + weight.z * t.weight[2]};
    }

    // Traces the rows that triangles need: of their corners, and of middles.
    void look_at(std::span<const std::uint32_t> triangles) {
        std::vector<ProxyPoint> points;
        const auto add = [&](std::uint32_t t, glm::vec3 weight) {
            points.push_back(point_in(t, weight));
            return static_cast<std::uint32_t>(rows_.size() + points.size() - 1);
        };
        for (const std::uint32_t t : triangles) {
            const SplitMesh::Triangle& triangle = mesh_[t];
            for (std::uint32_t k = 0; k < 3; ++k) {
                std::uint32_t& row = vertex_row_[triangle.primitive][triangle.corner[k]];
                if (row != formats::kNone) continue;
                glm::vec3 weight(0);
                weight[static_cast<glm::length_t>(k)] = 1;
                row = add(t, weight);
            }
            Watched& own = watched_[t];
            if (triangle.depth == 0 || own.looks.size() >= 2) continue;
            const std::uint32_t side = mesh_.longest_side(t);
            glm::vec3 weight(0.5f);
            weight[static_cast<glm::length_t>((side + 2) % 3)] = 0;
            const auto [at, is_new] = middle_row_.try_emplace(edge_of(t, side), 0);
            if (is_new) at->second = add(t, weight);
            own.looks.push_back({weight, at->second, true});
        }
        trace(points);
    }

    struct VertexEdge {
        std::uint32_t primitive, low, high;

        bool operator==(const VertexEdge&) const = default;
    };
    struct EdgeHash {
        std::size_t operator()(const VertexEdge& e) const {
            std::uint64_t h = e.primitive * 0x9e3779b97f4a7c15u;
            h = (h ^ (std::uint64_t{e.low} << 32 | e.high)) * 0xff51afd7ed558ccdu;
            return h ^ h >> 32;
        }
    };
    VertexEdge edge_of(std::uint32_t triangle, std::uint32_t side) const {
        const SplitMesh::Triangle& t = mesh_[triangle];
        const std::uint32_t a = t.corner[side], b = t.corner[(side + 1) % 3];
        return {t.primitive, std::min(a, b), std::max(a, b)};
    }

    struct Corner {
        std::uint32_t row;
        float weight;
    };

    // Square of what a row is beyond the sum of others, by column: of the mean over suns of all
    // directions, 1 of an open receiver, and of an even sky's, 1 as well; of lamps.
    Columns square_of(std::uint32_t row, std::span<const Corner> others) const {
        const auto own = rows_.cells_of(row);
        const std::size_t face = solid_angle_.size();
        double suns = 0, sky = 0;
        for (std::size_t j = 0; j < own.size(); ++j) {
            float value = own[j];
            for (const Corner& other : others) {
                value -= other.weight * static_cast<float>(rows_.cell[other.row * own.size() + j]);
            }
            const double difference = static_cast<double>(value) / 255;
            suns += solid_angle_[j % face] * difference * difference;
            sky += solid_angle_[j % face] * difference;
        }
        constexpr double kPi = std::numbers::pi;
        Columns square{};
        square[0] = 0.5 * (suns * 3 / (2 * kPi) + sky / kPi * sky / kPi);
        for (std::size_t lamp = 0; lamp < rows_.lamps; ++lamp) {
            double value = static_cast<double>(rows_.lamps_of(row)[lamp]);
            for (const Corner& other : others) {
                value -= static_cast<double>(other.weight * rows_.lamps_of(other.row)[lamp]);
            }
            square[1 + lamp] = value * value;
        }
        return square;
    }

    // What light spreads over inside a medium changes less over a shorter way.
    double contrast(std::uint32_t triangle) const {
        const formats::Scene& scene = mesh_.scene();
        const std::uint32_t material = scene.primitives[mesh_[triangle].primitive].material;
        if (!scene.materials[material].medium) return 1;
        const double ratio =
            static_cast<double>(tracer_.reach(material).spread()) / mesh_.longest_edge(triangle);
        return 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
    }

    void measure(std::span<const std::uint32_t> triangles) {
        for (const std::uint32_t t : triangles) {
            const SplitMesh::Triangle& triangle = mesh_[t];
            Watched& own = watched_[t];
            own.error = {};
            std::uint32_t seen = 0;
            for (const Look& look : own.looks) {
                if (rows_.hidden[look.row] != 0) continue;
                ++seen;
                // Hidden corners get a row beside the visible ones.
                std::array<Corner, 3> corners{};
                std::size_t count = 0;
                float sum = 0;
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const std::uint32_t row = vertex_row_[triangle.primitive][triangle.corner[k]];
                    const float weight = look.weight[static_cast<glm::length_t>(k)];
                    if (rows_.hidden[row] != 0 || !(weight > 0)) continue;
                    corners[count++] = {row, weight};
                    sum += weight;
                }
                for (std::size_t k = 0; k < count; ++k) {
                    corners[k].weight /= sum;
                }
                const Columns square = square_of(look.row, std::span(corners).first(count));
                for (std::size_t c = 0; c < kColumns; ++c) {
                    own.error[c] += square[c];
                }
            }
            const double scale = seen == 0 ? 0 : contrast(t) / seen;
            for (double& error : own.error) {
                error *= scale;
            }
        }
    }

    // A small triangle's first point stands for others beside it, which nothing looks at.
    void add_unseen() {
        const double share = area_ / static_cast<double>(first_);
        for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
            const double stands_for = share * static_cast<double>(watched_[t].looks.size());
            const double others = std::max(0.0, stands_for - mesh_.area(t));
            for (std::size_t c = 0; c < kColumns; ++c) {
                unseen_[c] += others * watched_[t].error[c];
            }
        }
    }

    // Relative mean squares.
    Columns sum_errors() const {
        Columns sum = unseen_;
        for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
            if (!watched_[t].is_watched) continue;
            for (std::size_t c = 0; c < kColumns; ++c) {
                sum[c] += mesh_.area(t) * watched_[t].error[c];
            }
        }
        for (std::size_t c = 0; c < kColumns; ++c) {
            sum[c] = total_[c] > 0 ? sum[c] / total_[c] : 0;
        }
        return sum;
    }

    static double worst(const Columns& error) {
        return std::sqrt(*std::max_element(error.begin(), error.end()));
    }

    // Of columns that are above the limit; returns what must be looked at.
    std::vector<std::uint32_t> halve_worst(const Columns& error) {
        struct Candidate {
            double weight;
            std::uint32_t triangle;
        };
        std::vector<Candidate> candidates;
        double sum = 0;
        for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
            if (!watched_[t].is_watched || mesh_.longest_edge(t) < 2 * shortest_) continue;
            double weight = 0;
            for (std::size_t c = 0; c < kColumns; ++c) {
                if (std::sqrt(error[c]) > limits_.error) {
                    weight += mesh_.area(t) * watched_[t].error[c] / total_[c];
                }
            }
            if (weight > 0) candidates.push_back({weight, t});
            sum += weight;
        }
        std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::weight);
        std::vector<SplitMesh::Half> halves;
        double halved = 0;
        for (const Candidate& candidate : candidates) {
            if (halved >= kShare * sum || is_full()) break;
            halved += candidate.weight;
            const std::size_t before = halves.size();
            mesh_.halve(candidate.triangle, halves);
            inherit(std::span(halves).subspan(before));
        }
        std::vector<std::uint32_t> fresh;
        for (const SplitMesh::Half& half : halves) {
            for (const std::uint32_t t : {half.first, half.second}) {
                if (watched_[t].is_watched) fresh.push_back(t);
            }
        }
        std::ranges::sort(fresh);
        fresh.erase(std::unique(fresh.begin(), fresh.end()), fresh.end());
        return fresh;
    }

    // Hands the points of halved triangles to their parts.
    void inherit(std::span<const SplitMesh::Half> halves) {
        watched_.resize(mesh_.size());
        for (const SplitMesh::Half& half : halves) {
            const SplitMesh::Triangle& first = mesh_[half.first];
            const SplitMesh::Triangle& second = mesh_[half.second];
            std::vector<std::uint32_t>& rows = vertex_row_[first.primitive];
            rows.resize(mesh_.scene().primitives[first.primitive].position.size(), formats::kNone);
            const std::uint32_t a = first.corner[0], b = second.corner[1];
            const auto middle = middle_row_.find({first.primitive, std::min(a, b), std::max(a, b)});
            if (middle != middle_row_.end()) rows[first.corner[1]] = middle->second;
            const Watched whole = std::exchange(watched_[half.first], {});
            watched_[half.first].is_watched = watched_[half.second].is_watched = whole.is_watched;
            for (Look look : whole.looks) {
                if (look.is_middle) continue;  // a corner now
                const auto at = [&](std::uint32_t k) {
                    return look.weight[static_cast<glm::length_t>((half.side + k) % 3)];
                };
                const glm::vec3 weight(at(0), at(1), at(2));
                if (weight.x >= weight.y) {
                    look.weight = {weight.x - weight.y, 2 * weight.y, weight.z};
                    watched_[half.first].looks.push_back(look);
                } else {
                    look.weight = {2 * weight.x, weight.y - weight.x, weight.z};
                    watched_[half.second].looks.push_back(look);
                }
            }
        }
    }

    const RefineLimits& limits_;
    const Context& context_;
    SplitMesh mesh_;
    ProxyTracer tracer_;
    ProxyRows rows_;
    std::vector<double> solid_angle_;  ///< of the cells of a face
    std::vector<Watched> watched_;     ///< of each triangle
    std::vector<std::vector<std::uint32_t>> vertex_row_;
    std::unordered_map<VertexEdge, std::uint32_t, EdgeHash> middle_row_;
    std::size_t first_ = 0;  ///< points at first
    double area_ = 0, shortest_ = 0;
    Columns total_{};   ///< square of all light, over the surface [m^2]
    Columns unseen_{};  ///< of the error where nothing looks
    RefineReport report_;
};

}  // namespace

RefinedScene refine_scene(const formats::Scene& scene, const RayScene& rays,
                        std::span<const LampSources> lamps, const RefineLimits& limits,
                        const Context& context) {
    return Refiner(scene, rays, lamps, limits, context).run();
}

}  // namespace opaline::bake
