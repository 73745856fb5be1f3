// SpecularLight: the environment, convolved.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_quadtree.h"
#include "runtime/parallel.h"
#include "runtime/simd.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

std::atomic<std::uint64_t> last_light_id{0};

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

// A cell of a LightQuadtree, its flux as a share of all light: no sum of floats overflows.
struct LobeCell {
    Vec3 centre, flux_centre;
    float solid_angle = 0;
    Rgb flux;
};

struct LobeTree {
    std::vector<std::vector<LobeCell>> level;  // as in LightQuadtree
    double total = 0;                          // that fluxes are shares of
};

LobeTree make_lobe_tree(const LightQuadtree& tree) {
    LobeTree lobes;
    for (const LightCell& face : tree.level.front()) {
        lobes.total += std::abs(face.flux[0]) + std::abs(face.flux[1]) + std::abs(face.flux[2]);
    }
    const double share = lobes.total > 0 ? 1 / lobes.total : 0;
    for (const std::vector<LightCell>& cells : tree.level) {
        std::vector<LobeCell>& out = lobes.level.emplace_back();
        out.reserve(cells.size());
        for (const LightCell& c : cells) {
            out.push_back(
                {c.centre,
                 c.flux_centre,
                 c.solid_angle,
                 {static_cast<float>(share * c.flux[0]), static_cast<float>(share * c.flux[1]),
                  static_cast<float>(share * c.flux[2])}});
        }
    }
    return lobes;
}

// Directions that are next to each other.
struct Cone {
    Vec3 centre;
    float radius = 0;  // no direction is further from the centre, as a chord
};

// Eight of them: a tile of 4 x 2 texels. Eight tiles are a block of 8 x 8.
constexpr std::uint32_t kTileWidth = 4, kTileHeight = 2, kTileBlock = 8;
struct Tile {
    alignas(32) std::array<float, 8> x, y, z;
    Cone cone;
};

Tile make_tile(std::uint32_t size, std::uint32_t face, std::uint32_t row, std::uint32_t column) {
    Tile tile;
    std::array<Vec3, 8> direction;
    Vec3 sum{0, 0, 0};
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec3 d =
            formats::texel_direction(size, face, row + k / kTileWidth, column + k % kTileWidth);
        direction[k] = d;
        tile.x[k] = d.x;
        tile.y[k] = d.y;
        tile.z[k] = d.z;
        sum = sum + d;
    }
    tile.cone.centre = normalize(sum);
    for (const Vec3 d : direction) {
        tile.cone.radius = std::max(tile.cone.radius, length(d - tile.cone.centre));
    }
    return tile;
}

Cone cone_around(const std::array<Tile, 8>& tiles) {
    Vec3 sum{0, 0, 0};
    for (const Tile& tile : tiles) {
        sum = sum + tile.cone.centre;
    }
    Cone cone{normalize(sum), 0};
    for (const Tile& tile : tiles) {
        cone.radius =
            std::max(cone.radius, length(tile.cone.centre - cone.centre) + tile.cone.radius);
    }
    return cone;
}

template <class L>
struct Directions {
    typename L::Float x, y, z;
};

// D(theta / 2) max(0, cos theta) up to a factor, at most 1.
template <class L>
OPALINE_ALWAYS_INLINE void eval_lobe(L, float alpha_squared, const Directions<L>& at, Vec3 w,
                                     typename L::Float& out) {
    using Float = typename L::Float;
    const Float x = at.x - w.x, y = at.y - w.y, z = at.z - w.z, zero = {};
    // sin^2(theta / 2) = chord^2 / 4, without the cancellation in 1 - cos theta.
    const Float sine_squared = 0.25f * (x * x + y * y + z * z);
    const Float cosine = 1 - 2 * sine_squared;
    const Float ratio = alpha_squared / (alpha_squared * (1 - sine_squared) + sine_squared);
    out = cosine > 0 ? cosine * ratio * ratio : zero;
}

// Sums of r, g, b and weight, in single precision over a few cells, then in double.
struct TileSums {
    std::array<std::array<double, 8>, 4> value{};

    template <class L>
    OPALINE_ALWAYS_INLINE void add(L, std::size_t band, std::size_t first,
                                   const typename L::Float& part) {
        for (std::size_t k = 0; k < L::kCount; ++k) {
            value[band][first + k] += static_cast<double>(part[k]);
        }
    }
};

enum class Choice { skip, add, divide };

// Chords between a direction and the centre of a cell of one level. Cells are divided while they
// are large beside the distance over which the lobe changes, which is alpha at its peak and half
// the angle away from it. 0.7 of it is small enough, since both sums err alike and light counts
// where it is (tested against the plain sum); for the widest lobes cells of a quarter of a face or
// more are always divided.
struct Reach {
    float divided = -4;  // nearer: the cell is divided; chords are in [0, 2]
    float lit = 0;       // further away: it lies behind the lobe's horizon

