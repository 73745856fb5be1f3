#include "bake/exchange/mirrored_cells.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "bake/base/rng.h"

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

std::uint32_t MirroredCells::add(const BounceEnd& end, float share) {
    const glm::vec3 y = at_.origin + end.distance * end.direction;
    const MirroredRay own = mirror(
        space_, {y, end.direction, end.distance, end.error, end.material, end.side, end.triangle},
        {share, share, share}, 0);
    if (!(own.largest() > 0)) return formats::kNone;
    const std::size_t first = open_.size();
    open_.push_back(own);
    if (parts_ > 1 && !end.is_quarter && (own.of_lobe == 0 || (cuts_lobes_ && !own.is_weak))) {
        add_parts(end, share);
    }
    return number_from(first, share, own.of_lobe > 0);
}

// Makes one cell of the rays from `first` on, which share its light.
std::uint32_t MirroredCells::number_from(std::size_t first, float of_hemisphere, bool is_lobe) {
    const float each = 1 / static_cast<float>(open_.size() - first);
    const auto cell = static_cast<std::uint32_t>(mirrored_.size());
    mirrored_.push_back(0);
    is_lobe_.push_back(is_lobe ? 1 : 0);
    for (std::size_t i = first; i < open_.size(); ++i) {
        open_[i].share = each * open_[i].share;
        open_[i].number = static_cast<std::uint32_t>(i);
        of_hemisphere_.push_back(open_[i].of_lobe > 0 ? 0 : each * of_hemisphere);
        cell_.push_back(cell);
        mirrored_[cell] += open_[i].largest();
    }
    return cell;
}

void MirroredCells::add_inside(const BounceEnd& end, float share, std::uint32_t medium) {
    const std::size_t first = open_.size();
    const auto start = [&](const glm::vec3& direction) {
        open_.push_back({.origin = at_.origin,
                         .direction = direction,
                         .share = {share, share, share},
                         .medium = medium});
    };
    start(end.direction);
    if (parts_ > 1 && !end.is_quarter) {
        visit_parts(end.cell, [&](std::uint32_t, const glm::vec3& direction) { start(direction); });
    }
    number_from(first, 0, false);
}

// A direction in each part of the cell but that of its own ray.
template <class Visit>
void MirroredCells::visit_parts(std::uint32_t cell, Visit&& visit) const {
    const std::uint32_t count = parts_ * parts_;
    const auto per_side = static_cast<float>(parts_);
    const float width = 1 / (static_cast<float>(grid_.side) * per_side);
    const std::uint32_t column = cell % grid_.side, row = cell / grid_.side;
    const glm::vec2 place = place_in_cell(grid_, seed_, key_, row, column);
    const std::uint32_t taken = static_cast<std::uint32_t>(place.y * per_side) * parts_ +
                                static_cast<std::uint32_t>(place.x * per_side);
    for (std::uint32_t part = 0; part < count; ++part) {
        if (part == taken) continue;
        const std::uint32_t part_row = part / parts_;
        const auto u =
            random_uniform(seed_, RandomStage::bounce_rays, key_, kOfParts + cell * count + part);
        const auto across = static_cast<float>(column * parts_ + part % parts_) + u[0];
        const auto along = static_cast<float>(row * parts_ + part_row) + u[1];
        visit(part, frame_.to_world(to_hemisphere(across * width, along * width)));
    }
}

void MirroredCells::add_parts(const BounceEnd& end, float share) {
    RayPacket packet = rays_from(at_.origin);
    LaneMask lanes{};
    visit_parts(end.cell, [&](std::uint32_t part, const glm::vec3& direction) {
        set_lane(packet, lanes, part, direction);
    });
    const PacketHits hits = space_.rays.closest(lanes, packet);
    const std::uint32_t count = parts_ * parts_;
    traced_ += count - 1;
    for (std::uint32_t part = 0; part < count; ++part) {
        if (hits.hit[part] == 0) continue;
        const glm::vec3 d = direction_of(packet, part);
        const MirroredRay ray = mirror(space_, end_of_ray(space_.scene, at_.origin, d, hits, part),
                                       {share, share, share}, 0);
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
