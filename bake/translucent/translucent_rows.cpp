#include "bake/translucent/translucent_rows.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/spatial_order.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// Adds the Haar transform of a cube map of size m to that of size n >= m: the same function has the
// same coarse coefficients, n/m times as large, and none finer.
void add_coarse(std::span<const float> coarse, std::uint32_t m, std::span<float> fine,
                std::uint32_t n) {
    const auto scale = static_cast<float>(n) / static_cast<float>(m);
    for (std::size_t face = 0; face < 6; ++face) {
        for (std::size_t row = 0; row < m; ++row) {
            const float* const from = &coarse[(face * m + row) * m];
            float* const to = &fine[(face * n + row) * n];
            for (std::size_t column = 0; column < m; ++column) {
                to[column] += scale * from[column];
            }
        }
    }
}

std::vector<std::uint32_t> order_of(std::span<const BodyPoint> points) {
    std::vector<glm::vec3> positions;
    positions.reserve(points.size());
    for (const BodyPoint& point : points) {
        positions.push_back(point.position);
    }
    return spatial_order(positions);
}

// The `terms` rows of each receiver, which stand in the order of `order`, as receivers are given.
formats::SparseRows as_given(const formats::SparseRows& rows, std::span<const std::uint32_t> order,
                             std::uint32_t terms, std::uint32_t bands) {
    std::vector<std::uint32_t> from(order.size() * terms);
    for (std::uint32_t place = 0; place < order.size(); ++place) {
        for (std::uint32_t k = 0; k < terms; ++k) {
            from[std::size_t{order[place]} * terms + k] = place * terms + k;
        }
    }
    return formats::pick_rows(rows, bands, from);
}

}  // namespace

std::uint64_t assemble_rows(const TranslucentRecipe& recipe, const RayScene& rays,
                            const Receiver& receiver, const BodyPoint& point,
                            const SingleBatch* batch, std::size_t place, std::span<float> rows) {
    const std::uint32_t n = recipe.selector.cubemap_size;
    const std::size_t size = formats::cubemap_texels(n), bands = recipe.layout.bands();
    if (recipe.local != nullptr) {
        const std::uint64_t traced = gather_local(rays, *recipe.local, receiver, rows);
        for (std::size_t band = 0; band < bands; ++band) {
            formats::haar_forward_cube(rows.subspan(band * size, size), n);
        }
        return traced;
    }
    std::fill(rows.begin(), rows.end(), 0.0f);
    if (recipe.multiple != nullptr) {
        const MultipleStage& stage = *recipe.multiple;
        std::vector<ClusterWeight> weights;
        collect_weights(stage.tree, stage.profile, point.position, point.normal, recipe.gather,
                        weights);
        const auto scale = static_cast<float>(
            1 / (std::numbers::pi * stage.medium.exit * recipe.layout.view_of_multiple()));
        if (bands == 1) {
            accumulate_grey(stage.tree, weights, rows.first(size));
            for (float& value : rows.first(size)) {
                value *= scale;
            }
        } else {
            std::vector<float> rgbx(4 * size);
            accumulate(stage.tree, weights, rgbx);
            for (std::size_t k = 0; k < size; ++k) {
                for (std::size_t band = 0; band < bands; ++band) {
                    rows[band * size + k] = scale * rgbx[4 * k + band];
                }
            }
        }
    }
    if (batch != nullptr) {
        const std::uint32_t m = recipe.single->directions.cubemap_size;
        const std::size_t coarse = formats::cubemap_texels(m);
        std::vector<float> row(batch->row_size);
        read_single(*batch, place, row);
        const std::size_t first = bands * recipe.layout.first_single();
        for (std::size_t plane = 0; plane < row.size() / coarse; ++plane) {
            const std::span<float> own = std::span(row).subspan(plane * coarse, coarse);
            formats::haar_forward_cube(own, m);
            add_coarse(own, m, rows.subspan((first + plane) * size, size), n);
        }
    }
    return 0;
}

formats::SparseRows bake_translucent(const TranslucentRecipe& recipe, const RayScene& rays,
                                     std::span<const Receiver> receivers,
                                     std::span<const BodyPoint> points, const Context& context,
                                     EntryCounts& counts) {
    const std::uint32_t n = recipe.selector.cubemap_size;
    const std::uint32_t bands = recipe.layout.bands();
    const std::size_t row_size = bands * std::size_t{formats::cubemap_texels(n)};
    const std::uint32_t terms = recipe.layout.terms();
    const std::size_t step = recipe.single != nullptr
                                 ? receivers_per_batch(*recipe.single, recipe.batch_bytes)
                                 : std::max<std::size_t>(1, points.size());
    struct Block {
        formats::SparseRows rows;
        std::uint64_t rays = 0;
    };
    // Neighbours gather from the same clusters and read the same lines of packed rows: one after
    // the other they find them in the cache. Files may list vertices in any order.
    const std::vector<std::uint32_t> order = order_of(points);
    std::vector<BodyPoint> part;
    formats::SparseRows rows = formats::make_sparse_rows(n, recipe.code_bits);
    for (std::size_t begin = 0; begin < points.size() && !context.cancelled(); begin += step) {
        const std::span<const std::uint32_t> index =
            std::span(order).subspan(begin, std::min(step, points.size() - begin));
        part.clear();
        for (const std::uint32_t i : index) {
            part.push_back(points[i]);
        }
        SingleBatch batch;
        if (recipe.single != nullptr) {
            batch = gather_single_batch(*recipe.single, rays, part, context);
            counts.rays += batch.rows.counts.rays;
            counts.missing += batch.rows.counts.missing;
        }
        for_each_block_in_order(
            part.size(), 64, context,
            [&](Range range) {
                Block block{formats::make_sparse_rows(n, recipe.code_bits), 0};
                std::vector<float> values(terms * row_size);
                for (std::size_t v = range.begin; v < range.end; ++v) {
                    block.rays +=
                        assemble_rows(recipe, rays, receivers[index[v]], part[v],
                                      recipe.single != nullptr ? &batch : nullptr, v, values);
                    for (std::size_t k = 0; k < terms; ++k) {
                        formats::append_row(
                            block.rows, select_coefficients(recipe.selector,
                                                            std::span<const float>(values).subspan(
                                                                k * row_size, row_size),
                                                            bands));
                    }
                }
                return block;
            },
            [&](Range range, const Block& block) {
                formats::append_rows(rows, block.rows);
                counts.rays += block.rays;
                if (context.on_progress) {
                    context.on_progress({"rows", begin + range.end, points.size()});
                }
            });
    }
    // Rows are missing where the bake was cancelled, or where they are too many for one file: the
    // caller counts them.
    const bool is_whole = rows.row_offset.size() == points.size() * terms + 1;
    return is_whole ? as_given(rows, order, terms, bands) : rows;
}

}  // namespace opaline::bake
