#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// What a material's diffuse part is as a thin-walled surface.
struct MappedSheet {
    Rgb base_color;  ///< the larger of what is reflected and transmitted, band by band
    Sheet sheet;     ///< shares of it
    /// Of thin glass, the index of refraction of a surface that mirrors as what meets it does.
    std::optional<float> mirror_ior;
};

/// The thin-walled surface that a material's extensions describe, or nothing. Thin-walled: no
/// `KHR_materials_volume`, or its thicknessFactor is 0. `KHR_materials_diffuse_transmission` of
/// factor f: (1 - f) base_color is reflected, f times its colour transmitted. A scatter extension
/// under `KHR_materials_transmission`: of what that lets in times strength and multiscatter colour,
/// the share (1 + g) / 2 is transmitted and the rest reflected. What transmission lets in otherwise
/// passes as thin glass: straight as far as it is smooth, else diffusely. `remarks` gets one
/// sentence for each property that differs from the file.
std::optional<MappedSheet> map_sheet(const TranslucencySource& source, Rgb base_color,
                                     bool has_base_color_texture,
                                     std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
