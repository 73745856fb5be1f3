#pragma once

#include <vector>

#include "formats/media/media_file.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::formats {

/// What is made of a layer that a formula describes: its thickness at every texel of every frame,
/// or a vector of the largest alone, which decisions and predictions follow from.
enum class CloudDetail { fields, largest };

/// Adds the cloud layers of a media file to the scene, after those that it has; formulas become
/// thickness. Their files are among the inputs and in the hash that apply_media adds. Gives
/// warnings: about a layer of thickness 0. Errors: `bad_input`, with the scene unchanged, for more
/// than kMaxLayers in all.
Result<std::vector<Diagnostic>> load_clouds(const MediaFile& media, Scene& scene,
                                            CloudDetail detail = CloudDetail::fields);

}  // namespace opaline::formats
