#include "bake/physics/slab/solve_slab.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>

#include "bake/physics/slab/boundary.h"
#include "bake/physics/slab/layer.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/streams.h"

namespace opaline::bake {
namespace {

/// By reciprocity the flux that leaves under a beam is the radiance under even light.
template <class Scalar>
StreamFluxes<Scalar> sum_fluxes(const Layer<Scalar>& layer, const Eigen::VectorXd& flux,
                                const SlabBoundary& boundary) {
    if (boundary.eta != 1) return sum_bounded_fluxes(layer, flux, boundary);
    return {layer.reflect * flux.cast<Scalar>(),
            layer.transmit * flux.cast<Scalar>() + layer.straight()};
}

/// `is_all`: not of one order after the first, which has nothing of what never enters.
SlabFluxes at_cosines(const StreamFluxes<double>& all, const Streams& streams,
                      const SlabBoundary& boundary, bool is_all) {
    SlabFluxes fluxes;
    for (Eigen::Index i = streams.quadrature; i < streams.cosine.size(); ++i) {
        fluxes.reflectance.push_back(all.reflected[i]);
        fluxes.transmittance.push_back(all.transmitted[i]);
    }
    const Eigen::VectorXd& even = boundary.entering;
    fluxes.mean_reflectance =
        even.dot(all.reflected.head(even.size())) + (is_all ? boundary.never_entering : 0);
    fluxes.mean_transmittance = even.dot(all.transmitted.head(even.size()));
    return fluxes;
}

}  // namespace

std::vector<SlabSolution> solve_slab(const SlabMedium& medium, const SlabRequest& request) {
    assert(request.optical_depth >= 0 && request.optical_depth <= kMaxSlabDepth);
    assert(request.orders <= kMaxSlabOrders && request.streams <= kMaxSlabStreams);
    const Streams streams =
        make_streams(request.streams, refracted_cosines(request.cosine, request.eta),
                     critical_cosine(request.eta));
    const SlabBoundary boundary = make_slab_boundary(streams, request.cosine, request.eta);
    constexpr double kAlmostNothing = 1e-60;  // for total reflection, which needs some depth
    const double depth =
        request.eta == 1 ? request.optical_depth : std::max(request.optical_depth, kAlmostNothing);
    const Eigen::VectorXd flux = streams.flux();
    const PhaseKernels kernels = make_phase_kernels(medium, streams, 0, streams.quadrature);
    std::vector<SlabSolution> solutions(request.halvings + std::size_t{1});
    double_up(
        kernels, streams, medium.albedo, depth, request.halvings,
        [&](unsigned halvings, const Layer<double>& layer) {
            SlabSolution& solution = solutions[halvings];
            solution.optical_depth = std::ldexp(request.optical_depth, -static_cast<int>(halvings));
            solution.total = at_cosines(sum_fluxes(layer, flux, boundary), streams, boundary, true);
        });
    if (request.orders == 0) return solutions;
    // What n scatterings leave is the coefficient of albedo^n.
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(streams.cosine.size());
    std::vector<std::vector<StreamFluxes<double>>> orders(
        solutions.size(), std::vector<StreamFluxes<double>>(request.orders, {none, none}));
    const AlbedoCircle circle(request.orders);
    for (unsigned k = 0; k < circle.count(); ++k) {
        double_up(kernels, streams, circle.albedo(k), depth, request.halvings,
                  [&](unsigned halvings, const Layer<std::complex<double>>& layer) {
                      const auto fluxes = sum_fluxes(layer, flux, boundary);
                      for (unsigned n = 0; n < request.orders; ++n) {
                          const std::complex<double> weight = circle.weight(k, n);
                          StreamFluxes<double>& order = orders[halvings][n];
                          order.reflected += (weight * fluxes.reflected).real();
                          order.transmitted += (weight * fluxes.transmitted).real();
                      }
                  });
    }
    for (std::size_t j = 0; j < solutions.size(); ++j) {
        double power = 1;
        for (StreamFluxes<double>& order : orders[j]) {
            order.reflected *= power;
            order.transmitted *= power;
            solutions[j].order.push_back(
                at_cosines(order, streams, boundary, solutions[j].order.empty()));
            power *= medium.albedo;
        }
    }
    return solutions;
}

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
