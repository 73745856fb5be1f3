#include "bake/effects/multiple/sample_transport.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/other_light.h"
#include "bake/physics/fresnel.h"
#include "bake/receivers/kd_order.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

std::vector<float> tabulate_transmittance(double eta) {
    if (eta == 1) {
        return {};
    }
    constexpr std::size_t kSteps = 1024;
    std::vector<float> table;
    for (std::size_t i = 0; i <= kSteps; ++i) {
        table.push_back(static_cast<float>(
            fresnel_transmittance(static_cast<double>(i) / static_cast<double>(kSteps), eta)));
    }
    return table;
}

// int Ft(c) 2 c dc, by trapezoids.
float mean_transmittance(std::span<const float> table) {
    if (table.empty()) return 1;
    const auto steps = static_cast<double>(table.size() - 1);
    double sum = static_cast<double>(table.back());
    for (std::size_t i = 1; i + 1 < table.size(); ++i) {
        sum += 2 * static_cast<double>(i) / steps * static_cast<double>(table[i]);
    }
    return static_cast<float>(sum / steps);
}

float mean_over_sphere(std::span<const float> radiance, std::span<const double> solid_angle) {
    double sum = 0;
    for (std::size_t first = 0; first < radiance.size(); first += solid_angle.size()) {
        for (std::size_t j = 0; j < solid_angle.size(); ++j) {
            sum += static_cast<double>(radiance[first + j]) * solid_angle[j];
        }
    }
    return static_cast<float>(sum / (4 * std::numbers::pi));
}

// Columns that are not 0 in all bands.
std::size_t count_filled(std::span<const float> dense, std::size_t texels) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < texels; ++k) {
        bool is_filled = false;
        for (std::size_t at = k; at < dense.size(); at += texels) {
            is_filled = is_filled || dense[at] != 0;
        }
        count += is_filled ? 1 : 0;
    }
    return count;
}

}  // namespace

SampleTransport bake_sample_transport(const RayScene& rays, std::span<const SurfaceSample> samples,
                                      const SampleOptions& options, const Context& context) {
    const std::uint32_t n = options.cubemap_size;
    const bool environment = has_environment(options.light);
    const SharedDirections directions =
        environment ? make_shared_directions(n) : SharedDirections{};
    const std::vector<float> transmittance = tabulate_transmittance(options.eta);
    const std::vector<double> solid_angle =
        environment ? formats::texel_solid_angles(n) : std::vector<double>{};
    const std::size_t texels = formats::cubemap_texels(n);
    const std::size_t together = options.share_rays ? kSamplesPerGroup : 1;
    const float entering = mean_transmittance(transmittance);
    SampleTransport result;
    result.other.bands = options.light == nullptr ? 1 : options.light->bands;
    struct Part {
        SparseVectors::Block rows, other;
        std::vector<float> mean, norm;
        std::uint64_t rays = 0;
    };
    static_assert(SparseVectors::kPerBlock % kSamplesPerGroup == 0);
    const auto gather_environment = [&](std::span<const Receiver> group, std::size_t first,
                                        Part& part) {
        std::vector<float> dense(group.size() * texels);
        part.rays += options.share_rays
                         ? gather_irradiance_together(rays, directions, group, dense, transmittance)
                         : gather_irradiance(rays, directions.sets[first % 4], group.front(), dense,
                                             transmittance);
        for (std::size_t i = 0; i < group.size(); ++i) {
            const std::span<float> own = std::span(dense).subspan(i * texels, texels);
            part.mean.push_back(mean_over_sphere(own, solid_angle));
            formats::haar_forward_cube(own, n);
            part.norm.push_back(norm(own));
            append_truncated(part.rows, own, options.kept, samples[first + i].area);
        }
    };
    const auto gather_nothing = [&](std::size_t count, Part& part) {
        for (std::size_t i = 0; i < count; ++i) {
            part.mean.push_back(0);
            part.norm.push_back(0);
            append_nothing(part.rows);
        }
    };
    const auto gather_other = [&](std::size_t s, float& all, Part& part) {
        std::vector<float> dense(result.other.bands * texels);
        part.rays += add_irradiance(*options.light, {samples[s].receiver, true}, n, dense);
        // Those of the faces come first, whatever they are.
        const std::size_t kept =
            environment ? options.kept_of_light : std::min(texels, count_filled(dense, texels) + 6);
        append_truncated_bands(part.other, dense, result.other.bands, kept,
                               entering * samples[s].area);
        all = std::hypot(all, entering * norm(dense));
    };
    for_each_block_in_order(
        samples.size(), SparseVectors::kPerBlock, context,
        [&](Range range) {
            Part part;
            reserve(part.rows, environment ? std::min<std::size_t>(options.kept, texels) : 0);
            std::vector<Receiver> group;
            for (std::size_t s = range.begin; s < range.end; s += group.size()) {
                group.clear();
                while (group.size() < together && s + group.size() < range.end) {
                    group.push_back(samples[s + group.size()].receiver);
                }
                if (environment) {
                    gather_environment(group, s, part);
                } else {
                    gather_nothing(group.size(), part);
                }
            }
            if (options.light != nullptr) {
                for (std::size_t s = range.begin; s < range.end; ++s) {
                    gather_other(s, part.norm[s - range.begin], part);
                }
            }
            shrink(part.rows);
            return part;
        },
        [&](Range range, Part&& part) {
            result.rows.blocks.push_back(std::move(part.rows));
            if (options.light != nullptr) {
                result.other.blocks.push_back(std::move(part.other));
            }
            result.mean.insert(result.mean.end(), part.mean.begin(), part.mean.end());
            result.norm.insert(result.norm.end(), part.norm.begin(), part.norm.end());
            result.rays += part.rays;
            if (context.on_progress) {
                context.on_progress({"samples", range.end, samples.size()});
            }
        });
    return result;
}

}  // namespace opaline::bake
