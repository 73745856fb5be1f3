#pragma once

#include <cstddef>
#include <vector>

#include "runtime/embed_gl/gl_names.h"
#include "runtime/specular.h"

namespace opaline::runtime {

/// What glossy translucent primitives mirror: a texture for each roughness that the asset has.
/// Every call wants a SavedState around it.
class MirroredLight {
  public:
    explicit MirroredLight(const GlFunctions& gl) : gl_(gl) {}

    /// Black textures. `asset`: roughness is copied from it.
    void make(const formats::AssetView& asset, GlNames& names);

    /// Copies the light's maps; where it lacks one, that texture stays as it is.
    void upload(const SpecularLight& light);
    void turn(const Rotation& rotation) { rotation_ = rotation; }

    /// Of a primitive: the texture, 0 where it is not glossy, and the cone of its lobe.
    struct Lobe {
        GLuint texture = 0;
        float cosine = 1, sine = 0;
    };
    Lobe lobe_of(std::size_t primitive) const;

    const Rotation& rotation() const { return rotation_; }

  private:
    const GlFunctions& gl_;
    std::vector<float> roughness_;       // of each primitive, below 0 where it is not glossy
    std::vector<std::uint32_t> levels_;  // ascending
    std::vector<GLuint> textures_;       // one a level
    Rotation rotation_;
};

}  // namespace opaline::runtime
