#include "bake/exchange/solve_bounces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kTexels = 6 * kBounceCubemap * kBounceCubemap;  // of the sky's rows
constexpr std::uint32_t kMostBounces = 64;
// A bounce of less of the light than this is the last one, where what follows it is less as well.
constexpr double kLeastShare = 1e-3;

// Scatterers and what they make of light.
struct Field {
    const LightInputs& inputs;
    std::span<const Scatterer> scatterers;
    ScattererLight& light;

    BounceSpace space() const { return {inputs.bake.scene, inputs.bake.rays, inputs.layouts}; }
    bool passes_light(std::size_t i) const {
        return inputs.bake.scene.materials[scatterers[i].material].sheet.has_value();
    }
};

// Plane by plane, of so many columns.
void add_scaled(std::span<const float> from, const BandColour& factor, std::size_t columns,
                std::span<float> to) {
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k] += factor[k / columns] * from[k];
    }
}

// Whether nothing of light in a body is absorbed, band by band.
std::array<bool, 3> absorbs_nothing(const formats::Medium& medium) {
    return {medium.sigma_a.r == 0, medium.sigma_a.g == 0, medium.sigma_a.b == 0};
}

// What crosses a medium straight may not be more than what enters and does not scatter: `scattered`
// is exitance by irradiance 1 everywhere. Without absorption it is all of that, and the factor
// makes up for the two's quadratures.
BandColour share_of_crossing(const formats::Medium& medium, const BandColour& scattered,
                             const std::array<double, 3>& all) {
    constexpr double kMost = 2;
    const double enters = 1 - fresnel_moments(double{medium.eta}).external;
    const std::array<bool, 3> keeps_all = absorbs_nothing(medium);
    BandColour share{};
    for (std::size_t b = 0; b < share.size(); ++b) {
        const double left = std::max(0.0, enters - double{scattered[b]});
        const double fits = all[b] > 0 ? left / all[b] : 0;
        share[b] = static_cast<float>(std::min(fits, keeps_all[b] ? kMost : 1.0));
    }
    return share;
}

// `scattered`: MediumAnswer::sum_of the scatterer's patch.
void weigh_through(const Field& field, const BounceTree& tree, const CrossingViews& crossing,
                   std::size_t i, const BandColour& scattered, Arrivals& arrivals,
                   std::uint64_t& rays) {
    const Scatterer& s = field.scatterers[i];
    const std::vector<float> of_sky = field.light.crossing.row(i);
    double sum = 0;
    std::array<double, 3> by_band{}, all{};
    for (std::size_t b = 0; b < all.size(); ++b) {
        all[b] = double{even_share(
            std::span(of_sky).subspan(b < field.light.bands ? b * kTexels : 0, kTexels))};
        for (const SurfaceView& view : crossing.views) {
            all[b] += double{view.weight[b]};
        }
    }
    for (const SeenNode& seen :
         find_seen(field.space(), tree, crossing.views, crossing.solid_angle, rays)) {
        std::array<float, 3> weight = crossing.views[seen.view].weight;
        weight[0] *= seen.share.r;
        weight[1] *= seen.share.g;
        weight[2] *= seen.share.b;
        const float mean = (weight[0] + weight[1] + weight[2]) / 3;
        if (!arrivals.through.empty() && arrivals.through.back().node == seen.node) {
            arrivals.through.back().weight += mean;
        } else {
            arrivals.through.push_back({seen.node, mean});
        }
        sum += double{mean};
        for (std::size_t b = 0; b < by_band.size(); ++b) {
            by_band[b] += double{weight[b]};
        }
    }
    const formats::Medium& medium = *field.inputs.bake.scene.materials[s.material].medium;
    const BandColour share = share_of_crossing(medium, scattered, all);
    const std::array<float, 3> albedo{s.albedo.diffuse.r, s.albedo.diffuse.g, s.albedo.diffuse.b};
    BandColour sky_share{};
    for (std::size_t b = 0; b < by_band.size(); ++b) {
        arrivals.of_through[b] =
            sum > 0 ? albedo[b] * share[b] * static_cast<float>(by_band[b] / sum) : 0;
        sky_share[b] = albedo[b] * share[b];
    }
    std::vector<float> to = field.light.emitted.row(i);
    add_scaled(of_sky, in_bands(sky_share, field.light.bands), kTexels, to);
    field.light.emitted.set(i, to);
}

