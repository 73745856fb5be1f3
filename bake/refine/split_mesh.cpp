#include "bake/refine/split_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "bake/scene/triangle.h"
#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kNoSide = 0xffffffffu;

// Of three vertices by their weights; empty attributes stay empty.
template <class T>
void append_mixed(std::vector<T>& values, const formats::AddedVertex& at) {
    if (values.empty()) return;
    const std::array<float, 3> w = at.weights();
    T sum = w[0] * values[at.corner[0]];
    sum = sum + w[1] * values[at.corner[1]];
    sum = sum + w[2] * values[at.corner[2]];
    values.push_back(sum);
}

// To 16 bits.
double rounded(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    return std::ldexp(std::round(std::ldexp(mantissa, 16)), exponent - 16);
}

glm::vec3 unit_or_zero(glm::vec3 v) {
    constexpr float kShortest = 1e-6f;
    const float length = glm::length(v);
    return length > kShortest ? v / length : glm::vec3(0);
}

void append_normal(formats::Primitive& p, const formats::AddedVertex& at) {
    append_mixed(p.normal, at);
    p.normal.back() = unit_or_zero(p.normal.back());
}

// Perpendicular to the normal again; handed as the first corner is.
void append_tangent(formats::Primitive& p, const formats::AddedVertex& at) {
    if (p.tangent.empty()) return;
    const float hand = p.tangent[at.corner[0]].w;
    append_mixed(p.tangent, at);
    const glm::vec3 normal = p.normal.back();
    const glm::vec3 sum(p.tangent.back());
    p.tangent.back() = glm::vec4(unit_or_zero(sum - glm::dot(sum, normal) * normal), hand);
}

}  // namespace

SplitMesh::SplitMesh(const formats::Scene& scene, CutRule rule)
    : scene_(scene), rule_(std::move(rule)), place_(scene.primitives.size()) {
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> known;
    for (std::uint32_t number = 0; number < scene_.primitives.size(); ++number) {
        const formats::Primitive& p = scene_.primitives[number];
        for (const glm::vec3& position : p.position) {
            const auto [at, is_new] =
                known.try_emplace(weld_key(position), static_cast<std::uint32_t>(position_.size()));
            if (is_new) position_.push_back(at->first);
            place_[number].push_back(at->second);
        }
        for (std::uint32_t i = 0; i + 2 < p.index.size(); i += 3) {
            if (triangle_normal(p, i / 3) == glm::vec3(0)) continue;
            triangles_.push_back({number,
                                  i,
                                  {p.index[i], p.index[i + 1], p.index[i + 2]},
                                  {glm::vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}}});
        }
    }
    given_ = size();
}

void SplitMesh::link_all() {
    if (!next_.empty()) return;
    next_.assign(3 * triangles_.size(), kNoSide);
    first_.reserve(2 * triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        link(t);
    }
}

formats::Scene SplitMesh::take() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const Triangle& triangle = triangles_[t];
        std::vector<std::uint32_t>& index = scene_.primitives[triangle.primitive].index;
        if (t < given_) {  // a first part stands where the whole stood
            std::ranges::copy(triangle.corner, index.begin() + triangle.first_index);
        } else {
            index.insert(index.end(), triangle.corner.begin(), triangle.corner.end());
        }
    }
    triangles_.clear();
    return std::move(scene_);
}

double SplitMesh::area(std::uint32_t triangle) const {
    const glm::dvec3 a = position_[place_of(triangle, 0)];
    const glm::dvec3 b = position_[place_of(triangle, 1)];
    const glm::dvec3 c = position_[place_of(triangle, 2)];
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

std::uint32_t SplitMesh::longest_side(std::uint32_t triangle) const {
    std::uint32_t best = 0;
    for (std::uint32_t side = 1; side < 3; ++side) {
        if (length_of(triangle, side) > length_of(triangle, best)) best = side;
    }
    return best;
}

double SplitMesh::longest_edge(std::uint32_t triangle) const {
    const std::uint32_t side = longest_side(triangle);
    return glm::distance(glm::dvec3(position_[place_of(triangle, side)]),
                         glm::dvec3(position_[place_of(triangle, (side + 1) % 3)]));
}

EdgeCut SplitMesh::cut_of(std::uint32_t triangle) {
    link_all();
    const std::uint32_t side = longest_side(triangle);
    const Edge edge = length_of(triangle, side).edge;
    const EdgeCut cut = find_cut(edge);
    return place_of(triangle, side) == edge >> 32 ? cut : cut.turned();
}

std::vector<std::uint32_t> SplitMesh::neighbours(std::uint32_t triangle) {
    link_all();
    std::vector<std::uint32_t> found;
    for (std::uint32_t own = 0; own < 3; ++own) {
        for (std::uint32_t side = first_.at(length_of(triangle, own).edge); side != kNoSide;
             side = next_[side]) {
            if (side / 3 != triangle) found.push_back(side / 3);
        }
    }
    return found;
}

void SplitMesh::halve(std::uint32_t triangle, std::vector<Half>& halves) {
    link_all();
    struct Wanted {
        std::uint32_t triangle;
        Edge edge;
    };
    const auto longest_of = [&](std::uint32_t t) { return length_of(t, longest_side(t)).edge; };
    std::vector<Wanted> wanted{{triangle, longest_of(triangle)}};
    while (!wanted.empty()) {
        // Longer edges come first where a neighbour has one: lengths rise along `wanted`.
        const Wanted now = wanted.back();
        const auto shared = first_.find(now.edge);
        if (longest_of(now.triangle) != now.edge || shared == first_.end()) {
            wanted.pop_back();  // halved meanwhile
            continue;
        }
        std::uint32_t side = shared->second;
        while (side != kNoSide && longest_of(side / 3) == now.edge) {
            side = next_[side];
        }
        if (side != kNoSide) {
            wanted.push_back({side / 3, longest_of(side / 3)});
        } else {
            halve_edge(now.edge, halves);
            wanted.pop_back();
        }
    }
}

std::uint32_t SplitMesh::place_of(std::uint32_t triangle, std::uint32_t side) const {
    const Triangle& t = triangles_[triangle];
    return place_[t.primitive][t.corner[side]];
}

SplitMesh::Length SplitMesh::length_of(std::uint32_t triangle, std::uint32_t side) const {
    const std::uint32_t a = place_of(triangle, side), b = place_of(triangle, (side + 1) % 3);
    const std::uint32_t low = std::min(a, b), high = std::max(a, b);
    const glm::dvec3 way = glm::dvec3(position_[high]) - glm::dvec3(position_[low]);
    return {rounded(glm::dot(way, way)), Edge{low} << 32 | high};
}

void SplitMesh::link(std::uint32_t triangle) {
    for (std::uint32_t side = 0; side < 3; ++side) {
        const std::uint32_t number = 3 * triangle + side;
        const auto [at, is_new] = first_.try_emplace(length_of(triangle, side).edge, kNoSide);
        next_[number] = std::exchange(at->second, number);
    }
}

void SplitMesh::unlink(std::uint32_t triangle, std::uint32_t side) {
    const auto at = first_.find(length_of(triangle, side).edge);
    std::uint32_t* link = &at->second;
    while (*link != 3 * triangle + side) {
        link = &next_[*link];
    }
    *link = next_[3 * triangle + side];
    if (at->second == kNoSide) first_.erase(at);
}

std::vector<std::uint32_t> SplitMesh::sides_of(Edge edge) const {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t s = first_.at(edge); s != kNoSide; s = next_[s]) {
        sides.push_back(s);
    }
    std::ranges::sort(sides);
    return sides;
}

