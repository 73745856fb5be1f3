#pragma once

#include <cstdint>

#include "bake/base/context.h"
#include "bake/scattering/half_space_walk.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a half space of one band [1/m] returns of uniform light, per incident flux, `escape` of
/// which enters. By random walks; near albedo 1 extrapolated, where walks have no end.
HalfSpaceReflectance half_space_reflectance(double sigma_s, double sigma_a,
                                            const formats::Medium& medium, std::uint64_t seed,
                                            const Context& context);

/// Share of uniform light that a half space of the medium returns: the albedo of the diffuse
/// surface to compare the medium with.
formats::Rgb half_space_albedo(const formats::Medium& medium, std::uint64_t seed,
                               const Context& context);

/// Events of a random walk that enters a half space with uniform light (half_space_walk.h):
/// fitted to walks, good to 1.3. `albedo` in [0, 1], `g`: mean cosine, `eta`: relative index.
double count_walk_events(double albedo, double g, double eta);

/// Of all walks of half_space_reflectance for a medium; equal neighbouring bands share one.
double count_walk_events(const formats::Medium& medium);

}  // namespace opaline::bake