// Light of the sky by way of mirrors and through media does not change from bounce to bounce: it
// becomes part of what the scatterer has at once.
void complete_by_mirrored_sky(const Field& field, const BounceTree& tree, std::size_t i,
                              std::uint32_t lobe, Arrivals& arrivals) {
    const std::uint32_t bands = field.light.bands;
    CodedRows& emitted = field.light.emitted;
    const auto take = [&](std::vector<NodeWeight>& weights, const BandColour& answer,
                          bool is_front) {
        const auto sky =
            std::stable_partition(weights.begin(), weights.end(),
                                  [&](const NodeWeight& w) { return !tree.is_sky(w.node); });
        if (sky == weights.end()) return;
        std::vector<float> arriving(emitted.size());
        add_node_rows(tree, std::span(sky, weights.end()), arriving);
        std::vector<float> to = emitted.row(i);
        add_scaled(arriving, in_bands(answer, bands), kTexels, to);
        emitted.set(i, to);
        if (is_front && lobe != formats::kNone) {
            emitted.add(field.scatterers.size() + lobe, 1, arriving);
            emitted.set(field.scatterers.size() + lobe, arriving);
        }
        weights.erase(sky, weights.end());
    };
    take(arrivals.front, field.light.answers.reflect[i], true);
    take(arrivals.back, field.light.answers.transmit[i], false);
}

// The bounces after a last one, by which rows changed.
void add_rest(const SeriesEnd& series, const CodedRows& before, std::size_t columns,
              const Context& context, CodedRows& rows) {
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        rows.count(), kBlock, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                std::vector<float> to = rows.row(i);
                const std::vector<float> from = before.row(i);
                for (std::size_t k = 0; k < to.size(); ++k) {
                    to[k] += static_cast<float>(series.rest(k / columns)) * (to[k] - from[k]);
                }
                rows.set(i, to);
            }
            return 0;
        },
        [](Range, int) {});
}

// Of all rows under an even sky, or all lamps, by band. What an even sky brings is in the average
// of each face.
std::vector<double> sums_of_even(const CodedRows& rows, std::size_t columns) {
    const std::size_t step = columns == kTexels ? kTexels / 6 : 1;
    std::vector<double> sums(rows.size() / columns);
    for (std::size_t i = 0; i < rows.count(); ++i) {
        for (std::size_t k = 0; k < rows.size(); k += step) {
            sums[k / columns] += static_cast<double>(std::abs(rows.value(i, k)));
        }
    }
    return sums;
}

}  // namespace

