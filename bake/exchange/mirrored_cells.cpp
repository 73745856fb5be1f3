#include "bake/exchange/mirrored_cells.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "bake/base/rng.h"
#include "bake/exchange/inside_media.h"

namespace opaline::bake {
namespace {

// First of the random numbers of parts: those of cells and of quarters come before.
constexpr std::uint32_t kOfParts = 3u << 30;

std::uint32_t count_parts(std::uint32_t cells, std::uint32_t most) {
    return cells * 16 <= most ? 4 : cells * 2 <= most ? 2 : 1;
}

}  // namespace

MirroredCells::MirroredCells(const BounceSpace& space, const Receiver& at, const Frame& frame,
                             const BounceGrid& grid, std::uint64_t seed, std::uint32_t most_rays,
                             bool cuts_lobes)
    : space_(space),
      at_(at),
      frame_(frame),
      grid_(grid),
      seed_(seed),
      key_(key_of(at)),
      cuts_lobes_(cuts_lobes),
      parts_(count_parts(grid.count(), most_rays)) {}

MirroredRay MirroredCells::go_on(const RayEnd& end, float share) const {
    const formats::Rgb all{share, share, share};
    return is_inside(space_, end) ? go_on_inside(space_, end, all, 0) : mirror(space_, end, all, 0);
}

std::uint32_t MirroredCells::add(const BounceEnd& end, float share) {
    const RayEnd met{.position = at_.origin + end.distance * end.direction,
                     .direction = end.direction,
                     .distance = end.distance,
                     .error = end.error,
                     .material = end.material,
                     .side = end.side,
                     .triangle = end.triangle};
    const MirroredRay own = go_on(met, share);
    if (!(own.largest() > 0)) return formats::kNone;
    const std::size_t first = open_.size();
    open_.push_back(own);
    if (parts_ > 1 && !end.is_quarter && (own.of_lobe == 0 || (cuts_lobes_ && !own.is_weak))) {
        add_parts(end, share);
    }
    const float each = 1 / static_cast<float>(open_.size() - first);
    const auto cell = static_cast<std::uint32_t>(mirrored_.size());
    mirrored_.push_back(0);
    is_lobe_.push_back(own.of_lobe > 0 ? 1 : 0);
    for (std::size_t i = first; i < open_.size(); ++i) {
        open_[i].share = each * open_[i].share;
        open_[i].number = static_cast<std::uint32_t>(i);
        of_hemisphere_.push_back(open_[i].of_lobe > 0 || open_[i].inside > 0 ? 0 : each * share);
        cell_.push_back(cell);
        mirrored_[cell] += open_[i].largest();
    }
    return cell;
}

// One ray in each part but that of the cell's own ray.
void MirroredCells::add_parts(const BounceEnd& end, float share) {
    const std::uint32_t count = parts_ * parts_;
    const auto per_side = static_cast<float>(parts_);
    const float width = 1 / (static_cast<float>(grid_.side) * per_side);
    const std::uint32_t column = end.cell % grid_.side, row = end.cell / grid_.side;
    const glm::vec2 place = place_in_cell(grid_, seed_, key_, row, column);
    const std::uint32_t taken = static_cast<std::uint32_t>(place.y * per_side) * parts_ +
                                static_cast<std::uint32_t>(place.x * per_side);
    RayPacket packet = rays_from(at_.origin);
    LaneMask lanes{};
    for (std::uint32_t part = 0; part < count; ++part) {
        if (part == taken) continue;
        const std::uint32_t part_row = part / parts_;
        const auto u = random_uniform(seed_, RandomStage::bounce_rays, key_,
                                      kOfParts + end.cell * count + part);
        const auto across = static_cast<float>(column * parts_ + part % parts_) + u[0];
        const auto along = static_cast<float>(row * parts_ + part_row) + u[1];
        set_lane(packet, lanes, part,
                 frame_.to_world(to_hemisphere(across * width, along * width)));
    }
    const PacketHits hits = space_.rays.closest(lanes, packet);
    traced_ += count - 1;
    for (std::uint32_t part = 0; part < count; ++part) {
        if (hits.hit[part] == 0) continue;
        const glm::vec3 d = direction_of(packet, part);
        const MirroredRay ray = go_on(end_of_ray(space_.scene, at_.origin, d, hits, part), share);
        if (ray.largest() > 0) {
            open_.push_back(ray);
        }
    }
}

std::uint64_t MirroredCells::follow(const BounceTree& tree, std::vector<NodeWeight>& weights) {
    std::vector<MirroredNode> found;
    traced_ += follow_mirrored(space_, tree, std::move(open_), found);
    open_.clear();
    std::ranges::stable_sort(found, {}, &MirroredNode::node);
    for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
        formats::Rgb share{0, 0, 0}, of_lobes{0, 0, 0};
        float hemisphere = 0;
        for (end = begin; end < found.size() && found[end].node == found[begin].node; ++end) {
            const float part = of_hemisphere_[found[end].number];
            formats::Rgb& sum = part > 0 ? share : of_lobes;
            sum = sum + found[end].share;
            hemisphere += part;
        }
        const float most =
            std::numbers::inv_pi_v<float> * tree.solid_angle_of_sky(found[begin].node);
        const float kept = hemisphere > most ? most / hemisphere : 1.0f;
        append_weight(found[begin].node, kept * share + of_lobes, weights);
        for (std::size_t i = begin; i < end; ++i) {
            const formats::Rgb& own = found[i].share;
            if (of_hemisphere_[found[i].number] > 0) {
                mirrored_[cell_[found[i].number]] -= (1 - kept) * std::max({own.r, own.g, own.b});
            }
        }
    }
    return traced_;
}

}  // namespace opaline::bake
