#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a medium with a formats::Variation is at each point inside its body: a fact of the scene,
/// of which nothing is sampled here. Veins are evaluated at the point itself. Textures are those of
/// the nearest point of the surface, found at the nodes of a grid over the body's box, a 96th of
/// its longest side apart, and linear between: 8 MB at most. A node has the mean over a square as
/// wide as nodes are apart: colour, strength and density each by itself. Immutable; any thread may
/// look.
class MediumField {
  public:
    /// Of the scene's material, which has a medium with a variation. The same for any number of
    /// threads.
    MediumField(const formats::Scene& scene, std::uint32_t material);

    /// The scattering colour there over that of the stated medium, each band in [0, 1].
    glm::vec3 color(glm::vec3 position) const;
    /// Of one scattering event there, each band in [0, 1]: albedo_of_color of the local scattering
    /// colour (bake/physics/scattering_color.h). Where that is the stated one, so is this.
    glm::vec3 albedo(glm::vec3 position) const;
    /// Both coefficients over the stated ones, in (0, 1]. 1 everywhere unless has_density().
    float density(glm::vec3 position) const { return has_density_ ? grid(position).w : 1.0f; }
    bool has_density() const { return has_density_; }
    /// Mean of the density from one point to another, by the midpoint rule with steps of half a
    /// node's distance, at most 512. Exact where nothing varies.
    float mean_density(glm::vec3 from, glm::vec3 to) const;

  private:
    using Codes = std::array<std::uint16_t, 4>;  // colour and density times 65535
    glm::vec4 grid(glm::vec3 position) const;
    void fill_grid(const formats::Scene& scene, std::uint32_t material);

    std::optional<formats::Marble> marble_;
    glm::dvec3 origin_{0};
    glm::vec3 stated_albedo_{0}, stated_color_{0};
    float g_ = 0;
    bool has_density_ = false;
    glm::vec3 low_{0};
    float per_cell_ = 0;  // [1/m]
    glm::ivec3 nodes_{0};
    std::vector<Codes> grid_;  // empty: no texture
};

/// The variation is the same in all three bands.
bool is_grey(const formats::Scene& scene, const formats::Variation& variation);

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
