#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Distant light that differs between the primitives of an asset, as it does beneath a cloud layer
/// (clouds/part_environments.h). A single light converts to it. Refers to its arrays.
struct PartLights {
    std::span<const LightVector> light;  ///< at least one, each of the asset's cube map size
    /// Of each primitive, an index into `light`; empty: all have the first.
    std::span<const std::uint32_t> of_primitive;
    std::uint32_t of_volumes = 0;  ///< likewise

    PartLights(const LightVector& one) : light(&one, 1) {}
    PartLights(std::span<const LightVector> lights, std::span<const std::uint32_t> primitives,
               std::uint32_t volumes)
        : light(lights), of_primitive(primitives), of_volumes(volumes) {}

    std::size_t number(std::size_t primitive) const {
        return of_primitive.empty() ? 0 : of_primitive[primitive];
    }
};

}  // namespace opaline::runtime
