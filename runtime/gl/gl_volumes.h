#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "formats/opal/volumes.h"
#include "runtime/embed_gl/volume_tables.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/light_vector.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// An asset's volumes on the GPU. Light of nodes and of suns' points is found on the CPU, which
/// keeps the arrays for that.
struct GlVolumes {
    struct Entry {
        VolumeLattice lattice;   ///< without its arrays: those are on the GPU
        std::size_t volume = 0;  ///< its number in the asset
    };
    std::vector<Entry> entry;  ///< those that a ray can meet
    formats::Volumes kept;     ///< all but the voxels of nodes and codes of own light

    GlBuffer table, corner;
    GlBuffer density;  ///< pack_density
    GlBuffer phase;    ///< pack_sun_tables
    /// Of a volume's own light: for each brick the first of its words or kNoBrick, then 9 x 9 x 9
    /// words of each brick around which any is, x fastest, half.h.
    GlBuffer glow;
    bool glows = false;  ///< whether there is any
    GlBuffer coefficient;
    VolumeLight light;                ///< its coefficients are on the GPU
    std::uint32_t harmonics = 1;      ///< the most terms of a node, suns left out
    std::size_t resident = 0;         ///< [bytes], coefficients under one sun included
    std::size_t max_block_bytes = 0;  ///< that a shader may see of one buffer

    std::vector<formats::Rgb> emitters;  ///< their colours; empty: 1 each
    bool shows_own = true;
    LightVector lit_by;  ///< the last light; n = 0 before there is one
    formats::TermSet lit_terms = formats::TermSet::none;  ///< components in `coefficient`

    bool empty() const { return entry.empty(); }
};

/// Uploads; nothing where there are none. Errors: resource (memory; more than kMaxGlVolumes; a
/// buffer beyond `max_block_bytes`). Precondition: the asset passed read_opal's checks.
formats::Result<GlVolumes> upload_volumes(const formats::VolumesView& volumes,
                                          std::size_t max_block_bytes);

/// Computes the nodes' coefficients (relight_volumes) on the CPU and uploads them, `terms` of them;
/// without a light the volumes only absorb. `emitters`: of the asset, or none. Does nothing where
/// there are no volumes. Errors: resource (memory; suns whose points take more than
/// `max_block_bytes`). Precondition: light.n is the asset's cube map size, or
/// 0.
formats::Status relight_gl_volumes(GlVolumes& volumes, const LightVector& light,
                                   formats::TermSet terms, const EmitterLight& emitters = {});

/// The same light with other components, if they are others for volumes.
formats::Status show_volume_terms(GlVolumes& volumes, formats::TermSet terms);

}  // namespace opaline::runtime
