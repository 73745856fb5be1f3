#include "bake/scene/cancel_flaps.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/scene/body_shells.h"
#include "bake/scene/parts_apart.h"
#include "formats/disjoint_sets.h"

namespace opaline::bake {
namespace {

// A triangle by its corners, whichever way it faces.
struct Facet {
    std::array<std::uint32_t, 3> corner;  // ascending
    bool is_even;                         // they are in that order up to rotation
    std::uint32_t triangle;
};

Facet make_facet(const BodyTriangle& t, std::uint32_t triangle) {
    Facet facet{t.point, true, triangle};
    auto& [a, b, c] = facet.corner;
    for (auto [first, second] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&a, &b)}) {
        if (*first > *second) {
            std::swap(*first, *second);
            facet.is_even = !facet.is_even;
        }
    }
    return facet;
}

double area_of(const BodyShells& body, std::uint32_t triangle) {
    return glm::length(area_vector(body, body.triangle[triangle]));
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::array<Edge, 3> edges_of(const BodyTriangle& t) {
    const auto& [a, b, c] = t.point;
    return {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)};
}

// Of triangles that another one repeats, those without which the surface has no more edges at which
// it ends than with them. Where two bodies of one medium overlap with a face in common, each needs
// its own: the patch's border is closed by what goes.
std::vector<std::uint32_t> find_needless(const BodyShells& body,
                                         const std::vector<std::uint32_t>& repeats) {
    std::vector<Edge> all;  // sorted, as often as there are triangles at each
    for (const BodyTriangle& t : body.triangle) {
        std::ranges::copy(edges_of(t), std::back_inserter(all));
    }
    std::ranges::sort(all);
    std::vector<std::pair<Edge, std::uint32_t>> own;  // with a number among `repeats`
    for (std::uint32_t i = 0; i < repeats.size(); ++i) {
        for (const Edge& edge : edges_of(body.triangle[repeats[i]])) {
            own.emplace_back(edge, i);
        }
    }
    std::ranges::sort(own);
    formats::DisjointSets patches(repeats.size());
    for (std::size_t i = 1; i < own.size(); ++i) {
        if (own[i].first == own[i - 1].first) patches.join(own[i].second, own[i - 1].second);
    }
    std::vector<std::int64_t> opened(repeats.size(), 0);  // by patch: edges, less those it closes
    for (std::size_t begin = 0, end = 0; begin < own.size(); begin = end) {
        while (end < own.size() && own[end].first == own[begin].first) {
            ++end;
        }
        if ((end - begin) % 2 == 0) continue;  // as many stay, or an even number less
        const auto [from, to] = std::equal_range(all.begin(), all.end(), own[begin].first);
        const bool ends_here = (to - from) % 2 != 0;
        opened[patches.find(own[begin].second)] += ends_here ? -1 : 1;
    }
    std::vector<std::uint32_t> needless;
    for (std::uint32_t i = 0; i < repeats.size(); ++i) {
        if (opened[patches.find(i)] <= 0) needless.push_back(repeats[i]);
    }
    return needless;
}

}  // namespace

Flaps find_flaps(const formats::Scene& scene, std::uint32_t material) {
    Flaps flaps;
    flaps.first_index.resize(scene.primitives.size());
    std::vector<std::vector<std::uint32_t>> repeated(scene.primitives.size());
    double area = 0, cancelled = 0;
    // Part by part, which fit into the cache; what is apart has no corners in common.
    for (const std::vector<std::uint32_t>& part : list_parts_apart(scene, material)) {
        const BodyShells body = weld_triangles(scene, part);
        std::vector<Facet> facets;
        facets.reserve(body.triangle.size());
        for (std::uint32_t t = 0; t < body.triangle.size(); ++t) {
            facets.push_back(make_facet(body.triangle[t], t));
            area += area_of(body, t);
        }
        // Of one set of corners: first those that face one way, then the others.
        std::ranges::sort(facets, [](const Facet& a, const Facet& b) {
            return std::tie(a.corner, a.is_even, a.triangle) <
                   std::tie(b.corner, b.is_even, b.triangle);
        });
        const auto take = [&](std::uint32_t triangle, std::vector<std::vector<std::uint32_t>>& to) {
            const BodyTriangle& t = body.triangle[triangle];
            to[t.primitive].push_back(t.first_index);
        };
        std::vector<std::uint32_t> repeats;
        for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
            std::size_t odd = 0;
            while (end < facets.size() && facets[end].corner == facets[begin].corner) {
                odd += facets[end++].is_even ? 0u : 1u;
            }
            const std::size_t pairs = std::min(odd, end - begin - odd);
            for (std::size_t i = 0; i < pairs; ++i) {
                take(facets[begin + i].triangle, flaps.first_index);
                take(facets[begin + odd + i].triangle, flaps.first_index);
                cancelled += 2 * area_of(body, facets[begin].triangle);
            }
            flaps.pairs += pairs;
            // Of the others, which face one way, the first one stays.
            const std::size_t others = odd > pairs ? begin + pairs : begin + odd + pairs,
                              others_end = odd > pairs ? begin + odd : end;
            for (std::size_t i = others + 1; i < others_end; ++i) {
                repeats.push_back(facets[i].triangle);
            }
        }
        if (repeats.empty()) continue;
        for (const std::uint32_t triangle : find_needless(body, repeats)) {
            take(triangle, repeated);
            ++flaps.repeats;
        }
    }
    if (cancelled > 0.5 * area) {
        flaps.first_index.assign(scene.primitives.size(), {});
        flaps.pairs = 0;
    }
    for (std::size_t p = 0; p < repeated.size(); ++p) {
        std::vector<std::uint32_t>& first = flaps.first_index[p];
        first.insert(first.end(), repeated[p].begin(), repeated[p].end());
        std::ranges::sort(first);
    }
    return flaps;
}

void remove_flaps(const Flaps& flaps, formats::Scene& scene) {
    for (std::size_t p = 0; p < flaps.first_index.size(); ++p) {
        std::vector<std::uint32_t>& index = scene.primitives[p].index;
        auto next = flaps.first_index[p].begin();
        std::size_t kept = 0;
        for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
            if (next != flaps.first_index[p].end() && *next == i) {
                ++next;
                continue;
            }
            std::copy_n(&index[i], 3, &index[kept]);
            kept += 3;
        }
        index.resize(kept);
    }
}

}  // namespace opaline::bake
