#pragma once

#include <vector>

#include "formats/media/media_file.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::formats {

/// Gives the scene's materials the media that the file names for them: by glTF material name, and
/// "*" for every other one. A medium that is there already, from glTF extensions, is replaced.
/// Its groups of emitters, if
/// any, replace those that are there. Files read join `scene.inputs`, their bytes `scene.sha256`:
/// the hash of both hashes' digits. Gives warnings: for each name that no material of the scene
/// has. Errors: `bad_input`, with the scene unchanged, for an albedo texture on primitives without
/// texture coordinates.
Result<std::vector<Diagnostic>> apply_media(const MediaFile& media, Scene& scene);

}  // namespace opaline::formats
