#include "bake/effects/rows/gather_rows.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/encode/share_rows.h"
#include "bake/receivers/spatial_order.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// Neighbours gather from the same clusters and read the same lines of batches: one after the other
// they find them in the cache. Files may list vertices in any order.
std::vector<std::uint32_t> order_of(const ReceiverSet& set, const RowLayout& layout) {
    std::vector<std::uint32_t> order(set.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!layout.translucent) return order;
    std::vector<glm::vec3> positions;
    positions.reserve(set.size());
    for (const BodyPoint& point : set.inside) {
        positions.push_back(point.position);
    }
    return spatial_order(positions);
}

// Reorders the `terms` rows of each receiver from the order of `order` to that of the receivers.
formats::SparseRows as_given(formats::SparseRows rows, std::span<const std::uint32_t> order,
                             const RowLayout& layout) {
    const std::uint32_t terms = layout.terms();
    std::vector<std::uint32_t> from(order.size() * terms);
    for (std::uint32_t place = 0; place < order.size(); ++place) {
        for (std::uint32_t k = 0; k < terms; ++k) {
            from[std::size_t{order[place]} * terms + k] = place * terms + k;
        }
    }
    return formats::pick_rows(std::move(rows), layout.bands(), from);
}

std::size_t batch_size(std::span<const Gatherer> gatherers, std::size_t all, std::size_t bytes) {
    std::size_t size = std::max<std::size_t>(1, all);
    for (const Gatherer& g : gatherers) {
        if (g.effect->gather.batch_size != nullptr) {
            size = std::min(size, g.effect->gather.batch_size(*g.inputs.own.prepared, bytes));
        }
    }
    return size;
}

}  // namespace

std::vector<Gatherer> make_gatherers(const BakeInputs& bake, const SubjectState& subject,
                                     const Knobs& knobs, const Context& context) {
    std::vector<Gatherer> gatherers;
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        const GatherStep& gather = effect.gather;
        if (subject.effects[e].acts && gather.add != nullptr &&
            (gather.applies == nullptr || gather.applies(subject.layout))) {
            gatherers.push_back({&effect, inputs_of(bake, subject, e, knobs, context)});
        }
    }
    return gatherers;
}

std::uint64_t gather_batches(std::vector<Gatherer>& gatherers, std::span<const BodyPoint> points) {
    std::uint64_t rays = 0;
    for (Gatherer& g : gatherers) {
        if (g.effect->gather.gather_batch != nullptr) {
            g.batch.reset();  // before the next one is made: only one fits into memory
            g.batch = g.effect->gather.gather_batch(g.inputs, points, rays);
        }
    }
    return rays;
}

std::uint64_t gather_receiver(std::span<const Gatherer> gatherers, const Receiver& outside,
                              const BodyPoint& inside, std::size_t place, const DenseRow& row) {
    std::fill(row.values.begin(), row.values.end(), 0.0f);
    std::uint64_t rays = 0;
    for (const Gatherer& g : gatherers) {
        rays += g.effect->gather.add(g.inputs, {outside, inside, g.batch.get(), place}, row);
    }
    return rays;
}

DenseRow shape_row(const RowLayout& layout, std::uint32_t cubemap_size,
                   std::vector<float>& values) {
    values.resize(std::size_t{layout.terms()} * layout.bands() *
                  formats::cubemap_texels(cubemap_size));
    return {values, cubemap_size, layout.terms(), layout.bands()};
}

