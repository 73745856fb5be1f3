#include "bake/exchange/bounce_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/site_light.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kTexels = 6 * kBounceCubemap * kBounceCubemap;
constexpr std::uint32_t kMostBounces = 64;
// A bounce of less of the light than this is the last one, where what follows it is less as well.
constexpr double kLeastShare = 1e-3;

// Scatterers and what they make of light.
struct Field {
    const LightInputs& inputs;
    std::span<const Scatterer> scatterers;
    ScattererLight& light;

    bool passes_light(std::size_t i) const {
        return inputs.bake.scene.materials[scatterers[i].material].sheet.has_value();
    }
};

// Plane by plane.
void add_scaled(std::span<const float> from, const BandColour& factor, std::span<float> to) {
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k] += factor[k / kTexels] * from[k];
    }
}

// What reaches a scatterer from others, on its side and, through a sheet, on the other one; and
// what of others' radiosity crosses its medium to it, as the mean of the bands.
struct Arrivals {
    std::vector<NodeWeight> front, back, through;
    BandColour of_through{};  // times `through`, by band
};

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
    for (const SeenNode& seen : find_seen(field.inputs.bake.scene, field.inputs.bake.rays, tree,
                                          crossing.views, crossing.solid_angle, rays)) {
        std::array<float, 3> weight = crossing.views[seen.view].weight;
        for (float& w : weight) {
            w *= seen.share;
        }
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
    if (field.light.bands == 1) {
        const auto grey = [](const BandColour& c) {
            return BandColour{formats::luminance({c[0], c[1], c[2]})};
        };
        arrivals.of_through = grey(arrivals.of_through);
        sky_share = grey(sky_share);
    }
    std::vector<float> to = field.light.emitted.row(i);
    add_scaled(of_sky, sky_share, to);
    field.light.emitted.set(i, to);
}

std::vector<Arrivals> weigh_scatterers(const Field& field, std::span<const MediumRows> media,
                                       const BounceTree& tree, std::uint64_t& rays) {
    std::vector<Arrivals> arrivals(field.scatterers.size());
    const BounceGrid grid = make_bounce_grid(kRaysOfScatterer);
    std::vector<BandColour> scattered(arrivals.size());
    std::vector<const CrossingViews*> through(arrivals.size());
    for (std::size_t k = 0; k < media.size(); ++k) {
        const MediumAnswer& answer = field.light.answers[k];
        for (std::size_t m = 0; m < media[k].through.size(); ++m) {
            scattered[answer.members[m]] = answer.sum_of(answer.patch[m]);
            through[answer.members[m]] = &media[k].through[m];
        }
    }
    constexpr std::size_t kBlock = 16;
    // The sky is known by many more rays than others are: what these rays meet takes what the sky
    // leaves, so that all shares add up to 1 and no bounce wins or loses light.
    const auto weigh = [&](const Receiver& at, float openness, std::vector<NodeWeight>& weights) {
        const BounceGather gathered =
            weigh_bounces(field.inputs.bake.scene, field.inputs.bake.rays, tree, at, grid,
                          field.inputs.knobs.seed, weights, LookUp::nearest);
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
                if (through[i] != nullptr) {
                    weigh_through(field, tree, *through[i], i, scattered[i], arrivals[i], traced);
                }
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return arrivals;
}

// The bounces after a last one, by which rows changed.
void add_rest(const SeriesEnd& series, const CodedRows& before, const Context& context,
              CodedRows& rows) {
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        rows.count(), kBlock, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                std::vector<float> to = rows.row(i);
                const std::vector<float> from = before.row(i);
                for (std::size_t k = 0; k < to.size(); ++k) {
                    to[k] += static_cast<float>(series.rest(k / kTexels)) * (to[k] - from[k]);
                }
                rows.set(i, to);
            }
            return 0;
        },
        [](Range, int) {});
}

// Of all rows under an even sky, by band.
std::vector<double> sums_of_even(const CodedRows& rows) {
    std::vector<double> sums(rows.size() / kTexels);
    for (std::size_t i = 0; i < rows.count(); ++i) {
        for (std::size_t k = 0; k < rows.size(); k += kTexels / 6) {
            sums[k / kTexels] += static_cast<double>(std::abs(rows.value(i, k)));
        }
    }
    return sums;
}

