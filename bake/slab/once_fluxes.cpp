#include "bake/slab/once_fluxes.h"

#include <cmath>

#include "bake/slab/low_orders.h"
#include "bake/slab/phase_kernels.h"
#include "bake/slab/streams.h"

namespace opaline::bake {

std::vector<OnceFluxes> scatter_once(const SlabMedium& medium, std::span<const double> depths,
                                     std::span<const double> cosines, int streams) {
    const Streams directions = make_streams(streams, cosines);
    const PhaseKernels kernels = make_phase_kernels(medium, directions, 0, streams);
    const Eigen::VectorXd flux = directions.flux();
    std::vector<OnceFluxes> all;
    for (const double depth : depths) {
        OnceFluxes fluxes;
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            const double light = cosines[i], path = depth / light;
            const Eigen::Index row = streams + static_cast<Eigen::Index>(i);
            double reflected = 0, transmitted = 0;
            for (Eigen::Index k = 0; k < streams; ++k) {
                const double view = directions.cosine[k], share = flux[k] / (4 * light);
                reflected += share * kernels.backward(row, k) * reflected_once(depth, light, view);
                transmitted +=
                    share * kernels.forward(row, k) * transmitted_once(depth, light, view);
            }
            fluxes.reflected.push_back(medium.albedo * reflected);
            // An event of the peak leaves the light straight.
            fluxes.transmitted.push_back(medium.albedo *
                                         (transmitted + kernels.peak * path * std::exp(-path)));
        }
        all.push_back(std::move(fluxes));
    }
    return all;
}

}  // namespace opaline::bake
