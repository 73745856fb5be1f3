#include "bake/exchange/bounce_gather.h"

#include <array>
#include <utility>

#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/inside_media.h"
#include "bake/exchange/mirrored_cells.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// The mean over nodes near a footprint whose linear part is that of its centre, wherever the nodes
// lie: local linear regression.
class KernelAverage {
  public:
    // Appends weights that add up to `share`. False: there is no node.
    bool add(const BounceTree& tree, const FootprintKernel& kernel, const SurfaceSide& side,
             Brightness looked_for, float share, std::vector<NodeWeight>& weights) {
        offsets_.clear();
        const std::size_t first = weights.size();
        float sum = 0;
        glm::vec2 mean(0);
        tree.find_near(kernel, side, looked_for,
                       [&](std::uint32_t node, float weight, glm::vec2 offset) {
                           weights.push_back({node, weight});
                           offsets_.push_back(offset);
                           sum += weight;
                           mean += weight * offset;
                       });
        if (!(sum > 0)) {
            weights.resize(first);
            return false;
        }
        mean /= sum;
        const std::span<NodeWeight> own = std::span(weights).subspan(first);
        const glm::vec2 slope = slope_of(own, mean, sum);
        for (std::size_t i = 0; i < own.size(); ++i) {
            own[i].weight *= share / sum * (1 + glm::dot(slope, offsets_[i] - mean));
        }
        return true;
    }

  private:
    // What weights are tilted by, so that their mean offset is 0; less where one would turn
    // negative.
    glm::vec2 slope_of(std::span<const NodeWeight> own, glm::vec2 mean, float sum) const {
        // Of the variance of the kernel, 1/12: nodes on a line have none across it.
        constexpr float kLeastVariance = 0.004f;
        float xx = kLeastVariance, xy = 0, yy = kLeastVariance;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const glm::vec2 d = offsets_[i] - mean;
            const float w = own[i].weight / sum;
            xx += w * d.x * d.x;
            xy += w * d.x * d.y;
            yy += w * d.y * d.y;
        }
        const float scale = -1 / (xx * yy - xy * xy);
        const glm::vec2 slope =
            scale * glm::vec2(yy * mean.x - xy * mean.y, xx * mean.y - xy * mean.x);
        float steepest = 1;
        for (const glm::vec2& offset : offsets_) {
            steepest = std::max(steepest, -glm::dot(slope, offset - mean));
        }
        return slope / steepest;
    }

    std::vector<glm::vec2> offsets_;  // of the nodes of a ray, in widths of its footprint
};

}  // namespace

FootprintKernel footprint_of(glm::vec3 origin, const BounceEnd& end, const BounceCell& cell,
                             const Frame& frame) {
    // Cosines and areas that are not divided by.
    constexpr float kGrazing = 1e-4f, kNoArea = 1e-30f;
    const SeenSide& side = end.side;
    glm::vec3 toward = frame.to_world(cell.middle);
    float cosine = -glm::dot(toward, side.normal);
    float t = end.distance * side.cosine / std::max(cosine, kGrazing);
    // Beyond twice the distance the plane no longer approximates the surface.
    if (!(cosine > kGrazing && t < 2 * end.distance)) {
        toward = end.direction;
        cosine = std::max(side.cosine, kGrazing);
        t = end.distance;
    }
    const auto moved = [&](glm::vec3 change) {
        const glm::vec3 d = frame.to_world(change);
        return t * (d + toward * (glm::dot(d, side.normal) / cosine));
    };
    const glm::vec3 across = moved(cell.across), along = moved(cell.along);
    const float area = glm::dot(side.normal, glm::cross(across, along));
    FootprintKernel kernel;
    kernel.centre = origin + t * toward - end.triangle.offset;
    kernel.area = std::max(std::abs(area), kNoArea);
    const float inverse = std::copysign(1 / kernel.area, area);
    kernel.across = inverse * glm::cross(along, side.normal);
    kernel.along = inverse * glm::cross(side.normal, across);
    const glm::vec3 up = std::sqrt(kernel.area) * side.normal;
    kernel.extent = glm::sqrt(across * across + along * along + up * up);
    kernel.above = side.normal / std::sqrt(kernel.area);
    const float aa = glm::dot(kernel.across, kernel.across);
    const float bb = glm::dot(kernel.along, kernel.along);
    const float ab = glm::dot(kernel.across, kernel.along);
    kernel.steepest = std::sqrt(0.5f * (aa + bb + std::sqrt((aa - bb) * (aa - bb) + 4 * ab * ab)));
    return kernel;
}

void append_weight(std::uint32_t node, const formats::Rgb& share,
                   std::vector<NodeWeight>& weights) {
    if (share.r == share.g && share.r == share.b) {
        weights.push_back({node, share.r});
        return;
    }
    const std::array<float, 3> by_band{share.r, share.g, share.b};
    for (std::uint32_t band = 0; band < by_band.size(); ++band) {
        weights.push_back({node, by_band[band], band});
    }
}

