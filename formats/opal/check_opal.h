#pragma once

#include <cstdint>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// Every count, offset and index that the runtime relies on without further checks: indices below
/// the number of coefficients, vertices, images and rows they refer to; ranges inside their arrays.
Fault find_structure_fault(const AssetView& asset);

/// Of an image that a record uses, if it is not kNoImage; empty where nothing is wrong.
std::string find_image_fault(const AssetView& asset, std::uint32_t image, Wrap wrap_u, Wrap wrap_v);

/// What a sound baker never writes: numbers that are not finite, scales below zero, normals that
/// are neither unit nor zero, colours below zero, coefficient indices out of order.
Fault find_value_fault(const AssetView& asset);

}  // namespace opaline::formats
