#include "bake/scene/coverage.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "bake/scene/sample_image.h"
#include "formats/disjoint_sets.h"
#include "formats/opal/thin_glass.h"

namespace opaline::bake {
namespace {

using formats::Material;

/// Finaliser of MurmurHash3: every bit of the input changes half of the output's.
std::uint32_t mixed(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    return h ^ h >> 16;
}

std::uint32_t hash_of(const Passage& p) {
    std::uint32_t h = 0x9e3779b9u;
    const auto add = [&](std::uint32_t word) { h = mixed(h ^ word) + 0x9e3779b9u; };
    for (int axis = 0; axis < 3; ++axis) {
        add(std::bit_cast<std::uint32_t>(p.origin[axis]));
        add(std::bit_cast<std::uint32_t>(p.direction[axis]));
    }
    add(p.key);
    add(p.primitive);
    add(p.triangle);
    return mixed(h);
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Those where an odd number of triangles meet.
std::vector<Edge> find_open_edges(const BodyShells& body) {
    std::vector<Edge> edges, open;
    for (const BodyTriangle& t : body.triangle) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.push_back(std::minmax({t.point[k], t.point[(k + 1) % 3]}));
        }
    }
    std::ranges::sort(edges);
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end] == edges[i]) {
            ++end;
        }
        if ((end - i) % 2 == 1) {
            open.push_back(edges[i]);
        }
    }
    return open;
}

}  // namespace

std::optional<Coverage> make_coverage(const formats::Scene& scene, std::uint32_t primitive,
                                      CoverageImages& images) {
    const formats::Primitive& p = scene.primitives[primitive];
    const Material& material = scene.materials[p.material];
    if (!has_holes(material)) return std::nullopt;
    Coverage coverage;
    coverage.mode = material.alpha_mode;
    if (is_clear(material)) {
        coverage.clear = material.sheet->clear;
        coverage.eta = material.sheet->eta;
    }
    if (coverage.mode == Material::AlphaMode::opaque) return coverage;
    coverage.alpha = material.alpha;
    coverage.cutoff = material.alpha_cutoff;
    coverage.index = p.index;
    coverage.vertex_alpha = p.alpha;
    if (material.base_color_image != formats::kNone && !p.texcoord.empty()) {
        const formats::Image8& image = scene.images[material.base_color_image];
        if (image.width > 0 && image.height > 0) {
            auto& shared = images[material.base_color_image];
            if (shared == nullptr) {
                shared = std::make_shared<const formats::Image8>(image);
            }
            coverage.image = shared;
            coverage.texcoord = p.texcoord;
            coverage.wrap_u = material.wrap_u;
            coverage.wrap_v = material.wrap_v;
        }
    }
    return coverage;
}

float coverage_at(const Coverage& coverage, std::uint32_t triangle, float u, float v) {
    const std::uint32_t* corner = &coverage.index[3 * std::size_t{triangle}];
    const float weight[3] = {1 - u - v, u, v};
    float alpha = coverage.alpha;
    if (!coverage.vertex_alpha.empty()) {
        alpha *= weight[0] * coverage.vertex_alpha[corner[0]] +
                 weight[1] * coverage.vertex_alpha[corner[1]] +
                 weight[2] * coverage.vertex_alpha[corner[2]];
    }
    if (coverage.image != nullptr) {
        const glm::vec2 uv = weight[0] * coverage.texcoord[corner[0]] +
                             weight[1] * coverage.texcoord[corner[1]] +
                             weight[2] * coverage.texcoord[corner[2]];
        alpha *= sample_alpha({*coverage.image, coverage.wrap_u, coverage.wrap_v, true}, uv);
    }
    if (coverage.mode == Material::AlphaMode::mask) return alpha < coverage.cutoff ? 0.0f : 1.0f;
    return alpha;
}

bool meets_surface(const Coverage& coverage, const Passage& passage, float u, float v) {
    float share = coverage.mode == Material::AlphaMode::opaque
                      ? 1.0f
                      : coverage_at(coverage, passage.triangle, u, v);
    if (coverage.clear > 0) {
        share *=
            1 - coverage.clear * formats::thin_glass_transmittance(passage.cosine, coverage.eta);
    }
    if (share <= 0 || share >= 1) return share > 0;
    return static_cast<float>(hash_of(passage) >> 8) < share * 0x1p24f;
}

double bound_hole_area(const BodyShells& body) {
    if (body.open_edges == 0) return 0;
    const std::vector<Edge> open = find_open_edges(body);
    formats::DisjointSets border(body.position.size());
    for (const Edge& edge : open) {
        border.join(edge.first, edge.second);
    }
    std::vector<double> length(body.position.size());  // [m] of the border with that name
    for (const Edge& edge : open) {
        length[border.find(edge.first)] += glm::distance(glm::dvec3(body.position[edge.first]),
                                                         glm::dvec3(body.position[edge.second]));
    }
    return std::inner_product(length.begin(), length.end(), length.begin(), 0.0) /
           (4 * std::numbers::pi);
}

}  // namespace opaline::bake
