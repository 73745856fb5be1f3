#include "bake/effects/multiple/walks/site_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/base/largest.h"
#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/walks/view_fit.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// An exit and the sample whose light it sees.
struct SampleExit {
    std::uint32_t sample = 0;
    std::uint32_t exit = 0;
};

class SiteWalker {
  public:
    SiteWalker(const WalkSpace& space, const ExitLight& light, const ViewFit& view_fit,
               const SiteRowOptions& options)
        : space_(space),
          light_(light),
          options_(options),
          view_fit_(view_fit),
          step_(options.bands == 1 ? 1 : 4),
          dense_(step_ * options.views *
                 std::size_t{formats::cubemap_texels(options.cubemap_size)}) {}

    // The dense rows of one site.
    std::span<float> walk(const WalkStart& start, std::uint32_t site, WalkCounts& counts) {
        std::fill(dense_.begin(), dense_.end(), 0.0f);
        std::uint32_t number = 0;
        exits_.clear();
        seen_.clear();
        ViewLobe mean_seen{};
        WalkCounts own;
        for (WalkGroup group; group.flies_as < space_.bands.size(); ++group.flies_as) {
            for (std::uint32_t w = 0; w < options_.walks_per_site; ++w) {
                WalkRandom random({options_.seed, RandomStage::body_walk, site, number++}, true);
                const glm::vec3 seen =
                    follow_walk(space_, group, start, options_.orders, random, exits_, own);
                if (options_.views > 1) {
                    const ViewLobe lobe = eval_view_lobe(view_fit_, start.normal, seen,
                                                         options_.views > 1 + kFirstDegree);
                    for (std::size_t r = 0; r < lobe.size(); ++r) {
                        mean_seen[r] += lobe[r];
                    }
                    seen_.resize(exits_.size(), lobe);
                }
            }
        }
        scale_exits(own);
        add_exits(1 / static_cast<float>(options_.walks_per_site));
        take_out_mean(mean_seen, static_cast<float>(number));
        counts += own;
        return dense_;
    }

  private:
    // What leaves and what does not add up, band by band, however few the walks.
    void scale_exits(const WalkCounts& counts) {
        for (std::size_t b = 0; b < 3; ++b) {
            const auto factor = static_cast<float>(counts.scale(b, options_.orders.fills_crossed));
            for (WalkExit& exit : exits_) {
                exit.weight[b] *= factor;
            }
        }
    }

    // Its lobes' mean would be 0 over more walks. What it makes of the light that all views have in
    // common is noise.
    void take_out_mean(const ViewLobe& sum, float walks) {
        const std::size_t size = dense_.size() / options_.views;
        for (std::uint32_t view = 1; view < options_.views; ++view) {
            float* const row = &dense_[view * size];
            const float mean = sum[view - 1] / walks;
            for (std::size_t k = 0; k < size; ++k) {
                row[k] -= mean * dense_[k];
            }
        }
    }

    // Exits of one sample are added up before its vector is read.
    void add_exits(float scale) {
        by_sample_.clear();
        for (std::uint32_t e = 0; e < exits_.size(); ++e) {
            by_sample_.push_back({light_.nearest(exits_[e], around_), e});
        }
        std::stable_sort(
            by_sample_.begin(), by_sample_.end(),
            [](const SampleExit& a, const SampleExit& b) { return a.sample < b.sample; });
        const std::size_t size = dense_.size() / options_.views;
        const TexelRow row{std::span(dense_).first(size), step_};
        ExitCells::Cells cells{};
        for (std::size_t i = 0; i < by_sample_.size();) {
            const std::uint32_t sample = by_sample_[i].sample;
            ExitCells::Sums sums{};
            glm::vec4 diffuse(0);  // of exits that count for such light alone
            std::array<std::array<float, 3>, kAllDegrees> views{};  // of rows by view, per band
            for (; i < by_sample_.size() && by_sample_[i].sample == sample; ++i) {
                const std::uint32_t e = by_sample_[i].exit;
                if (exits_[e].is_once) {
                    diffuse += light_.weigh(sample, exits_[e], scale);
                    continue;
                }
                light_.add_exit(sample, exits_[e], scale, sums);
                for (std::size_t r = 0; r + 1 < options_.views; ++r) {
                    for (std::size_t b = 0; b < 3; ++b) {
                        views[r][b] += scale * exits_[e].weight[b] * seen_[e][r];
                    }
                }
            }
            light_.add(sample, sums, row, cells);
            light_.add_diffuse(sample, diffuse, row);
            if (options_.views > 1) {
                light_.add_views(sample, std::span(views).first(options_.views - 1),
                                 {std::span(dense_).subspan(size), step_});
            }
        }
        light_.add_cells(cells, row);
    }

    const WalkSpace& space_;
    const ExitLight& light_;
    const SiteRowOptions& options_;
    const ViewFit& view_fit_;
    std::size_t step_;  // floats per texel
    std::vector<float> dense_;
    std::vector<WalkExit> exits_;
    std::vector<ViewLobe> seen_;  // of each exit, what its walk's view adds to the rows by view
    std::vector<SampleExit> by_sample_;
    std::vector<std::uint32_t> around_;
};

