// SpecularLight: the environment, convolved.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/lobe_cells.h"
#include "runtime/parallel.h"
#include "runtime/simd.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

std::atomic<std::uint64_t> last_light_id{0};

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

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

// Sums over cells of each of a tile's texels, in single precision over a few cells, then in double.
template <std::size_t bands>
struct TileSums {
    std::array<std::array<double, 8>, bands> value{};

    template <class L>
    OPALINE_ALWAYS_INLINE void add(L, std::size_t band, std::size_t first,
                                   const typename L::Float& part) {
        for (std::size_t k = 0; k < L::kCount; ++k) {
            value[band][first + k] += static_cast<double>(part[k]);
        }
    }
};

// Three bands: adds each cell's flux by the lobe toward it. One: its solid angle.
template <std::size_t bands>
void add_cells(std::span<const LobeCell* const> cells, float alpha_squared,
               const DirectionTile& tile, TileSums<bands>& sums) {
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
                std::array<Float, bands> sum = {};
                for (std::size_t i = first; i < last; ++i) {
                    const LobeCell& cell = *cells[i];
                    Float lobe;
                    if constexpr (bands == 1) {
                        eval_lobe(lanes, alpha_squared, at, cell.centre, lobe);
                        sum[0] += lobe * cell.solid_angle;
                    } else {
                        eval_lobe(lanes, alpha_squared, at, cell.flux_centre, lobe);
                        sum[0] += lobe * cell.flux.r;
                        sum[1] += lobe * cell.flux.g;
                        sum[2] += lobe * cell.flux.b;
                    }
                }
                for (std::size_t band = 0; band < bands; ++band) {
                    sums.add(lanes, band, k, sum[band]);
                }
            }
        }
    });
}

// Texels of a cube map of `size` texels a side: rows of it from the first face on, columns.
struct Area {
    std::uint32_t size, rows, columns;
};

// Calls visit(row, column, sums) for the first texel of each tile, with the sums of its texels.
template <std::size_t bands, class Visit>
void for_tiles(const LobeTree& tree, float alpha_squared, const Area& area, unsigned threads,
               const Visit& visit) {
    for_ranges(area.rows / kTileBlock, 1, threads, [&](std::uint32_t block, std::uint32_t) {
        BlockCells cells(tree, alpha_squared);
        const std::uint32_t top = block * kTileBlock, size = area.size;
        for (std::uint32_t left = 0; left < area.columns; left += kTileBlock) {
            const auto row_of = [top](std::uint32_t t) { return top + t / 2 * kTileHeight; };
            const auto column_of = [left](std::uint32_t t) { return left + t % 2 * kTileWidth; };
            std::array<DirectionTile, 8> tiles;
            for (std::uint32_t t = 0; t < 8; ++t) {
                tiles[t] = make_tile(size, top / size, row_of(t) % size, column_of(t));
            }
            cells.move_to(tiles);
            for (std::uint32_t t = 0; t < 8; ++t) {
                TileSums<bands> sums;
                add_cells(cells.common(), alpha_squared, tiles[t], sums);
                add_cells(cells.own(t), alpha_squared, tiles[t], sums);
                visit(row_of(t), column_of(t), sums);
            }
        }
    });
}

// The integral of the lobe around a texel by the same cells as the light's. They mirror on each
// face and are the same on all: a quarter of one face says all.
class LobeIntegrals {
  public:
    LobeIntegrals(const LobeTree& tree, float alpha_squared, std::uint32_t size, unsigned threads)
        : size_(size), quarter_(std::size_t{size} * size / 4) {
        const Area area{size, size / 2, size / 2};
        for_tiles<1>(tree, alpha_squared, area, threads,
                     [&](std::uint32_t row, std::uint32_t column, const TileSums<1>& sums) {
                         for (std::uint32_t k = 0; k < 8; ++k) {
                             quarter_[std::size_t{row + k / kTileWidth} * size / 2 + column +
                                      k % kTileWidth] = sums.value[0][k];
                         }
                     });
    }
    double at(std::uint32_t row, std::uint32_t column) const {
        return quarter_[std::size_t{fold(row % size_)} * size_ / 2 + fold(column)];
    }

  private:
    std::uint32_t fold(std::uint32_t x) const { return std::min(x, size_ - 1 - x); }
    std::uint32_t size_;
    std::vector<double> quarter_;
};

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
    const LobeIntegrals integrals(tree, alpha_squared, size, threads);
    for_tiles<3>(tree, alpha_squared, {size, map.height, size}, threads,
                 [&](std::uint32_t row, std::uint32_t column, const TileSums<3>& sums) {
                     for (std::uint32_t k = 0; k < 8; ++k) {
                         const std::uint32_t r = row + k / kTileWidth, c = column + k % kTileWidth;
                         const double scale = tree.total / integrals.at(r, c);
                         map.pixel[std::size_t{r} * size + c] = {
                             storable_mean(scale * sums.value[0][k]),
                             storable_mean(scale * sums.value[1][k]),
                             storable_mean(scale * sums.value[2][k])};
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
