#include "bake/refine/watched_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "bake/base/rng.h"
#include "bake/receivers/surface_points.h"
#include "bake/scene/coverage.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// Rows where a surface crosses an edge are traced in front of it, so many times farther along the
// edge than inside the triangle.
constexpr double kAside = 2;

void add_scaled(ErrorColumns& sum, double scale, const ErrorColumns& more) {
    for (std::size_t c = 0; c < sum.size(); ++c) {
        sum[c] += scale * more[c];
    }
}

}  // namespace

std::size_t WatchedMesh::EdgeHash::operator()(const VertexEdge& edge) const {
    std::uint64_t h = edge.primitive * 0x9e3779b97f4a7c15u;
    h = (h ^ (std::uint64_t{edge.low} << 32 | edge.high)) * 0xff51afd7ed558ccdu;
    return h ^ h >> 32;
}

WatchedMesh::WatchedMesh(const formats::Scene& scene, const RayScene& rays,
                         std::span<const LampSources> lamps, std::uint32_t cubemap_size,
                         double shortest, const Context& context)
    : context_(context),
      shortest_(shortest),
      mesh_(scene,
            [this, &rays](glm::vec3 from, glm::vec3 to, std::span<const glm::vec3> normals) {
                return find_edge_cut(mesh_.scene(), rays, from, to, normals, shortest_);
            }),
      tracer_(mesh_.scene(), rays, cubemap_size, lamps),
      rows_(tracer_.no_rows()),
      solid_angle_(formats::texel_solid_angles(cubemap_size)) {
    for (const formats::Primitive& p : scene.primitives) {
        vertex_row_.emplace_back(p.position.size(), formats::kNone);
    }
}

void WatchedMesh::look_first(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> all(mesh_.scene().primitives.size());
    std::iota(all.begin(), all.end(), 0u);
    const AreaTable table = make_area_table(mesh_.scene(), all);
    watched_.assign(mesh_.size(), {});
    std::vector<std::uint32_t> fresh;
    std::uint32_t t = 0;
    for (const SurfacePoint& at :
         scatter_points(mesh_.scene(), table, count, false, seed, RandomStage::refine_probes)) {
        while (mesh_[t].primitive != at.primitive || mesh_[t].first_index != at.first_index) {
            ++t;  // both in the scene's order
        }
        const auto row = static_cast<std::uint32_t>(rows_.size() + awaited_.size());
        watched_[t].looks.push_back({at.barycentric, row, false});
        if (!std::exchange(watched_[t].is_watched, true)) fresh.push_back(t);
        awaited_.push_back({at.primitive, at.first_index, at.barycentric});
    }
    look_at(fresh);
    total_ = unseen_ = {};
    area_ = table.total();
    if (context_.cancelled()) return;
    measure(fresh);
    const double share = area_ / static_cast<double>(count);
    for (const std::uint32_t triangle : fresh) {
        // A small triangle's point stands for others beside it, which nothing looks at.
        const Watched& own = watched_[triangle];
        const double area = share * static_cast<double>(own.looks.size());
        add_scaled(unseen_, std::max(0.0, area - mesh_.area(triangle)), own.error);
        for (const Look& look : own.looks) {
            add_scaled(total_, share,
                       is_ground(triangle) ? square_where_shaded(rows_, solid_angle_, look.row)
                                           : square_beyond(rows_, solid_angle_, look.row, {}));
        }
    }
}

void WatchedMesh::halve(std::uint32_t triangle) {
    for (const std::uint32_t neighbour : mesh_.neighbours(triangle)) {
        if (watched_[neighbour].is_watched) continue;
        watched_[neighbour].is_watched = true;
        parts_.push_back(neighbour);
        joined_.push_back(neighbour);
    }
    std::vector<SplitMesh::Half> halves;
    mesh_.halve(triangle, halves);
    watched_.resize(mesh_.size());
    for (const SplitMesh::Half& half : halves) {
        inherit(half);
    }
}

void WatchedMesh::look_at_parts() {
    std::ranges::sort(parts_);
    parts_.erase(std::unique(parts_.begin(), parts_.end()), parts_.end());
    look_at(parts_);
    if (!context_.cancelled()) measure(parts_);
    for (const std::uint32_t t : joined_) {
        for (std::size_t c = 0; c < unseen_.size(); ++c) {
            unseen_[c] = std::max(0.0, unseen_[c] - mesh_.area(t) * watched_[t].error[c]);
        }
    }
    parts_.clear();
    joined_.clear();
}

void WatchedMesh::trace() {
    traced_ += tracer_.append(awaited_, context_, rows_);
    awaited_.clear();
}

// How far inside a triangle rays start, as a share of its longest edge: on an edge in a wall.
float WatchedMesh::inset(std::uint32_t triangle) const {
    return static_cast<float>(std::min(0.5, 0.05 * shortest_ / mesh_.longest_edge(triangle)));
}

// The number of the row that a place of a triangle will have, traced a little inside it.
std::uint32_t WatchedMesh::await_row(std::uint32_t triangle, glm::vec3 weight) {
    const SplitMesh::Triangle& t = mesh_[triangle];
    weight = glm::mix(weight, glm::vec3(1.0f / 3.0f), inset(triangle));
    awaited_.push_back({t.primitive, t.first_index,
                        weight.x * t.weight[0] + weight.y * t.weight[1] + weight.z * t.weight[2]});
    return static_cast<std::uint32_t>(rows_.size() + awaited_.size() - 1);
}