// The entries that matter most to the eye, whatever their band; always the six face averages.
// `row`: four floats per texel, or one with one band.
void append_row(SiteRows::Block& block, std::span<const float> row, std::uint32_t bands,
                std::size_t kept) {
    const std::size_t step = bands == 1 ? 1 : 4, size = row.size() / step, face = size / 6;
    std::vector<float> score(size);
    for (std::size_t k = 0; k < size; ++k) {
        const float* v = &row[step * k];
        score[k] = bands == 1
                       ? std::abs(v[0])
                       : 0.2f * std::abs(v[0]) + 0.7f * std::abs(v[1]) + 0.1f * std::abs(v[2]);
    }
    for (std::size_t k = 0; k < size; k += face) {
        score[k] = std::numeric_limits<float>::max();
    }
    for (const std::uint32_t k : find_largest(score, std::max<std::size_t>(kept, 6))) {
        block.index.push_back(k);
        for (std::size_t b = 0; b < bands; ++b) {
            block.value.push_back(row[step * k + b]);
        }
    }
    block.offset.push_back(static_cast<std::uint32_t>(block.index.size()));
}

}  // namespace

std::vector<WalkStart> make_walk_starts(const WalkSpace& space,
                                        std::span<const SurfaceSample> sites,
                                        const Context& context) {
    std::vector<WalkStart> starts;
    starts.reserve(sites.size());
    for_each_block_in_order(
        sites.size(), 256, context,
        [&](Range range) {
            std::vector<WalkStart> part;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const SurfaceSample& s = sites[i];
                constexpr float kRoundings = 64 * std::numeric_limits<float>::epsilon();
                const glm::vec3 a = glm::abs(s.position);
                float error = kRoundings * std::max({a.x, a.y, a.z});
                if (space.bodies) {
                    error = std::max(error, 2 * space.bodies->touch());
                }
                WalkStart start{s.position - error * s.geometric_normal, s.normal,
                                s.geometric_normal, 1};
                start.shells =
                    std::max(1, count_shells(space, start.position, -s.geometric_normal));
                if (space.bodies) {
                    start.around = bodies_at_start(space, start.position);
                }
                part.push_back(start);
            }
            return part;
        },
        [&](Range, std::vector<WalkStart>&& part) {
            starts.insert(starts.end(), part.begin(), part.end());
        });
    return starts;
}

SiteRows walk_from_sites(const WalkSpace& space, std::span<const WalkStart> starts,
                         const ExitLight& light, const SiteRowOptions& options,
                         const std::function<void(std::size_t, std::span<float>)>& subtract,
                         const Context& context, WalkCounts& counts,
                         std::span<const std::uint8_t> is_read) {
    SiteRows rows;
    rows.bands = options.bands;
    rows.views = options.views;
    const ViewFit view_fit = make_view_fit(static_cast<double>(space.eta));
    struct Part {
        SiteRows::Block block;
        WalkCounts counts;
        std::vector<std::array<float, 3>> scattered;
    };
    for_each_block_in_order(
        starts.size(), SiteRows::kPerBlock, context,
        [&](Range range) {
            Part part;
            SiteWalker walker(space, light, view_fit, options);
            for (std::size_t site = range.begin; site < range.end; ++site) {
                std::array<float, 3>* share = nullptr;
                if (options.counts_scattered) {
                    share = &part.scattered.emplace_back(std::array<float, 3>{1, 1, 1});
                }
                if (!is_read.empty() && is_read[site] == 0) {
                    part.block.offset.insert(part.block.offset.end(), options.views,
                                             part.block.offset.back());
                    continue;
                }
                WalkCounts of_site;
                const std::span<float> own =
                    walker.walk(starts[site], static_cast<std::uint32_t>(site), of_site);
                part.counts += of_site;
                for (std::size_t b = 0; share != nullptr && b < 3; ++b) {
                    (*share)[b] = static_cast<float>(of_site.scattered_share(b));
                }
                const std::size_t size = own.size() / options.views;
                if (subtract) {
                    subtract(site, own.first(size));
                }
                for (std::uint32_t view = 0; view < options.views; ++view) {
                    append_row(part.block, own.subspan(view * size, size), options.bands,
                               view == 0 ? options.kept : options.kept / 4);
                }
            }
            part.block.index.shrink_to_fit();
            part.block.value.shrink_to_fit();
            return part;
        },
        [&](Range range, Part&& part) {
            rows.blocks.push_back(std::move(part.block));
            counts += part.counts;
            rows.scattered.insert(rows.scattered.end(), part.scattered.begin(),
                                  part.scattered.end());
            if (context.on_progress) {
                context.on_progress({"walks", range.end, starts.size()});
            }
        });
    return rows;
}

void add_site_row(const SiteRows& rows, std::size_t site, std::uint32_t view, glm::vec3 weight,
                  std::span<float> rgbx) {
    const SiteRows::Block& block = rows.blocks[site / SiteRows::kPerBlock];
    const std::size_t i = site % SiteRows::kPerBlock * rows.views + view;
    for (std::size_t k = block.offset[i]; k < block.offset[i + 1]; ++k) {
        if (rows.bands == 1) {
            rgbx[block.index[k]] += weight.x * block.value[k];
            continue;
        }
        float* const to = &rgbx[4 * std::size_t{block.index[k]}];
        const float* const from = &block.value[3 * k];
        to[0] += weight.x * from[0];
        to[1] += weight.y * from[1];
        to[2] += weight.z * from[2];
    }
}

}  // namespace opaline::bake
