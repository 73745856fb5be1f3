#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/light_quadtree.h"
#include "runtime/simd.h"

namespace opaline::runtime {

/// A cell of a LightQuadtree, its flux as a share of all light: no sum of floats overflows.
struct LobeCell {
    formats::Vec3 centre, flux_centre;  ///< unit directions: of the cell, of the light in it
    float solid_angle = 0;              ///< sr
    formats::Rgb flux;                  ///< integral of radiance over the cell / LobeTree::total
};

struct LobeTree {
    std::vector<std::vector<LobeCell>> level;  ///< as in LightQuadtree
    double total = 0;                          ///< that fluxes are shares of
};

LobeTree make_lobe_tree(const LightQuadtree& tree);

/// Eight directions that are next to each other: a tile of 4 x 2 texels. Eight tiles are a block of
/// 8 x 8.
constexpr std::uint32_t kTileWidth = 4, kTileHeight = 2, kTileBlock = 8;
struct DirectionTile {
    alignas(32) std::array<float, 8> x, y, z;
    formats::Vec3 centre;
    float radius = 0;  ///< no direction is further from the centre, as a chord
};

/// Of the texels from (row, column) of a face of `size` texels a side.
DirectionTile make_tile(std::uint32_t size, std::uint32_t face, std::uint32_t row,
                        std::uint32_t column);

/// Chords between a direction and the centre of a cell of one level. Cells are divided while they
/// are large beside the distance over which the lobe changes, which is alpha at its peak and half
/// the angle away from it. 0.7 of it is small enough, since both sums err alike and light counts
/// where it is (tested against the plain sum); for the widest lobes cells of a quarter of a face or
/// more are always divided.
struct Reach {
    float divided = -4;  ///< nearer: the cell is divided; chords are in [0, 2]
    float lit = 0;       ///< further away: it lies behind the lobe's horizon
};

/// Which cells a block's tiles add: chosen for all tiles in one descent, each of which may add,
/// divide or skip a cell.
class BlockCells {
  public:
    /// `alpha_squared`: of the lobe's GGX distribution, in (0, 1]. Keeps a reference to the tree.
    BlockCells(const LobeTree& tree, float alpha_squared);

    /// Chooses for these tiles; what was chosen before is gone.
    void move_to(const std::array<DirectionTile, 8>& tiles);

    /// Cells that all tiles add.
    std::span<const LobeCell* const> common() const { return common_; }

    /// Those that a tile, 0 to 7, adds beside these; until the next call.
    std::span<const LobeCell* const> own(std::uint32_t tile);

  private:
    static constexpr std::uint32_t kAll = 0xff;
    struct Node {
        std::uint32_t level, row, column;
        std::uint32_t tiles;  // bits: those that come to it
    };
    struct Squares {
        std::array<Float4, 2> divided, lit;
    };
    struct TilesOfCell {
        const LobeCell* cell;
        std::uint32_t tiles;  // bits: those that add it
    };

    void follow(Node n);

    const LobeTree& tree_;
    std::vector<Reach> reach_;               // of each level
    std::vector<Squares> square_;            // of each level: of the tiles where they are now
    std::array<Float4, 2> x_{}, y_{}, z_{};  // their centres
    // The six faces, and for each level of the tree, of which there are not as many, three cells
    // that wait for the fourth.
    std::array<Node, 6 + 3 * 16> stack_{};
    std::size_t waiting_ = 0;  // in stack_
    std::vector<const LobeCell*> common_, own_;
    std::vector<TilesOfCell> others_;
};

}  // namespace opaline::runtime
