#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/vec3.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/glossy_light.h"
#include "runtime/embed_gl/image_textures.h"
#include "runtime/embed_gl/layer_textures.h"
#include "runtime/embed_gl/mirrored_light.h"
#include "runtime/embed_gl/relight.h"
#include "runtime/embed_gl/volume_textures.h"
#include "runtime/users.h"

// What the files of the interface in opaline_gl.h share.

struct opaline_layer_light {
    std::uint64_t asset_id = 0;
    opaline::runtime::LayerLight light;         // refers to the asset's bytes: for that id alone
    opaline::formats::Environment environment;  // that it is lit by
    opaline::runtime::Rotation rotation;
    mutable opaline::runtime::Users users;
};

struct opaline_gl {
    opaline::runtime::GlFunctions gl;
    opaline::runtime::GlNames names{gl};
    opaline::runtime::Relight relight{gl};
    opaline::runtime::MirroredLight mirrored{gl};
    opaline::runtime::GlossyLight glossy{gl};
    opaline::runtime::ImageTextures images{gl};
    opaline::runtime::VolumeTextures volumes{gl};
    opaline::runtime::LayerTextures layer{gl};
    std::uint64_t asset_id = 0;  // lights of volumes and layers are of one asset
    std::vector<opaline::formats::GlossRecord> gloss;  // of each primitive, or none
    std::vector<opaline::formats::PrimitiveRecord> primitives;
    GLuint marker_program = 0;
    std::uint32_t marker = 0;  // a uniform of it: no other context's program of that name has it
    std::uint32_t cubemap_size = 0;
    std::size_t emitters = 0;
    std::optional<opaline::formats::Vec3> eye;
    bool is_relit = false;
    std::uint64_t specular_id = 0;  // of the SpecularLight that is uploaded
    opaline_gl_objects objects{};

    opaline_gl() = default;
    opaline_gl(const opaline_gl&) = delete;  // members refer to each other
    opaline_gl& operator=(const opaline_gl&) = delete;
};

namespace opaline::runtime::api {

/// Notes that the driver lost the context.
opaline_status lost_context();

/// Whether the handle's context, or one that shares its objects, is current.
opaline_status check_context(const opaline_gl& handle);

}  // namespace opaline::runtime::api
