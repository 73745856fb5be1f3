#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "bake/base/frame.h"
#include "bake/lights/true_irradiance.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/gloss_model.h"

namespace opaline::bake {

/// The lobe of a surface as a path sees it, with all of its Fresnel term and masking: what truths
/// follow (sample_narrow_lobe has the bake's).
struct TrueLobe {
    formats::GlossSurface surface;
    Frame frame{};                  ///< about the interpolated normal
    glm::vec3 origin{0};            ///< where rays start [m]
    glm::vec3 to_eye{0};            ///< unit, in the frame, above the horizon
    glm::vec3 flat{0};              ///< the facet's normal, unit, in the world
    formats::GlossAlbedo albedo{};  ///< toward the eye
};
/// `direction`: of the path to it.
TrueLobe make_true_lobe(const formats::GlossSurface& surface, glm::vec3 normal, glm::vec3 flat,
                        glm::vec3 origin, glm::vec3 direction);

struct TrueLobeSample {
    glm::vec3 direction{0};        ///< unit
    formats::Rgb weight{0, 0, 0};  ///< f_s cosine / density
};
/// By visible normals; nothing below the surface. u, v: random.
std::optional<TrueLobeSample> sample_true_lobe(const TrueLobe& lobe, float u, float v);

/// Adds the luminance of `weight` times the radiance of suns in a lobe under each light. Lobes
/// narrower than 6 degrees count as that wide, since paths would meet the suns in them by chance:
/// far less than the texels of rows. Returns the rays.
std::uint64_t add_mirrored_suns(const RayScene& rays, const SunRays& suns, const TrueLobe& lobe,
                                formats::Rgb weight, std::span<double> luminance);

}  // namespace opaline::bake
