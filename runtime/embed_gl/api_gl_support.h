#pragma once

#include <cstdint>
#include <optional>

#include "formats/opal/asset.h"
#include "formats/opal/vec3.h"
#include "runtime/embed_gl/gl_asset.h"
#include "runtime/users.h"

// What the files of the interface in opaline_gl.h share.

struct opaline_layer_light {
    std::uint64_t asset_id = 0;
    opaline::runtime::LayerLight light;         // refers to the asset's bytes: for that id alone
    opaline::formats::Environment environment;  // that it is lit by
    opaline::runtime::Rotation rotation;
    mutable opaline::runtime::Users users;
};

struct opaline_gl : opaline::runtime::GlAsset {
    std::uint64_t asset_id = 0;  // lights of volumes and layers are of one asset
    GLuint marker_program = 0;
    std::uint32_t marker = 0;  // a uniform of it: no other context's program of that name has it
    std::size_t emitters = 0;
    std::optional<opaline::formats::Vec3> eye;
    bool is_relit = false;
};

namespace opaline::runtime::api {

/// Notes that the driver lost the context.
opaline_status lost_context();

/// Whether the handle's context, or one that shares its objects, is current.
opaline_status check_context(const opaline_gl& handle);

}  // namespace opaline::runtime::api