// B = B_0 + rho gather(B), bounce by bounce: the tree's rows become all light that leaves. The last
// bounce stands for those that would follow it as well.
SolveReport add_bounces(const Field& field, std::span<const Arrivals> arrivals, BounceTree& tree) {
    const std::size_t size = field.light.row_size();
    CodedRows leaving = field.light.emitted;
    CodedRows arriving = field.light.answers.empty() ? CodedRows() : leaving;  // of media
    const auto is_medium = [&](std::size_t i) {
        return field.inputs.layouts[field.scatterers[i].material].translucent;
    };
    // What neighbours see is mostly the same and still in the cache.
    const std::vector<std::uint32_t> order = tree.neighbours();
    SeriesEnd series;
    series.add(sums_of_even(leaving));
    SolveReport report;
    for (bool is_last = false; !is_last && !field.inputs.context.cancelled(); ++report.bounces) {
        report.remaining = series.remaining();
        report.ratio = series.largest_ratio();
        is_last = series.is_settled(kLeastShare) || report.bounces + 1 == kMostBounces;
        const CodedRows before = is_last ? leaving : CodedRows();
        tree.set_rows(leaving, field.inputs.context);
        constexpr std::size_t kBlock = 64;
        for_each_block_in_order(
            arrivals.size(), kBlock, field.inputs.context,
            [&](Range range) {
                std::vector<float> row(size);
                for (const std::uint32_t i :
                     std::span(order).subspan(range.begin, range.end - range.begin)) {
                    std::vector<float> to = field.light.emitted.row(i);
                    const auto add = [&](std::span<const NodeWeight> from,
                                         const BandColour& share) {
                        if (from.empty()) return;
                        std::ranges::fill(row, 0.0f);
                        add_node_rows(tree, from, row);
                        add_scaled(row, share, to);
                    };
                    if (is_medium(i)) {
                        std::ranges::fill(row, 0.0f);
                        add_node_rows(tree, arrivals[i].front, row);
                        arriving.set(i, row);
                    } else {
                        add(arrivals[i].front, field.light.reflect[i]);
                        add(arrivals[i].back, field.light.transmit[i]);
                    }
                    add(arrivals[i].through, arrivals[i].of_through);
                    leaving.set(i, to);
                }
                return 0;
            },
            [](Range, int) {});
        for (const MediumAnswer& answer : field.light.answers) {
            add_answer(answer, field.scatterers, arriving, field.light.bands, field.inputs.context,
                       leaving);
        }
        if (is_last) {
            add_rest(series, before, field.inputs.context, leaving);
        }
        series.add(sums_of_even(leaving));
    }
    tree.set_rows(leaving, field.inputs.context);
    return report;
}

}  // namespace

std::uint32_t count_rays_of_site(std::uint32_t of_receiver) {
    constexpr double kShare = 0.25;
    return count_bounce_rays(kShare * of_receiver);
}

std::size_t count_scatterers(std::uint32_t rays_of_receiver) {
    constexpr double kPerRay = 64, kFewest = 1024, kMost = 24576;
    return static_cast<std::size_t>(std::clamp(kPerRay * rays_of_receiver, kFewest, kMost));
}

std::shared_ptr<const BounceLight> solve_exchange(const LightInputs& inputs, ExchangePoints points,
                                                  std::span<const MediumRows> media,
                                                  std::uint64_t& rays, Bounces bounces) {
    const std::uint32_t count = inputs.rays_of_receiver;
    const std::span<const Scatterer> scatterers = points.scatterers;
    if (scatterers.empty()) return nullptr;
    const bool is_coloured =
        bounces == Bounces::none || std::ranges::any_of(inputs.layouts, &RowLayout::coloured);
    ScattererLight own = light_scatterers(inputs, points, media, is_coloured ? 3 : 1, rays);
    const Field field{inputs, scatterers, own};
    auto light = std::make_shared<BounceLight>(
        BounceLight{.scene = inputs.bake.scene,
                    .rays = inputs.bake.rays,
                    .cubemap_size = kBounceCubemap,
                    .bands = own.bands,
                    .seed = inputs.knobs.seed,
                    .layouts = {inputs.layouts.begin(), inputs.layouts.end()},
                    .tree = BounceTree(scatterers, inputs.layouts.size(), field.light.row_size()),
                    .of_site = make_bounce_grid(count_rays_of_site(count)),
                    .of_receiver = make_cut_grid(count),
                    .of_averaged = make_bounce_grid(kRaysOfAveraged),
                    .sites = {},
                    .site_rows = {}});
    if (bounces == Bounces::all) {
        const std::vector<Arrivals> arrivals = weigh_scatterers(field, media, light->tree, rays);
        light->report = add_bounces(field, arrivals, light->tree);
        light_sites(inputs, *light, rays);
        return light;
    }
    if (own.crossing.count() > 0) {
        weigh_scatterers(field, media, light->tree, rays);  // adds what crosses media to `emitted`
    }
    light->tree.set_rows(own.emitted, inputs.context);
    return light;
}