// Kept: those that share an edge later are parts of those that did, turned by rounding.
EdgeCut SplitMesh::find_cut(Edge edge) {
    if (!rule_) return {};
    const auto [at, is_new] = cut_.try_emplace(edge);
    if (!is_new) return at->second;
    std::vector<glm::vec3> normals;
    for (const std::uint32_t side : sides_of(edge)) {
        const Triangle& t = triangles_[side / 3];
        normals.push_back(triangle_normal(scene_.primitives[t.primitive], t.first_index / 3));
    }
    at->second = rule_(position_[edge >> 32], position_[edge & 0xffffffffu], normals);
    return at->second;
}

void SplitMesh::halve_edge(Edge edge, std::vector<Half>& halves) {
    const std::vector<std::uint32_t> sides = sides_of(edge);
    const EdgeCut cut = find_cut(edge);
    const auto place = static_cast<std::uint32_t>(position_.size());
    position_.emplace_back(glm::mix(glm::dvec3(position_[edge >> 32]),
                                    glm::dvec3(position_[edge & 0xffffffffu]), cut.share));
    struct Middle {
        std::uint32_t primitive, low, high, vertex;
    };
    std::vector<Middle> middles;  // triangles that share two vertices share the one between them
    for (const std::uint32_t number : sides) {
        const std::uint32_t t = number / 3, side = number % 3;
        const Triangle whole = triangles_[t];
        const std::uint32_t a = whole.corner[side], b = whole.corner[(side + 1) % 3];
        const EdgeCut own = place_of(t, side) == edge >> 32 ? cut : cut.turned();
        const glm::vec3 weight = glm::mix(whole.weight[side], whole.weight[(side + 1) % 3],
                                          static_cast<float>(own.share));
        const Middle wanted{whole.primitive, std::min(a, b), std::max(a, b), 0};
        auto middle = std::ranges::find_if(middles, [&](const Middle& m) {
            return m.primitive == wanted.primitive && m.low == wanted.low && m.high == wanted.high;
        });
        if (middle == middles.end()) {
            middles.push_back(wanted);
            middle = middles.end() - 1;
            middle->vertex = add_vertex(whole, weight, place);
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            unlink(t, k);
        }
        const std::uint32_t c = (side + 2) % 3, next = (side + 1) % 3;
        Triangle first = whole, second = whole;
        first.corner = {a, middle->vertex, whole.corner[c]};
        first.weight = {whole.weight[side], weight, whole.weight[c]};
        second.corner = {middle->vertex, b, whole.corner[c]};
        second.weight = {weight, whole.weight[next], whole.weight[c]};
        first.depth = second.depth = whole.depth + 1;
        const std::uint32_t last = size();
        triangles_[t] = first;
        triangles_.push_back(second);
        next_.insert(next_.end(), 3, kNoSide);
        link(t);
        link(last);
        halves.push_back({t, last, side, a, b, middle->vertex, own});
    }
}

std::uint32_t SplitMesh::add_vertex(const Triangle& triangle, glm::vec3 weight,
                                    std::uint32_t place) {
    formats::Primitive& p = scene_.primitives[triangle.primitive];
    formats::AddedVertex at{{p.index[triangle.first_index], p.index[triangle.first_index + 1],
                             p.index[triangle.first_index + 2]},
                            {weight.y, weight.z}};
    while (at.weights()[0] < 0) {  // by rounding
        float& larger = *std::ranges::max_element(at.weight);
        larger = std::nextafter(larger, 0.0f);
    }
    p.position.push_back(position_[place]);
    append_normal(p, at);
    append_mixed(p.texcoord, at);
    append_tangent(p, at);
    append_mixed(p.color, at);
    append_mixed(p.alpha, at);
    p.added.push_back(at);
    place_[triangle.primitive].push_back(place);
    ++added_;
    return static_cast<std::uint32_t>(p.position.size() - 1);
}

}  // namespace opaline::bake
