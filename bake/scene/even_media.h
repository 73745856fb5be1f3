#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The homogeneous medium that stands for one with a variation where a model knows no other: the
/// means over the surface of scattering colour and density. The same medium without a variation.
formats::Medium even_medium(const formats::Scene& scene, std::uint32_t material);

/// The scene with such media alone, for models that know no others; nothing where it has no other.
struct EvenedScene {
    formats::Scene scene;
    std::vector<formats::Diagnostic> warnings;
};
std::optional<EvenedScene> even_media(const formats::Scene& scene);

}  // namespace opaline::bake
