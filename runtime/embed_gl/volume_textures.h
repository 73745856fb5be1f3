#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/texel_lines.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

// Volumes as volume_march.glsl reads them.

/// Every pixel keeps the registers of all of them, and the first picture waits for the driver to
/// compile: on llvmpipe some seconds for one, 5 to 12 s for four, 50 s for sixteen.
inline constexpr std::size_t kMaxGlVolumes = 4;

/// Of a brick: the scale of its codes as the bits of a float (density = scale * code / 65535), then
/// 8 x 9 x 9 words, x fastest: the code of a voxel in the lower half, of the next along x in the
/// upper. The ninth layers are those of the neighbours, so that a lookup stays in its brick.
inline constexpr std::size_t kGlBrickWords = 1 + std::size_t{8} * 9 * 9;

/// All bricks of all volumes, kGlBrickWords each; those of volumes without a lattice are 0.
/// Precondition: the asset passed read_opal's checks.
std::vector<std::uint32_t> pack_density(const formats::VolumesView& volumes);

/// Light that volumes send out by themselves: for each brick of all volumes the first of its words,
/// or formats::kNoBrick; then 9 x 9 x 9 words of each brick around which any is, x fastest,
/// half.h. Empty without any.
std::vector<std::uint32_t> pack_glow(const formats::VolumesView& volumes);

/// The most terms of a node of any volume, suns left out; at least 1.
std::uint32_t most_node_terms(const formats::VolumesView& volumes);
/// Coefficients of VolumeLight under a light with one sun.
std::size_t count_coefficients(const formats::VolumesView& volumes);

/// Volume of volume_march.glsl, in std140.
struct ShaderVolume {
    std::array<std::array<float, 4>, 3> to_bricks{};
    std::array<std::uint32_t, 4> extent_first{}, numbers{};
    std::array<float, 4> extinction{}, albedo{};
    std::array<std::uint32_t, 4> coefficient{};
};
static_assert(sizeof(ShaderVolume) == 128);

/// A volume seen from `eye` [m, world]; `units_per_metre`: of the shader's distances. Without
/// cells, so that no ray meets it, where floats cannot hold the way into it. `volume`: its number.
ShaderVolume make_shader_volume(const VolumeLattice& lattice, std::size_t volume,
                                const VolumeLight::Part& part, formats::Vec3 eye,
                                double units_per_metre);

/// Colour of a volume's own light in `light`, times the scale of codes; 0 where it has none.
std::array<float, 4> shader_glow(const formats::GlowView& glow, const VolumeLight& light,
                                 std::size_t volume, double units_per_metre);

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
