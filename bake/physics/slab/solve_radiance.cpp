#include "bake/physics/slab/solve_radiance.h"

#include <cassert>
#include <cmath>
#include <complex>

#include "bake/physics/slab/layer.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

/// Calls body(row, column, place in SlabRadiance) for every view and light.
template <class Body>
void for_each_pair(const SlabRadianceRequest& request, std::size_t m, const SlabRadiance& sum,
                   const Body& body) {
    const auto first_light = static_cast<Eigen::Index>(request.streams);
    const auto first_view = first_light + static_cast<Eigen::Index>(sum.incidents);
    for (std::size_t v = 0; v < sum.views; ++v) {
        for (std::size_t i = 0; i < sum.incidents; ++i) {
            body(first_view + static_cast<Eigen::Index>(v),
                 first_light + static_cast<Eigen::Index>(i),
                 (m * sum.views + v) * sum.incidents + i);
        }
    }
}

/// Real part of `weight` times the kernels between views and incidents, added to mode m.
template <class Scalar>
void add_kernels(const Layer<Scalar>& layer, Scalar weight, const SlabRadianceRequest& request,
                 std::size_t m, SlabRadiance& sum) {
    for_each_pair(request, m, sum, [&](Eigen::Index row, Eigen::Index column, std::size_t at) {
        sum.reflected[at] += std::real(weight * layer.reflect(row, column));
        sum.transmitted[at] += std::real(weight * layer.transmit(row, column));
    });
}

/// Takes away the first order, in closed form, of the phase function that the streams resolve. An
/// event of the peak alone leaves the light straight: no kernel has it.
void subtract_once(const PhaseKernels& kernels, double albedo, const SlabRadianceRequest& request,
                   std::size_t m, SlabRadiance& sum) {
    for_each_pair(request, m, sum, [&](Eigen::Index row, Eigen::Index column, std::size_t at) {
        const double light = request.lights[at % sum.incidents];
        const double view = request.view[at / sum.incidents % sum.views];
        const double depth = sum.optical_depth, scale = albedo / (4 * light);
        sum.reflected[at] -=
            scale * kernels.backward(row, column) * reflected_once(depth, light, view);
        sum.transmitted[at] -=
            scale * kernels.forward(row, column) * transmitted_once(depth, light, view);
    });
}

}  // namespace

std::vector<SlabRadiance> solve_slab_radiance(const SlabMedium& medium,
                                              const SlabRadianceRequest& request) {
    assert(request.modes >= 1 && request.first_order >= 1);
    std::vector<double> cosines = request.lights;
    cosines.insert(cosines.end(), request.view.begin(), request.view.end());
    const Streams streams = make_streams(request.streams, cosines);
    const std::size_t size = request.modes * request.view.size() * request.lights.size();
    std::vector<SlabRadiance> all;
    for (unsigned j = 0; j <= request.halvings; ++j) {
        all.push_back({std::ldexp(request.optical_depth, -static_cast<int>(j)),
                       request.lights.size(), request.view.size(), request.modes,
                       std::vector<double>(size, 0.0), std::vector<double>(size, 0.0)});
    }
    const AlbedoCircle circle(request.first_order);
    for (unsigned m = 0; m < request.modes; ++m) {
        const PhaseKernels kernels =
            make_phase_kernels(medium, streams, static_cast<int>(m),
                               request.streams + static_cast<Eigen::Index>(request.lights.size()));
        double_up(kernels, streams, medium.albedo, request.optical_depth, request.halvings,
                  [&](unsigned j, const Layer<double>& layer) {
                      add_kernels(layer, 1.0, request, m, all[j]);
                  });
        for (SlabRadiance& radiance : all) {
            if (request.first_order > 1) {
                subtract_once(kernels, medium.albedo, request, m, radiance);
            }
        }
        // Less the orders between the first and the one asked for.
        for (unsigned k = 0; request.first_order > 2 && k < circle.count(); ++k) {
            std::complex<double> weight = 0;
            for (unsigned n = 2; n < request.first_order; ++n) {
                weight -= circle.weight(k, n) * std::pow(medium.albedo, n);
            }
            double_up(kernels, streams, circle.albedo(k), request.optical_depth, request.halvings,
                      [&](unsigned j, const Layer<std::complex<double>>& layer) {
                          add_kernels(layer, weight, request, m, all[j]);
                      });
        }
    }
    return all;
}

double eval_slab_radiance(const SlabRadiance& radiance, const std::vector<double>& modes,
                          std::size_t view, std::size_t light, double azimuth) {
    double sum = 0;
    for (std::size_t m = 0; m < radiance.modes; ++m) {
        sum += (m == 0 ? 1 : 2) * std::cos(static_cast<double>(m) * azimuth) *
               modes[(m * radiance.views + view) * radiance.incidents + light];
    }
    return sum;
}

}  // namespace opaline::bake