std::vector<SeenNode> find_seen(const formats::Scene& scene, const RayScene& rays,
                                const BounceTree& tree, std::span<const SurfaceView> views,
                                double solid_angle, std::uint64_t& traced) {
    constexpr std::size_t kLanes = RayPacket::kSize;
    constexpr float kGrazing = 1e-2f;
    std::vector<SeenNode> seen;
    std::vector<MirroredRay> mirrored;
    seen.reserve(views.size());
    for (std::size_t begin = 0; begin < views.size(); begin += kLanes) {
        const std::span<const SurfaceView> some =
            views.subspan(begin, std::min(kLanes, views.size() - begin));
        const PacketHits hits = closest_of(rays, some);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const SeenSide side = hits.hit[i] != 0 ? side_of_hit(scene, hits, i) : SeenSide{};
            if (!side.is_seen) continue;
            const float t = hits.distance[i];
            const float area =
                static_cast<float>(solid_angle) * t * t / std::max(side.cosine, kGrazing);
            const glm::vec3 y = some[i].origin + t * some[i].direction;
            const auto view = static_cast<std::uint32_t>(begin + i);
            const MirroredRay ray = mirror(
                scene, {y, some[i].direction, hits.error[i], hits.material[i], side}, 1, view);
            const std::uint32_t node =
                tree.find(y, {hits.material[i], side.behind, side.normal}, area);
            if (node != formats::kNone) {
                seen.push_back(
                    {node, view, share_of_radiosity(scene.materials[hits.material[i]], ray.share)});
            }
            if (ray.share > 0) {
                mirrored.push_back(ray);
            }
        }
    }
    std::vector<MirroredNode> found;
    traced += views.size() + follow_mirrored(scene, rays, tree, std::move(mirrored), found);
    for (const MirroredNode& other : found) {
        seen.push_back({other.node, other.number, other.share});
    }
    std::ranges::stable_sort(seen, {}, &SeenNode::node);
    return seen;
}

std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows) {
    if (views.empty() || light.rays.is_empty()) return 0;
    std::uint64_t traced = 0;
    const std::vector<SeenNode> seen =
        find_seen(light.scene, light.rays, light.tree, views, solid_angle, traced);
    const std::size_t texels = light.tree.row_size() / light.bands;
    const std::size_t terms = views.front().factor.size();
    std::vector<float> planes(terms * bands * texels), factor(terms * bands);
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        std::ranges::fill(factor, 0.0f);
        for (end = begin; end < seen.size() && seen[end].node == seen[begin].node; ++end) {
            const SurfaceView& view = views[seen[end].view];
            for (std::size_t k = 0; k < factor.size(); ++k) {
                factor[k] += std::numbers::inv_pi_v<float> * view.factor[k / bands] *
                             view.weight[k % bands] * seen[end].share;
            }
        }
        const std::vector<float> row = light.tree.rows().row(seen[begin].node);
        for (std::size_t k = 0; k < factor.size(); ++k) {
            const float* const from =
                &row[std::min<std::size_t>(k % bands, light.bands - 1) * texels];
            float* const to = &planes[k * texels];
            for (std::size_t t = 0; t < texels; ++t) {
                to[t] += factor[k] * from[t];
            }
        }
    }
    add_to_finer(planes, light.cubemap_size, rows, cubemap_size,
                 static_cast<std::uint32_t>(terms * bands));
    return traced;
}

std::uint64_t add_bounced(const BounceLight& light, const LitPoint& point,
                          std::uint32_t cubemap_size, std::span<float> rows) {
    const BounceGrid& own = point.is_averaged ? light.of_averaged : light.of_receiver;
    std::vector<float> sum(light.tree.row_size());
    const float most = light.most_noise(own);
    std::vector<SiteWeight> around;
    std::uint64_t rays = 0;
    if (light.sites.weigh(point.receiver, most, around)) {
        for (const SiteWeight& w : around) {
            light.site_rows.add(w.site, w.weight, sum);
        }
    } else {
        std::vector<NodeWeight> weights;
        rays = weigh_bounces(light.scene, light.rays, light.tree, point.receiver, own, light.seed,
                             weights)
                   .rays;
        add_node_rows(light.tree, weights, sum);
    }
    add_to_finer(sum, light.cubemap_size, rows, cubemap_size, light.bands);
    return rays;
}

}  // namespace opaline::bake