// Traces the rows that triangles need: of their corners, and where they would be cut.
void WatchedMesh::look_at(std::span<const std::uint32_t> triangles) {
    for (const std::uint32_t t : triangles) {
        const SplitMesh::Triangle& triangle = mesh_[t];
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& row = vertex_row_[triangle.primitive][triangle.corner[k]];
            if (row != formats::kNone) continue;
            glm::vec3 weight(0);
            weight[static_cast<glm::length_t>(k)] = 1;
            row = await_row(t, weight);
        }
        Watched& own = watched_[t];
        if (own.looks.size() >= (triangle.depth == 0 ? 1 : 2)) continue;
        const std::uint32_t side = mesh_.longest_side(t);
        const EdgeCut cut = mesh_.cut_of(t);
        const auto weight_at = [&](double share) {
            glm::vec3 weight(0);
            weight[static_cast<glm::length_t>(side)] = static_cast<float>(1 - share);
            weight[static_cast<glm::length_t>((side + 1) % 3)] = static_cast<float>(share);
            return weight;
        };
        const std::uint32_t a = triangle.corner[side], b = triangle.corner[(side + 1) % 3];
        const VertexEdge edge{triangle.primitive, std::min(a, b), std::max(a, b)};
        const auto [at, is_new] = cut_row_.try_emplace(edge, 0);
        if (is_new) {
            const double aside = kAside * static_cast<double>(cut.front * inset(t));
            at->second = await_row(t, weight_at(cut.share + aside));
        }
        own.looks.push_back({weight_at(cut.share), at->second, true});
    }
    trace();
}

// Flat and opaque: its light changes by what shades it alone.
bool WatchedMesh::is_ground(std::uint32_t triangle) const {
    const formats::Primitive& p = mesh_.scene().primitives[mesh_[triangle].primitive];
    const formats::Material& material = mesh_.scene().materials[p.material];
    if (material.medium || (material.sheet && !is_wall(material))) return false;
    constexpr float kFlat = 1e-3f;
    const std::array<std::uint32_t, 3>& corner = mesh_[triangle].corner;
    return p.normal.empty() || (glm::distance(p.normal[corner[0]], p.normal[corner[1]]) < kFlat &&
                                glm::distance(p.normal[corner[0]], p.normal[corner[2]]) < kFlat);
}

// What light spreads over inside a medium changes less over a shorter way.
double WatchedMesh::contrast(std::uint32_t triangle) const {
    const formats::Scene& scene = mesh_.scene();
    const std::uint32_t material = scene.primitives[mesh_[triangle].primitive].material;
    if (!scene.materials[material].medium) return 1;
    const double ratio =
        static_cast<double>(tracer_.reach(material).spread()) / mesh_.longest_edge(triangle);
    return 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
}

// Hidden corners get a row beside the visible ones.
ErrorColumns WatchedMesh::square_at(std::uint32_t triangle, const Look& look) const {
    const SplitMesh::Triangle& own = mesh_[triangle];
    std::array<MixedRow, 3> corners{};
    std::size_t count = 0;
    float sum = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t row = vertex_row_[own.primitive][own.corner[k]];
        const float weight = look.weight[static_cast<glm::length_t>(k)];
        if (rows_.hidden[row] != 0 || !(weight > 0)) continue;
        corners[count++] = {row, weight};
        sum += weight;
    }
    for (std::size_t k = 0; k < count; ++k) {
        corners[k].weight /= sum;
    }
    return square_beyond(rows_, solid_angle_, look.row, std::span(corners).first(count));
}

void WatchedMesh::measure(std::span<const std::uint32_t> triangles) {
    for (const std::uint32_t t : triangles) {
        Watched& own = watched_[t];
        own.error = {};
        const auto seen = std::ranges::count_if(
            own.looks, [&](const Look& look) { return rows_.hidden[look.row] == 0; });
        if (seen == 0) continue;
        const double scale = contrast(t) / static_cast<double>(seen);
        for (const Look& look : own.looks) {
            if (rows_.hidden[look.row] == 0) add_scaled(own.error, scale, square_at(t, look));
        }
    }
}

void WatchedMesh::inherit(const SplitMesh::Half& half) {
    const std::uint32_t primitive = mesh_[half.first].primitive;
    std::vector<std::uint32_t>& rows = vertex_row_[primitive];
    rows.resize(mesh_.scene().primitives[primitive].position.size(), formats::kNone);
    const auto known =
        cut_row_.find({primitive, std::min(half.a, half.b), std::max(half.a, half.b)});
    if (known != cut_row_.end()) rows[half.middle] = known->second;
    const Watched whole = std::exchange(watched_[half.first], {});
    if (!whole.is_watched) return;
    if (half.cut.front != 0 && rows[half.middle] == formats::kNone) {
        const bool is_second = half.cut.front > 0;
        const std::uint32_t part = is_second ? half.second : half.first;
        const float aside = static_cast<float>(kAside) * inset(part);
        rows[half.middle] = await_row(
            part, is_second ? glm::vec3(1 - aside, aside, 0) : glm::vec3(aside, 1 - aside, 0));
    }
    for (const std::uint32_t part : {half.first, half.second}) {
        watched_[part].is_watched = true;
        parts_.push_back(part);
    }
    const auto share = static_cast<float>(half.cut.share);
    for (Look look : whole.looks) {
        if (look.is_cut) continue;  // a corner now
        const auto at = [&](std::uint32_t k) {
            return look.weight[static_cast<glm::length_t>((half.side + k) % 3)];
        };
        const glm::vec3 weight(at(0), at(1), at(2));
        const float first = weight.x / (1 - share), second = weight.y / share;
        if (first >= second) {
            look.weight = {weight.x - (1 - share) * second, second, weight.z};
            watched_[half.first].looks.push_back(look);
        } else {
            look.weight = {first, weight.y - share * first, weight.z};
            watched_[half.second].looks.push_back(look);
        }
    }
}

}  // namespace opaline::bake
