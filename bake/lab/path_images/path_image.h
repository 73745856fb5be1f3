#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/reference/light_sampler.h"
#include "bake/reference/reference_scene.h"
#include "formats/image/image.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "runtime/picture/camera.h"

namespace opaline::bake {

struct PathImageOptions {
    std::uint32_t rays = 4;  ///< of each pixel, >= 1, at the same places of every pixel
    /// Scale orders of two and more as a white furnace asks for.
    bool renormalise = true;  ///< not with fidelity "paper"
    /// Of `kPathTerms`; a view of the sky counts only if all terms do.
    formats::TermSet terms = formats::TermSet::all;
    std::vector<double> lengths{1};  ///< of turns, in scattering depths of the view ray; > 0
    /// The same with fidelity "paper": one of them is taken.
    std::vector<double> paper_lengths{0.5, 1, 2};
};

/// What this method computes.
inline constexpr formats::TermSet kPathTerms =
    formats::TermSet::volume_single | formats::TermSet::volume_multiple | formats::TermSet::diffuse;

struct PathImage {
    formats::Image radiance;         ///< [W m^-2 sr^-1], the mean over each pixel's rays
    double preparation_seconds = 0;  ///< depths toward the light, factors of the furnace
    double seconds = 0;              ///< in all
};

/// Whether path integration applies: there are volumes, all with one phase function, one fidelity
/// and albedos that are alike everywhere, and no body has a medium. Errors: bad_input, with a
/// remedy.
formats::Status check_path_scene(const formats::Scene& scene);

/// Whether pictures take [Premoze2003] as printed (README.md, "Fidelity paper"): what its volumes
/// say. Precondition: check_path_scene.
bool has_paper_fidelity(const formats::Scene& scene);

/// The picture of a pinhole camera by path integration [Premoze2003], corrected (README.md). The
/// same bits for any number of threads. Precondition: check_path_scene. Errors: interrupted.
formats::Result<PathImage> make_path_image(const ReferenceScene& scene, const LightSampler& light,
                                           const runtime::Camera& camera,
                                           const PathImageOptions& options, const Context& context);

}  // namespace opaline::bake