    Choice at(float distance) const {
        return distance > lit ? Choice::skip : distance < divided ? Choice::divide : Choice::add;
    }
};

std::vector<Reach> reaches(std::size_t levels, float alpha_squared) {
    std::vector<Reach> of_level(levels);
    for (std::size_t level = 0; level < levels; ++level) {
        const float radius = 1.42f / static_cast<float>(1u << level);  // half the diagonal
        of_level[level].lit = std::sqrt(2 * (1 + radius));
        if (level + 1 == levels) continue;  // texels stay whole
        const float room = 2 * radius * radius - alpha_squared;
        if (room > 0) of_level[level].divided = 2 * std::sqrt(room);
        if (level < 3 && alpha_squared > 0.05f) of_level[level].divided = 4;
    }
    return of_level;
}

struct Node {
    std::uint32_t level, row, column;
};

// What the tiles of a block add, chosen for all of them once where they choose alike.
class BlockCells {
  public:
    BlockCells(const LobeTree& tree, float alpha_squared)
        : tree_(tree), reach_(reaches(tree.level.size(), alpha_squared)) {}

    void move_to(const Cone& block) {
        add_.clear();
        open_.clear();
        stack_.clear();
        for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
            stack_.push_back({0, face, 0});
        }
        while (!stack_.empty()) {
            const Node node = stack_.back();
            stack_.pop_back();
            const float distance = length(block.centre - cell_of(node).centre);
            const Choice nearest = reach_[node.level].at(distance - block.radius);
            if (nearest != reach_[node.level].at(distance + block.radius)) {
                open_.push_back(node);
            } else {
                follow(nearest, node, add_);
            }
        }
    }

    // Of one tile of the block: its cells as far as they are not those of all tiles.
    void finish(const Cone& tile) {
        own_.clear();
        stack_ = open_;
        while (!stack_.empty()) {
            const Node node = stack_.back();
            stack_.pop_back();
            const float distance = length(tile.centre - cell_of(node).centre) - tile.radius;
            follow(reach_[node.level].at(distance), node, own_);
        }
    }

    std::span<const LobeCell* const> common() const { return add_; }
    std::span<const LobeCell* const> own() const { return own_; }

  private:
    const LobeCell& cell_of(const Node& n) const {
        return tree_.level[n.level][(std::size_t{n.row} << n.level) + n.column];
    }
    void follow(Choice choice, const Node& n, std::vector<const LobeCell*>& cells) {
        if (choice == Choice::add) cells.push_back(&cell_of(n));
        if (choice != Choice::divide) return;
        for (const std::uint32_t i : {0u, 1u, 2u, 3u}) {
            stack_.push_back({n.level + 1, 2 * n.row + i / 2, 2 * n.column + i % 2});
        }
    }
    const LobeTree& tree_;
    std::vector<Reach> reach_;  // of each level
    std::vector<Node> stack_, open_;
    std::vector<const LobeCell*> add_, own_;
};

void add_cells(std::span<const LobeCell* const> cells, float alpha_squared, const Tile& tile,
               TileSums& sums) {
    constexpr std::size_t kAtOnce = 16;
    run_wide([&](auto lanes) __attribute__((always_inline)) {
        using L = decltype(lanes);
        using Float = typename L::Float;
        for (std::size_t k = 0; k < 8; k += L::kCount) {
            Directions<L> at;
            std::memcpy(&at.x, &tile.x[k], sizeof at.x);
            std::memcpy(&at.y, &tile.y[k], sizeof at.y);
            std::memcpy(&at.z, &tile.z[k], sizeof at.z);
            for (std::size_t first = 0; first < cells.size(); first += kAtOnce) {
                const std::size_t last = std::min(first + kAtOnce, cells.size());
                Float r = {}, g = {}, b = {}, weight = {};
                for (std::size_t i = first; i < last; ++i) {
                    const LobeCell& cell = *cells[i];
                    Float lit, open;
                    eval_lobe(lanes, alpha_squared, at, cell.flux_centre, lit);
                    eval_lobe(lanes, alpha_squared, at, cell.centre, open);
                    r += lit * cell.flux.r;
                    g += lit * cell.flux.g;
                    b += lit * cell.flux.b;
                    weight += open * cell.solid_angle;
                }
                sums.add(lanes, 0, k, r);
                sums.add(lanes, 1, k, g);
                sums.add(lanes, 2, k, b);
                sums.add(lanes, 3, k, weight);
            }
        }
    });
}

float storable_mean(double radiance) {
    return static_cast<float>(std::clamp(radiance, 0.0, 1e35));
}

