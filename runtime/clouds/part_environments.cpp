#include "runtime/clouds/part_environments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "runtime/clouds/environment_at.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

class Box {
  public:
    void add(Vec3 p) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    void add(const Box& box) {
        if (box.is_empty()) return;
        add(box.low_);
        add(box.high_);
    }
    bool is_empty() const { return low_.x > high_.x; }
    // Halves first: the sum of two floats may be infinite.
    Vec3 centre() const { return 0.5f * low_ + 0.5f * high_; }
    double side() const {
        return std::max(static_cast<double>(high_.x) - static_cast<double>(low_.x),
                        static_cast<double>(high_.z) - static_cast<double>(low_.z));
    }
    Vec3 low() const { return low_; }

  private:
    static constexpr float kLargest = std::numeric_limits<float>::max();
    Vec3 low_{kLargest, kLargest, kLargest}, high_{-kLargest, -kLargest, -kLargest};
};

// What is lit as one.
struct Item {
    Box box;
    std::vector<std::uint32_t> primitives;
    bool has_volumes = false;
};

std::vector<Item> list_items(const formats::AssetView& asset,
                             std::span<const Vec3> volume_corners) {
    std::map<std::uint32_t, Item> of_node;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        Item& item = of_node[primitive.node];
        item.primitives.push_back(p);
        for (const Vec3 position :
             asset.position.subspan(primitive.first_vertex, primitive.vertex_count)) {
            item.box.add(position);
        }
    }
    std::vector<Item> items;
    items.reserve(of_node.size() + 1);
    for (auto& [node, item] : of_node) {
        items.push_back(std::move(item));
    }
    Item volumes;
    volumes.has_volumes = true;
    for (const Vec3 corner : volume_corners) {
        volumes.box.add(corner);
    }
    items.push_back(std::move(volumes));
    std::erase_if(items, [](const Item& item) { return item.box.is_empty(); });
    return items;
}

// A cell along x and z.
using Cell = std::array<std::int64_t, 2>;

Cell cell_of(const Item& item, Vec3 low, double side) {
    const Vec3 at = item.box.centre();
    const auto number = [&](float x, float begin) {
        return static_cast<std::int64_t>(
            std::floor((static_cast<double>(x) - static_cast<double>(begin)) / side));
    };
    return {number(at.x, low.x), number(at.z, low.z)};
}

// Items by cell, in the order of cells; the side doubles until they are few.
std::map<Cell, std::vector<const Item*>> sort_into_cells(std::span<const Item> items, Vec3 low,
                                                         double side) {
    std::map<Cell, std::vector<const Item*>> cells;
    do {
        cells.clear();
        for (const Item& item : items) {
            cells[cell_of(item, low, side)].push_back(&item);
        }
        side *= 2;
    } while (cells.size() > kMaxLightPoints);
    return cells;
}

bool is_even(const LayerField& field) {
    const auto [low, high] = std::ranges::minmax(field.thickness.level.front().value);
    return field.repeats() && low == high;
}

}  // namespace

PartEnvironments environments_of_parts(const LayerScene& scene, const formats::AssetView& asset,
                                       std::span<const formats::Vec3> volume_corners,
                                       formats::Vec3 centre, unsigned threads) {
    PartEnvironments parts;
    parts.points = light_points(asset, volume_corners, scene.light.field, centre);
    parts.at_point.reserve(parts.points.point.size());
    for (const formats::Vec3 point : parts.points.point) {
        parts.at_point.push_back(environment_at(scene, point, {.threads = threads}));
    }
    if (parts.at_point.size() > 1 && specular_needs(asset).any()) {
        parts.at_centre = environment_at(scene, centre, {.threads = threads});
    }
    return parts;
}

LightPoints light_points(const formats::AssetView& asset, std::span<const Vec3> volume_corners,
                         const LayerField& field, Vec3 centre) {
    LightPoints points{{centre}, std::vector<std::uint32_t>(asset.primitives.size(), 0), 0};
    const std::vector<Item> items = list_items(asset, volume_corners);
    Box centres;
    for (const Item& item : items) {
        centres.add(item.box.centre());
    }
    if (items.size() < 2 || centres.side() <= field.cell || is_even(field)) return points;
    points.point.clear();
    // Cells that are too small for their numbers would come to too many anyway.
    const double least = std::max(field.cell, centres.side() / 4096);
    for (const auto& [cell, members] : sort_into_cells(items, centres.low(), least)) {
        const auto number = static_cast<std::uint32_t>(points.point.size());
        Box box;
        for (const Item* item : members) {
            box.add(item->box);
            for (const std::uint32_t p : item->primitives) {
                points.of_primitive[p] = number;
            }
            if (item->has_volumes) points.of_volumes = number;
        }
        points.point.push_back(box.centre());
    }
    return points;
}

}  // namespace opaline::runtime
