#include "bake/multiple/sample_transport.h"

#include <array>

#include "bake/base/ordered_parallel.h"
#include "bake/scattering/fresnel.h"
#include "bake/visibility/irradiance_transport.h"
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

}  // namespace

SampleTransport bake_sample_transport(const RayScene& rays, std::span<const SurfaceSample> samples,
                                      const SampleOptions& options,
                                      std::span<const std::span<const float>> lights,
                                      const Context& context) {
    const std::uint32_t n = options.cubemap_size;
    const std::array<DirectionSet, 4> directions{
        make_sparse_direction_set(n, 0), make_sparse_direction_set(n, 1),
        make_sparse_direction_set(n, 2), make_sparse_direction_set(n, 3)};
    const std::vector<float> transmittance = tabulate_transmittance(options.eta);
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    SampleTransport result;
    for_each_block_in_order(
        samples.size(), 64, context,
        [&](Range range) {
            SampleTransport part;
            std::vector<float> dense(formats::cubemap_texels(n));
            for (std::size_t s = range.begin; s < range.end; ++s) {
                part.rays += gather_irradiance(rays, directions[s % 4], samples[s].receiver, dense,
                                               transmittance);
                double mean = 0;
                for (std::size_t j = 0; j < dense.size(); ++j) {
                    mean += static_cast<double>(dense[j]) * solid_angle[j % solid_angle.size()];
                }
                part.mean.push_back(static_cast<float>(mean / (4 * 3.14159265358979323846)));
                formats::haar_forward_cube(std::span<float>(dense), n);
                for (const std::span<const float> light : lights) {
                    double sum = 0;
                    for (std::size_t k = 0; k < dense.size(); ++k) {
                        sum += static_cast<double>(dense[k]) * static_cast<double>(light[k]);
                    }
                    part.response.push_back(sum);
                }
                append_truncated(part.rows, dense, options.kept);
            }
            return part;
        },
        [&](Range range, const SampleTransport& part) {
            append_vectors(result.rows, part.rows);
            result.mean.insert(result.mean.end(), part.mean.begin(), part.mean.end());
            result.response.insert(result.response.end(), part.response.begin(),
                                   part.response.end());
            result.rays += part.rays;
            if (context.on_progress) {
                context.on_progress({"samples", range.end, samples.size()});
            }
        });
    return result;
}

}  // namespace opaline::bake
