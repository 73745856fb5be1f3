#pragma once

#include <cstdint>

#include "formats/scene.h"

namespace opaline::bake {

/// Bounds on the share of light that leaves surfaces of a material again, in any band.
struct SentShare {
    double diffuse = 0;    ///< but for what its surface mirrors
    double all = 0;        ///< with that
    bool is_grey = false;  ///< all three bands alike
};

/// `brightest_vertex`: bound on the vertex colours of the material's surfaces, 1 where there are
/// none.
SentShare find_sent_share(const formats::Scene& scene, std::uint32_t material,
                          float brightest_vertex);

/// Whether the numbers of a medium or sheet are the same in all three bands, everywhere; false of
/// an opaque material.
bool has_grey_numbers(const formats::Scene& scene, std::uint32_t material);

}  // namespace opaline::bake