Environment convolve(const LobeTree& tree, double alpha, unsigned threads) {
    const std::uint32_t n = 1u << (tree.level.size() - 1);
    const double widened = std::max(alpha, 1.0 / n);  // no lobe narrower than a texel
    std::uint32_t size = 16;                          // two texels across half the lobe's width
    while (size < n && size < 2 / widened) {
        size *= 2;
    }
    Environment map;
    map.layout = Environment::Layout::cube;
    map.width = size;
    map.height = formats::kCubeFaces * size;
    map.pixel.resize(formats::cubemap_texels(size));
    const auto alpha_squared = static_cast<float>(widened * widened);
    for_ranges(map.height / kTileBlock, 1, threads, [&](std::uint32_t block, std::uint32_t) {
        BlockCells cells(tree, alpha_squared);
        const std::uint32_t top = block * kTileBlock;
        for (std::uint32_t left = 0; left < size; left += kTileBlock) {
            const auto row_of = [top](std::uint32_t t) { return top + t / 2 * kTileHeight; };
            const auto column_of = [left](std::uint32_t t) { return left + t % 2 * kTileWidth; };
            std::array<Tile, 8> tiles;
            for (std::uint32_t t = 0; t < 8; ++t) {
                tiles[t] = make_tile(size, top / size, row_of(t) % size, column_of(t));
            }
            cells.move_to(cone_around(tiles));
            for (std::uint32_t t = 0; t < 8; ++t) {
                cells.finish(tiles[t].cone);
                TileSums sums;
                add_cells(cells.common(), alpha_squared, tiles[t], sums);
                add_cells(cells.own(), alpha_squared, tiles[t], sums);
                for (std::uint32_t k = 0; k < 8; ++k) {
                    const double scale = tree.total / sums.value[3][k];
                    map.pixel[std::size_t{row_of(t) + k / kTileWidth} * size + column_of(t) +
                              k % kTileWidth] = {storable_mean(scale * sums.value[0][k]),
                                                 storable_mean(scale * sums.value[1][k]),
                                                 storable_mean(scale * sums.value[2][k])};
                }
            }
        }
    });
    return map;
}

double alpha_of(std::uint32_t level) {
    const double roughness = static_cast<double>(level) / kRoughnessSteps;
    return roughness * roughness;
}

// The sharpest lobe needs so many texels a side.
std::uint32_t texels_for(std::span<const std::uint32_t> levels) {
    const double sharpest = alpha_of(*std::min_element(levels.begin(), levels.end()));
    return sharpest < 0.03 ? 128 : sharpest < 0.12 ? 64 : 32;
}

// Of n x n texels a face into as many as asked for.
std::vector<double> sum_to(std::span<const double> integral, std::uint32_t n,
                           std::uint32_t coarse) {
    std::vector<double> sums(std::size_t{3} * formats::cubemap_texels(coarse));
    const std::uint32_t share = n / coarse;
    for (std::size_t row = 0; row < std::size_t{formats::kCubeFaces} * n; ++row) {
        for (std::size_t column = 0; column < n; ++column) {
            double* const sum = &sums[3 * (row / share * coarse + column / share)];
            const double* const part = &integral[3 * (row * n + column)];
            for (std::size_t band = 0; band < 3; ++band) {
                sum[band] += part[band];
            }
        }
    }
    return sums;
}

}  // namespace

SpecularSource integrate_for_specular(const Environment& map, const SpecularNeeds& needs,
                                      unsigned threads) {
    SpecularSource source;
    if (!needs.any()) return source;
    source.n = needs.gloss ? kGlossTexels : texels_for(needs.levels);
    source.integral.resize(std::size_t{3} * formats::cubemap_texels(source.n));
    integrate_map(map, source.n, {}, threads, source.integral);
    return source;
}

SpecularLight make_specular_light(const SpecularSource& source,
                                  std::span<const formats::DistantDisc> discs,
                                  const SpecularNeeds& needs, const Rotation& rotation,
                                  unsigned threads) {
    SpecularLight light;
    light.rotation = rotation;
    light.id = ++last_light_id;
    if (!needs.levels.empty()) {
        const std::uint32_t n = texels_for(needs.levels);
        std::vector<double> integral = sum_to(source.integral, source.n, n);
        integrate_discs(discs, n, {}, integral);
        const LobeTree tree = make_lobe_tree(make_light_quadtree(integral, n, threads));
        for (const std::uint32_t level : needs.levels) {
            light.maps.push_back({level, convolve(tree, alpha_of(level), threads)});
        }
    }
    if (needs.gloss) light.gloss = make_gloss_light(source.integral, discs, threads);
    return light;
}

SpecularLight make_specular_light(const Environment& environment, const SpecularNeeds& needs,
                                  const Rotation& rotation, unsigned threads) {
    return make_specular_light(integrate_for_specular(environment, needs, threads),
                               environment.discs, needs, rotation, threads);
}

SpecularLight prefilter_specular(const Environment& environment,
                                 std::span<const std::uint32_t> levels, const Rotation& rotation,
                                 unsigned threads) {
    return make_specular_light(environment, {{levels.begin(), levels.end()}, false}, rotation,
                               threads);
}

}  // namespace opaline::runtime
