#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/texel_lines.h"
#include "runtime/embed_gl/volume_tables.h"

namespace opaline::runtime {

/// An asset's volumes as opaline_volumes.glsl reads them: arrays in textures of 2048 columns, and a
/// uniform block: volumes, suns, colours of own light. Every call wants a SavedState around it.
class VolumeTextures {
  public:
    explicit VolumeTextures(const GlFunctions& gl) : gl_(gl) {}

    /// Uploads what no light changes; nothing where there are no volumes. They only absorb, seen
    /// from the world's origin. OPALINE_GL_REFUSED: more than kMaxGlVolumes, or more texels than
    /// the driver takes.
    opaline_status make(const formats::VolumesView& volumes, GlNames& names);

    /// Precondition: `light` is of these volumes.
    opaline_status upload(const VolumeLight& light);
    /// [m, world]; distances of the shader are in units of which a metre has so many.
    void look_from(formats::Vec3 eye, double units_per_metre = 1);

    std::size_t size() const { return records_.size(); }
    /// Names, and what shaders are compiled for; all names are 0 where there are no volumes.
    const opaline_gl_volumes& objects() const { return objects_; }

  private:
    struct Entry {
        VolumeLattice lattice;  // without its arrays: those are on the GPU
        std::size_t volume = 0;
    };
    opaline_status check_sizes(const formats::VolumesView& volumes) const;
    void fill_records();

    const GlFunctions& gl_;
    std::vector<formats::VolumeRecord> records_;
    std::vector<Entry> entry_;
    VolumeLight light_;  // its coefficients are on the GPU
    std::vector<formats::GlowRecord> glow_;
    formats::Vec3 eye_;
    double units_per_metre_ = 1;
    opaline_gl_volumes objects_{};
    TexelLines brick_numbers_{gl_, kWordTexel}, density_codes_{gl_, kWordTexel};
    TexelLines corner_numbers_{gl_, kWordTexel}, phase_entries_{gl_, kFloatTexel};
    TexelLines node_light_{gl_, kColorTexel}, glow_words_{gl_, kWordTexel};
};

}  // namespace opaline::runtime