GatheredRows gather_rows(const RowJob& job, std::vector<Gatherer> gatherers, const Context& context,
                         std::uint64_t& rays) {
    // References, because C++20 lets no lambda of clang 14 capture a structured binding.
    const ReceiverSet& set = job.set;
    const RowLayout& layout = job.layout;
    const RowEncoder encoder = widen(job.encoder);
    constexpr std::size_t kReceiversPerBlock = 64;
    struct Block {
        formats::SparseRows rows;
        LossMeter losses;
        std::uint64_t rays = 0;
    };
    const std::vector<std::uint32_t> order = order_of(set, layout);
    const std::size_t step =
        job.shared != nullptr ? set.size() : batch_size(gatherers, set.size(), job.batch_bytes);
    const std::span<const Gatherer> sources = job.shared != nullptr ? *job.shared : gatherers;
    const auto place_of = [&](std::span<const std::uint32_t> batch, std::size_t v) {
        return job.shared != nullptr ? job.place + batch[v] : v;
    };
    const RowShape shape{layout.terms(), layout.bands(),
                         layout.separate ? TermsSeen::together : TermsSeen::apart};
    formats::SparseRows rows = empty_rows(encoder);
    reserve_rows(rows, encoder, set.size() * shape.terms, shape.bands);
    LossMeter meter(encoder, shape);  // in the order of `order`
    std::vector<BodyPoint> points;
    for (std::size_t begin = 0; begin < set.size() && !context.cancelled(); begin += step) {
        const std::span<const std::uint32_t> batch =
            std::span(order).subspan(begin, std::min(step, set.size() - begin));
        points.clear();
        for (const std::uint32_t i : batch) {
            points.push_back(set.inside[i]);
        }
        if (job.shared == nullptr) rays += gather_batches(gatherers, points);
        for_each_block_in_order(
            batch.size(), kReceiversPerBlock, context,
            [&](Range range) {
                Block block{empty_rows(encoder), {encoder, shape}, 0};
                std::vector<float> values;
                const DenseRow row = shape_row(layout, encoder.selector.cubemap_size, values);
                for (std::size_t v = range.begin; v < range.end; ++v) {
                    block.rays += gather_receiver(sources, set.outside[batch[v]], points[v],
                                                  place_of(batch, v), row);
                    if (job.volumes != nullptr) {
                        block.rays += complete_row(*job.volumes, *job.material, layout,
                                                   {set.outside[batch[v]], points[v]}, row);
                    }
                    encode_receiver(encoder, row, block.rows);
                    if (job.measures_errors) {
                        block.losses.add(row);
                    }
                }
                return block;
            },
            [&](Range range, const Block& block) {
                formats::append_rows(rows, block.rows);
                meter.append(block.losses);
                rays += block.rays;
                if (context.on_progress) {
                    context.on_progress({"rows", set.first + begin + range.end, job.total});
                }
            });
    }
    gatherers.clear();  // the last batch takes more memory than the rows
    // Rows are missing if the bake was cancelled or if they are too many for one file; the caller
    // checks.
    const bool is_whole = rows.row_offset.size() == set.size() * layout.terms() + 1;
    if (is_whole) rows = share_rows(std::move(rows), shape, job.encoder);
    std::vector<float> errors(job.measures_errors && is_whole ? set.size() : 0);
    if (!errors.empty()) {
        const std::vector<RowLoss> losses = meter.losses(rows);
        for (std::size_t i = 0; i < losses.size(); ++i) {
            errors[order[i]] = losses[i].error();
        }
    }
    if (is_whole && layout.translucent) rows = as_given(std::move(rows), order, layout);
    return {std::move(rows), std::move(errors)};
}

void forget_samples(SubjectState& subject) {
    for (EffectState& effect : subject.effects) {
        effect.samples.reset();
        effect.prepared.reset();
    }
}

// One subject at a time, so that samples of one medium alone are in memory.
std::vector<std::vector<float>> rows_of_points(const BakeInputs& bake, const Knobs& knobs,
                                               const Context& context, SubjectState& subject,
                                               std::span<const Receiver> outside,
                                               std::span<const BodyPoint> inside,
                                               std::uint64_t& rays) {
    std::vector<SubjectState> alone;
    alone.push_back(std::move(subject));
    std::vector<std::vector<float>> rows(outside.size());
    for (std::vector<float>& row : rows) {
        shape_row(alone.front().layout, knobs.cubemap_size, row);
    }
    StageLog unlisted;
    // Samples serve these points alone.
    const ReceiverSet points{.material = alone.front().material,
                             .outside = {outside.begin(), outside.end()},
                             .inside = {inside.begin(), inside.end()}};
    BakeInputs asked = bake;
    asked.receivers = std::span(&points, 1);
    run_step(Step::samples, asked, knobs, context, alone, unlisted);
    run_step(Step::prepare, asked, knobs, context, alone, unlisted);
    for (const StageReport& stage : unlisted) {
        rays += stage.rays;
    }
    if (!context.cancelled()) {
        std::vector<Gatherer> gatherers = make_gatherers(bake, alone.front(), knobs, context);
        rays += gather_batches(gatherers, inside);
        constexpr std::size_t kBlock = 16;
        for_each_block_in_order(
            rows.size(), kBlock, context,
            [&](Range range) {
                std::uint64_t traced = 0;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    const DenseRow row =
                        shape_row(alone.front().layout, knobs.cubemap_size, rows[i]);
                    traced += gather_receiver(gatherers, outside[i], inside[i], i, row);
                }
                return traced;
            },
            [&](Range, std::uint64_t traced) { rays += traced; });
    }
    forget_samples(alone.front());
    subject = std::move(alone.front());
    return rows;
}

}  // namespace opaline::bake
