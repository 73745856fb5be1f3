#pragma once

#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A phase function, prepared for sampling. It shares no code with the bake's phase functions,
/// because it serves to check them.
struct PhaseSampler {
    formats::PhaseFunction function;
    double scale = 1;                ///< gaussian, tabulated: 1 / integral over the sphere
    std::vector<double> cumulative;  ///< tabulated: integral up to each cosine, scaled to 1
};

/// Precondition: the phase function is within the bounds of formats/scene.h.
PhaseSampler make_phase_sampler(const formats::PhaseFunction& function);

/// Cosine between the propagation directions before and after a scattering event, distributed as 2
/// pi p(cosine). `next_uniform` returns the next uniform number in [0, 1).
template <class NextUniform>
float sample_phase_cosine(const PhaseSampler& sampler, NextUniform&& next_uniform);

/// p(cosine) [1/sr], which is also the density that `sample_phase_cosine` samples with, over solid
/// angle.
float pdf_phase(const PhaseSampler& sampler, float cosine);

namespace phase_sampler_details {
float invert_henyey_greenstein(double g, double u);
float invert_rayleigh(double u);
float invert_table(const PhaseSampler& sampler, double u);
/// A candidate angle of the Gaussian and its probability of acceptance.
struct GaussianCandidate {
    double angle = 0, acceptance = 0;
};
GaussianCandidate propose_gaussian(double rms_angle, double u);
float cosine_of(double angle);
}  // namespace phase_sampler_details

template <class NextUniform>
float sample_phase_cosine(const PhaseSampler& sampler, NextUniform&& next_uniform) {
    using formats::PhaseFunction;
    namespace details = phase_sampler_details;
    switch (sampler.function.type) {
        case PhaseFunction::Type::isotropic:
            break;
        case PhaseFunction::Type::henyey_greenstein:
            return details::invert_henyey_greenstein(double{sampler.function.g},
                                                     double{next_uniform()});
        case PhaseFunction::Type::rayleigh:
            return details::invert_rayleigh(double{next_uniform()});
        case PhaseFunction::Type::gaussian:
            while (true) {
                const auto candidate = details::propose_gaussian(double{sampler.function.rms_angle},
                                                                 double{next_uniform()});
                if (double{next_uniform()} < candidate.acceptance) {
                    return details::cosine_of(candidate.angle);
                }
            }
        case PhaseFunction::Type::tabulated:
            return details::invert_table(sampler, double{next_uniform()});
    }
    return 1 - 2 * next_uniform();
}

}  // namespace opaline::bake