BounceGather weigh_bounces(const BounceSpace& space, const BounceTree& tree, const Receiver& at,
                           const BounceGrid& grid, std::uint64_t seed,
                           std::vector<NodeWeight>& weights, LookUp look_up) {
    weights.clear();
    constexpr float kNoDistance = 1e-15f;
    const Frame frame = make_frame(at.normal);
    KernelAverage average;
    std::vector<BounceEnd> ends;
    BounceGather gathered;
    gathered.rays = find_bounce_ends(space.scene, space.rays, at, grid, seed, ends);
    const auto share_of = [&](const BounceEnd& end) {
        return 1 / static_cast<float>(end.is_quarter ? 4 * grid.count() : grid.count());
    };
    const MediumAround around = medium_around(space, at);
    const bool is_changed = around.material != formats::kNone &&
                            changes_light(*space.scene.materials[around.material].medium);
    // What one scatterer errs by is averaged over again. Walks of light are dear.
    constexpr std::uint32_t kMirroredRays = 1024, kOfScatterers = 256;
    MirroredCells mirrored(space, at, frame, grid, seed,
                           look_up == LookUp::nearest || is_changed ? kOfScatterers : kMirroredRays,
                           look_up != LookUp::nearest);
    std::vector<std::uint32_t> mirroring(ends.size(), formats::kNone);  // of each end, its number
    const auto goes_on = [&](const BounceEnd& end) {
        return is_changed || is_inside(space, end.material, end.side);
    };
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (!ends[i].is_met) continue;
        if (goes_on(ends[i])) {
            if (!around.is_deep) mirrored.add_inside(ends[i], share_of(ends[i]), around.material);
        } else if (ends[i].side.is_seen) {
            mirroring[i] = mirrored.add(ends[i], share_of(ends[i]));
        }
    }
    gathered.rays += mirrored.follow(tree, weights);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const BounceEnd& end = ends[i];
        if (!end.is_met) continue;
        float share = share_of(end);
        const float near = 1 / std::max(end.distance, kNoDistance);
        gathered.nearness += share * near * near;
        gathered.met += share;
        if (!end.side.is_seen || goes_on(end)) continue;
        const BounceCell& cell = (end.is_quarter ? grid.quarters : grid.cells)[end.cell];
        const SurfaceSide wanted{end.material, end.side.behind, end.side.normal};
        const FootprintKernel kernel = footprint_of(at.origin, end, cell, frame);
        const float part = mirroring[i] == formats::kNone ? 0 : mirrored.mirrored(mirroring[i]);
        const bool is_by_lobe = mirroring[i] != formats::kNone && mirrored.is_lobe(mirroring[i]);
        const float kept = part / share;
        if (!is_by_lobe) share *= share_of_radiosity(space.scene.materials[end.material], kept);
        const std::size_t first = weights.size();
        const glm::vec3 y = at.origin + end.distance * end.direction - end.triangle.offset;
        const std::uint32_t node = tree.find(y, wanted, look_up == LookUp::node ? kernel.area : 0);
        if (node != formats::kNone &&
            !(look_up == LookUp::kernel &&
              average.add(tree, kernel, wanted, tree.brightness(node), share, weights))) {
            weights.push_back({node, share});
        }
        for (NodeWeight& own : std::span(weights).subspan(first)) {
            if (is_by_lobe || tree.mirrored(own.node) > 0) {
                own.weight *= share_beside_lobe(tree, own.node, is_by_lobe ? kept : 0);
            }
        }
    }
    std::ranges::sort(weights, {}, [](const NodeWeight& w) { return std::pair(w.node, w.band); });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (kept > 0 && weights[kept - 1].node == weights[i].node &&
            weights[kept - 1].band == weights[i].band) {
            weights[kept - 1].weight += weights[i].weight;
        } else {
            weights[kept++] = weights[i];
        }
    }
    weights.resize(kept);
    return gathered;
}

void add_node_rows(const BounceTree& tree, std::span<const NodeWeight> weights,
                   std::span<float> rows) {
    constexpr std::size_t kTexels = std::size_t{6} * kBounceCubemap * kBounceCubemap;
    // Lobes see much of the sky: its texels become one row.
    const std::size_t bands = tree.has_lobes() ? rows.size() / kTexels : 0;
    std::vector<float> sky;
    for (const NodeWeight& w : weights) {
        const bool is_everywhere = w.band == NodeWeight::kAllBands;
        if (bands > 0 && tree.is_sky(w.node)) {
            sky.resize(rows.size());
            for (std::size_t band = 0; band < bands; ++band) {
                if (is_everywhere || w.band == band) {
                    tree.add_sky(w.node, w.weight, std::span(sky).subspan(band * kTexels, kTexels));
                }
            }
        } else if (is_everywhere) {
            tree.rows().add(w.node, w.weight, rows);
        } else {
            const std::size_t plane = rows.size() / 3;
            tree.rows().add_part(w.node, w.band * plane, w.weight,
                                 rows.subspan(w.band * plane, plane));
        }
    }
    for (std::size_t begin = 0; begin < sky.size(); begin += kTexels) {
        const std::span<float> plane = std::span(sky).subspan(begin, kTexels);
        formats::haar_forward_cube(plane, kBounceCubemap);
        for (std::size_t k = 0; k < kTexels; ++k) {
            rows[begin + k] += plane[k];
        }
    }
}

void add_to_finer(std::span<const float> from, std::uint32_t m, std::span<float> to,
                  std::uint32_t n, std::uint32_t bands) {
    // The orthonormal average of a face is n times its mean.
    const float scale = static_cast<float>(n) / static_cast<float>(m);
    const std::size_t faces = 6 * std::size_t{bands};
    for (std::size_t face = 0; face < faces; ++face) {
        for (std::size_t row = 0; row < m; ++row) {
            const float* const a = &from[(face * m + row) * m];
            float* const b = &to[(face * n + row) * n];
            for (std::size_t column = 0; column < m; ++column) {
                b[column] += scale * a[column];
            }
        }
    }
}

}  // namespace opaline::bake