std::vector<Arrivals> weigh_scatterers(const LightInputs& inputs,
                                       std::span<const Scatterer> scatterers,
                                       std::span<const MediumRows> media, const BounceTree& tree,
                                       ScattererLight& light, std::uint64_t& rays) {
    const Field field{inputs, scatterers, light};
    std::vector<Arrivals> arrivals(field.scatterers.size());
    const BounceGrid grid = make_bounce_grid(kRaysOfScatterer);
    std::vector<BandColour> scattered(arrivals.size());
    std::vector<const CrossingViews*> through(arrivals.size());
    for (std::size_t k = 0; k < media.size(); ++k) {
        const MediumAnswer& answer = field.light.answers.media[k];
        for (std::size_t m = 0; m < media[k].through.size(); ++m) {
            scattered[answer.members[m]] = answer.sum_of(answer.patch[m]);
            through[answer.members[m]] = &media[k].through[m];
        }
    }
    const std::vector<std::uint32_t> lobe = number_lobes(field.scatterers);
    constexpr std::size_t kBlock = 16;
    // The sky is known by many more rays than others are: what these rays meet takes what the sky
    // leaves, so that all shares add up to 1 and no bounce wins or loses light.
    const auto weigh = [&](const Receiver& at, float openness, std::vector<NodeWeight>& weights) {
        const BounceGather gathered = weigh_bounces(
            field.space(), tree, at, grid, field.inputs.knobs.seed, weights, LookUp::nearest);
        for (NodeWeight& w : weights) {
            w.weight *= (1 - openness) / gathered.met;
        }
        return gathered.rays;
    };
    for_each_block_in_order(
        arrivals.size(), kBlock, field.inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const Scatterer& s = field.scatterers[i];
                traced += weigh(s.outside, s.openness, arrivals[i].front);
                if (field.passes_light(i)) {
                    traced += weigh(s.beyond, field.light.open_beyond[i], arrivals[i].back);
                }
                if (!field.inputs.layouts[s.material].translucent) {
                    complete_by_mirrored_sky(field, tree, i, lobe[i], arrivals[i]);
                }
                if (through[i] != nullptr) {
                    weigh_through(field, tree, *through[i], i, scattered[i], arrivals[i], traced);
                }
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return arrivals;
}

SolveReport add_bounces(const Transfer& transfer, const CodedRows& emitted, std::uint32_t bands,
                        BounceTree& tree, const Context& context) {
    const std::size_t size = emitted.size(), columns = size / bands;
    const ScattererAnswers& answers = transfer.answers;
    const std::vector<Arrivals>& arrivals = transfer.arrivals;
    CodedRows leaving = emitted;
    CodedRows arriving = answers.media.empty() ? CodedRows() : leaving;  // of media
    std::vector<std::uint8_t> is_medium(arrivals.size());
    for (const MediumAnswer& answer : answers.media) {
        for (const std::uint32_t i : answer.members) {
            is_medium[i] = 1;
        }
    }
    const std::vector<std::uint32_t> lobe = number_lobes(transfer.scatterers);
    // What neighbours see is mostly the same and still in the cache.
    const std::vector<std::uint32_t> order = tree.neighbours();
    SeriesEnd series;
    series.add(sums_of_even(leaving, columns));
    SolveReport report;
    for (bool is_last = false; !is_last && !context.cancelled(); ++report.bounces) {
        report.remaining = series.remaining();
        is_last = series.is_settled(kLeastShare) || report.bounces + 1 == kMostBounces;
        const CodedRows before = is_last ? leaving : CodedRows();
        tree.set_rows(leaving, context);
        constexpr std::size_t kBlock = 64;
        for_each_block_in_order(
            arrivals.size(), kBlock, context,
            [&](Range range) {
                std::vector<float> row(size);
                for (const std::uint32_t i :
                     std::span(order).subspan(range.begin, range.end - range.begin)) {
                    std::vector<float> to = emitted.row(i);
                    const auto add = [&](std::span<const NodeWeight> from,
                                         const BandColour& share) {
                        if (from.empty()) return;
                        std::ranges::fill(row, 0.0f);
                        add_node_rows(tree, from, row);
                        add_scaled(row, in_bands(share, bands), columns, to);
                    };
                    if (is_medium[i] != 0) {
                        std::ranges::fill(row, 0.0f);
                        add_node_rows(tree, arrivals[i].front, row);
                        arriving.set(i, row);
                    } else {
                        add(arrivals[i].front, answers.reflect[i]);
                        if (lobe[i] != formats::kNone) {
                            // Its own irradiance: `row` is what others send.
                            if (arrivals[i].front.empty()) std::ranges::fill(row, 0.0f);
                            const std::size_t own = arrivals.size() + lobe[i];
                            emitted.add(own, 1, row);
                            leaving.set(own, row);
                        }
                        add(arrivals[i].back, answers.transmit[i]);
                    }
                    add(arrivals[i].through, arrivals[i].of_through);
                    leaving.set(i, to);
                }
                return 0;
            },
            [](Range, int) {});
        for (const MediumAnswer& answer : answers.media) {
            add_answer(answer, transfer.scatterers, arriving, bands, context, leaving);
        }
        if (is_last) {
            add_rest(series, before, columns, context, leaving);
        }
        series.add(sums_of_even(leaving, columns));
    }
    tree.set_rows(leaving, context);
    return report;
}

}  // namespace opaline::bake
