#include "runtime/volumes/relight_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "formats/opal/spherical_harmonics.h"
#include "runtime/parallel.h"
#include "runtime/volumes/moment_lights.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;
using formats::VolumeRecord;

constexpr float kY0 = 0.2820947918f;  // Y_0 = 1 / sqrt(4 pi)

// Nodes per block: a moment light stays in the cache while it meets all of them.
constexpr std::uint32_t kBlock = 256;

float finite(float x) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return std::isnan(x) ? 0.0f : std::clamp(x, -kLargest, kLargest);
}
Rgb finite(Rgb c) {
    return {finite(c.r), finite(c.g), finite(c.b)};
}

// What is shown of a volume.
struct Shown {
    std::uint32_t single = 0, multiple = 0;  ///< K_s and K_m

    Shown(const VolumeRecord& record, TermSet terms)
        : single(has_any(terms, TermSet::volume_single) ? record.single_terms : 0),
          multiple(has_any(terms, TermSet::volume_multiple) ? record.multiple_terms : 0) {}
};

// Everything that the blocks of a volume share.
struct Job {
    const formats::VolumesView& volumes;
    const VolumeRecord& record;
    const LightVector& light;
    std::span<const LightVector> moment_light;
    Shown shown;
    std::uint32_t terms;  ///< K
    DotPath path;
};

// (-1)^l m_l by k.
std::array<float, formats::kMaxHarmonics> phase_factors(const VolumeRecord& record) {
    std::array<float, formats::kMaxHarmonics> factor{};
    for (std::size_t l = 0, k = 0; l < formats::kMaxVolumeMoments; ++l) {
        for (std::size_t m = 0; m < 2 * l + 1; ++m) {
            factor[k++] = (l % 2 == 0 ? 1.0f : -1.0f) * record.moment[l];
        }
    }
    return factor;
}

void add_single(const Job& job, std::uint32_t first, std::uint32_t end, std::span<Rgb> out) {
    const auto factor = phase_factors(job.record);
    for (std::uint32_t k = 0; k < job.shown.single; ++k) {
        for (std::uint32_t node = first; node < end; ++node) {
            Rgb moment;
            dot_rows(job.volumes.rows, job.record.rows(), job.moment_light[k],
                     node * job.record.terms(), {&moment, 1}, job.path);
            Rgb& c = out[std::size_t{node - first} * job.terms + k];
            c = c + factor[k] * moment;
        }
    }
}

void add_multiple(const Job& job, std::uint32_t first, std::uint32_t end, std::span<Rgb> out) {
    if (job.shown.multiple == 0) return;
    std::array<Rgb, formats::kMaxHarmonics> product;
    const auto own = std::span<Rgb>(product).first(job.shown.multiple);
    const float scale = job.shown.multiple == 1 ? 1.0f / kY0 : 1.0f;
    for (std::uint32_t node = first; node < end; ++node) {
        dot_rows(job.volumes.rows, job.record.rows(), job.light, node * job.record.terms() + 1, own,
                 job.path);
        for (std::uint32_t k = 0; k < job.shown.multiple; ++k) {
            Rgb& c = out[std::size_t{node - first} * job.terms + k];
            c = c + scale * own[k];
        }
    }
}

}  // namespace

VolumeLight relight_volumes(const formats::VolumesView& volumes, const LightVector& light,
                            const RelightVolumesOptions& options) {
    VolumeLight result;
    std::size_t size = 0;
    std::uint32_t moments = 0;
    for (const VolumeRecord& record : volumes.records) {
        const Shown shown(record, options.terms);
        const std::uint32_t terms = std::max(shown.single, shown.multiple);
        result.part.push_back({terms, size});
        size += std::size_t{record.node_count} * terms;
        moments = std::max(moments, shown.single);
    }
    result.coefficient.resize(size);
    const auto moment_lights = make_moment_lights(light, moments, options.threads);
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const VolumeRecord& record = volumes.records[v];
        const std::uint32_t terms = result.part[v].terms;
        const Job job{volumes, record,      light, moment_lights, {record, options.terms},
                      terms,   options.path};
        for_ranges(record.node_count, kBlock, options.threads,
                   [&](std::uint32_t first, std::uint32_t end) {
                       const std::span<Rgb> out =
                           std::span<Rgb>(result.coefficient)
                               .subspan(result.part[v].first + std::size_t{first} * terms,
                                        std::size_t{end - first} * terms);
                       add_single(job, first, end, out);
                       add_multiple(job, first, end, out);
                       std::ranges::transform(out, out.begin(), [](Rgb c) { return finite(c); });
                   });
    }
    return result;
}

std::vector<Rgb> node_radiance(const formats::VolumesView& volumes, const VolumeLight& light,
                               std::size_t volume, const std::optional<formats::Vec3>& eye) {
    const VolumeRecord& record = volumes.records[volume];
    const auto& m = record.to_world;
    const std::uint32_t terms = light.part[volume].terms;
    std::vector<Rgb> radiance(record.node_count);
    if (terms == 0) return radiance;
    for (std::uint32_t i = 0; i < record.node_count; ++i) {
        const auto c = light.coefficients(volume, i);
        std::array<float, formats::kMaxHarmonics> h{kY0};
        std::uint32_t shown = 1;
        if (eye) {
            const formats::NodeVoxel node = volumes.node[record.first_node + i];
            const auto x = static_cast<float>(node[0]), y = static_cast<float>(node[1]),
                       z = static_cast<float>(node[2]);
            const formats::Vec3 to_eye =
                *eye - formats::Vec3{m[0] * x + m[1] * y + m[2] * z + m[3],
                                     m[4] * x + m[5] * y + m[6] * z + m[7],
                                     m[8] * x + m[9] * y + m[10] * z + m[11]};
            // From the node itself there is no direction: the mean, as without an eye.
            if (const float norm = length(to_eye); norm > 0 && std::isfinite(norm)) {
                formats::eval_spherical_harmonics((1 / norm) * to_eye,
                                                  std::span<float>(h).first(terms));
                shown = terms;
            }
        }
        Rgb sum;
        for (std::uint32_t k = 0; k < shown; ++k) {
            sum = sum + h[k] * c[k];
        }
        sum = finite(sum);
        radiance[i] = {std::max(0.0f, sum.r), std::max(0.0f, sum.g), std::max(0.0f, sum.b)};
    }
    return radiance;
}

}  // namespace opaline::runtime
