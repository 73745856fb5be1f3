#pragma once

#include "formats/opal/asset.h"
#include "runtime/api_support.h"
#include "tests/bench/gl_parity/report.h"
#include "tests/bench/gl_parity/skies.h"
#include "tests/runtime/embed_gl/host/host_context.h"
#include "tests/runtime/embed_gl/host/loaded_file.h"

namespace opaline::parity {

/// A file in an OpenGL context that is current.
struct Case {
    const test::LoadedFile& file;
    test::HostApi api;
    opaline_gl* gl;  ///< made with everything that the file has, relit by the file's light
    Report& report;

    const formats::AssetView& view() const { return file.asset()->loaded.view; }
};

/// Each throws as test::require where something cannot be done at all.

/// Relit receivers from three eyes, and what hosts' shaders show of them: shares of the brightest.
void compare_surfaces(const Case& in);
/// Samples of all images and which pixels holes cover; independent of light.
void compare_images(const Case& in);
/// Normals, and receivers' light turned to them: shares of one and the light.
void compare_normal_maps(const Case& in);
/// Rays (radiance as a share of the brightest, transmittance) and points (shares of the thickest
/// and the brightest) within volumes.
void compare_volumes(const Case& in);
/// Rays from below, within and above a cloud layer: shares of the brightest, transmittance,
/// distance.
void compare_layers(const Case& in, const Sky& sky);

}  // namespace opaline::parity
