#include "formats/vdb/pack_bricks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "formats/vdb/limits.h"

namespace opaline::formats::vdb {
namespace {

constexpr int kSide = 8;
constexpr std::size_t kBrickVoxels = 512;

/// How many active voxels there are, and how many of them have a value that none should have.
struct Census {
    std::uint64_t active = 0, not_a_number = 0, negative = 0, infinite = 0;
    float least = 0;  ///< negative values down to this one are rounding, and are not counted

    void add(float value, std::uint64_t voxels) {
        not_a_number += std::isnan(value) ? voxels : 0;
        negative += value < least ? voxels : 0;
        infinite += std::isinf(value) ? voxels : 0;
    }
    void add(const openvdb::Vec3s& value, std::uint64_t voxels) {
        Census own;
        own.least = least;
        for (int i = 0; i < 3; ++i) {
            own.add(value[i], 1);
        }
        infinite += own.infinite > 0 ? voxels : 0;
        if (own.not_a_number > 0) {
            not_a_number += voxels;
        } else if (own.negative > 0) {
            negative += voxels;
        }
    }
};

float largest_of(float value) {
    return value;
}
float largest_of(const openvdb::Vec3s& value) {
    return std::max({largest_of(value[0]), largest_of(value[1]), largest_of(value[2])});
}

float repaired(float value) {
    return value > 0 ? value : 0;  // NaN is not
}
openvdb::Vec3s repaired(const openvdb::Vec3s& value) {
    return {repaired(value[0]), repaired(value[1]), repaired(value[2])};
}

bool has_value(float value) {
    return value > 0;
}
bool has_value(const openvdb::Vec3s& value) {
    return value[0] > 0 || value[1] > 0 || value[2] > 0;
}

void append(std::vector<float>& out, float value) {
    out.push_back(value);
}
void append(std::vector<float>& out, const openvdb::Vec3s& value) {
    out.insert(out.end(), {value[0], value[1], value[2]});
}

template <class Tree>
class Packer {
    using Value = typename Tree::ValueType;
    using Leaf = typename Tree::LeafNodeType;

    struct Brick {
        std::array<std::int32_t, 3> at{};  ///< voxel coordinates / 8: z, y, x
        const Leaf* leaf = nullptr;        ///< null: every voxel has the value of the tile
        Value tile{};
    };

  public:
    std::optional<Fault> run(const std::string& name, const Tree& tree, GridHead head,
                             BrickBudget& budget, ReplyWriter& reply) {
        if (tree.background() != openvdb::zeroVal<Value>()) {
            return Fault{"", "its background is not 0: it fills all of space",
                         "write it as a fog volume with background 0", true};
        }
        brick_limit_ = budget.bricks;
        float largest = 0;
        for (auto value = tree.cbeginValueOn(); value; ++value) {
            largest = std::max(largest, largest_of(repaired(*value)));
        }
        census_.least = -kRoundedToZero * largest;
        list_leaves(tree);
        list_tiles(tree);
        std::optional<Fault> fault = check_values();
        if (fault) fault->is_of_values = true;
        if (!fault) fault = check_places();
        if (!fault) fault = place_table(head, budget);
        if (fault) return fault;
        head.active_voxels = census_.active;
        head.not_a_number = census_.not_a_number;
        head.negative = census_.negative;
        head.bricks = static_cast<std::uint32_t>(bricks_.size());
        budget.bricks -= bricks_.size();
        reply.write_grid(name, head);
        write_bricks(head, reply);
        return {};
    }

  private:
    void list_leaves(const Tree& tree) {
        for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
            bool is_wanted = false;
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
                census_.add(*voxel, 1);
                is_wanted = is_wanted || has_value(*voxel);
            }
            census_.active += leaf->onVoxelCount();
            if (is_wanted) {
                add_brick(leaf->origin(), &*leaf, {});
            }
        }
    }

    void list_tiles(const Tree& tree) {
        auto tile = tree.cbeginValueOn();
        tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
        for (; tile; ++tile) {
            const openvdb::Coord origin = tile.getCoord();
            const auto voxels = static_cast<std::uint64_t>(tile.getVoxelCount());
            const Value value = *tile;
            census_.add(value, voxels);
            census_.active += voxels;
            const auto side = static_cast<std::int64_t>(std::llround(std::cbrt(voxels)));
            // Beyond the limit one brick more says as much as all of them.
            for (std::int64_t z = 0; z < side && has_value(value) && !is_past_limit(); z += kSide) {
                for (std::int64_t y = 0; y < side && !is_past_limit(); y += kSide) {
                    for (std::int64_t x = 0; x < side && !is_past_limit(); x += kSide) {
                        add_brick(origin, nullptr, repaired(value), {x, y, z});
                    }
                }
            }
        }
    }

    bool is_past_limit() const { return bricks_.size() > brick_limit_; }

    void add_brick(const openvdb::Coord& origin, const Leaf* leaf, const Value& tile,
                   std::array<std::int64_t, 3> offset = {}) {
        if (is_past_limit()) return;
        Brick brick{{}, leaf, tile};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t voxel = std::int64_t{origin[axis]} + offset[axis];
            is_far_ = is_far_ || voxel < -kMaxIndex || voxel > kMaxIndex - kSide;
            brick.at[2 - axis] = static_cast<std::int32_t>(voxel >> 3);
        }
        bricks_.push_back(brick);
    }

    std::optional<Fault> check_values() const {
        const auto limit = kMaxRepairedShare * static_cast<double>(census_.active);
        if (census_.active == 0) {
            return Fault{"", "it has no active voxel", "write it with the smoke or cloud in it"};
        }
        if (census_.infinite > 0) {
            return Fault{"", std::to_string(census_.infinite) + " voxels are infinite",
                         "write finite values"};
        }
        if (static_cast<double>(census_.not_a_number + census_.negative) > limit) {
            return Fault{"",
                         "of " + std::to_string(census_.active) + " active voxels " +
                             std::to_string(census_.not_a_number) + " are NaN and " +
                             std::to_string(census_.negative) + " negative",
                         "write values of 0 and above, or name the grids to read"};
        }
        if (bricks_.empty()) {
            return Fault{"", "it has no density: no voxel is above 0",
                         "write it with the smoke or cloud in it"};
        }
        return {};
    }

    std::optional<Fault> check_places() {
        if (is_past_limit()) {
            return Fault{"",
                         "with it more than " + std::to_string(kMaxBricks) +
                             " blocks of 8 x 8 x 8 voxels have to be read",
                         "write it with larger voxels, or read fewer grids"};
        }
        if (is_far_) {
            return Fault{"",
                         "it has voxels whose index is beyond " + std::to_string(kMaxIndex) +
                             " from the origin",
                         "move it closer to the origin of its index space"};
        }
        std::sort(bricks_.begin(), bricks_.end(),
                  [](const Brick& a, const Brick& b) { return a.at < b.at; });
        const auto twice =
            std::adjacent_find(bricks_.begin(), bricks_.end(),
                               [](const Brick& a, const Brick& b) { return a.at == b.at; });
        if (twice != bricks_.end()) {
            return Fault{"", "it is damaged: two nodes of its tree lie in the same place",
                         "write it again with the program that made it"};
        }
        return {};
    }

    // The smallest table that holds all bricks.
    std::optional<Fault> place_table(GridHead& head, BrickBudget& budget) const {
        std::uint64_t places = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int32_t low = std::numeric_limits<std::int32_t>::max();
            std::int32_t high = std::numeric_limits<std::int32_t>::min();
            for (const Brick& brick : bricks_) {
                low = std::min(low, brick.at[2 - axis]);
                high = std::max(high, brick.at[2 - axis]);
            }
            head.first_brick[axis] = low;
            head.extent[axis] = high - low + 1;  // at most 2^22, see is_far_
            places = std::min(places * static_cast<std::uint64_t>(head.extent[axis]),
                              std::uint64_t{kMaxTableBricks} + 1);
        }
        if (places > budget.table) {
            return Fault{"", "its active voxels lie too far apart",
                         "cut off stray voxels, or read fewer grids"};
        }
        budget.table -= places;
        return {};
    }

    void write_bricks(const GridHead& head, ReplyWriter& reply) const {
        std::vector<float> values;
        for (const Brick& brick : bricks_) {
            values.clear();
            for (std::size_t i = 0; i < kBrickVoxels; ++i) {
                append(values, value_at(brick, i));
            }
            const std::int32_t x = brick.at[2] - head.first_brick[0];
            const std::int32_t y = brick.at[1] - head.first_brick[1];
            const std::int32_t z = brick.at[0] - head.first_brick[2];
            reply.write_brick(
                static_cast<std::uint32_t>((z * head.extent[1] + y) * head.extent[0] + x), values);
        }
    }

    // i: x fastest. A leaf of OpenVDB has z fastest.
    static Value value_at(const Brick& brick, std::size_t i) {
        if (brick.leaf == nullptr) return brick.tile;
        const auto offset = static_cast<openvdb::Index>((i & 7) << 6 | (i & 56) | i >> 6);
        return brick.leaf->isValueOn(offset) ? repaired(brick.leaf->getValue(offset))
                                             : openvdb::zeroVal<Value>();
    }

    std::vector<Brick> bricks_;
    std::uint64_t brick_limit_ = 0;
    Census census_;
    bool is_far_ = false;
};

}  // namespace

std::optional<Fault> pack_bricks(const std::string& name, const openvdb::FloatTree& tree,
                                 GridHead head, BrickBudget& budget, ReplyWriter& reply) {
    head.is_color = 0;
    return Packer<openvdb::FloatTree>().run(name, tree, head, budget, reply);
}

std::optional<Fault> pack_bricks(const std::string& name, const openvdb::Vec3STree& tree,
                                 GridHead head, BrickBudget& budget, ReplyWriter& reply) {
    head.is_color = 1;
    return Packer<openvdb::Vec3STree>().run(name, tree, head, budget, reply);
}

}  // namespace opaline::formats::vdb
