#pragma once

#include <string>

#include "formats/opal/asset.h"

namespace opaline::formats {

/// What is wrong with an asset; `what` is empty where nothing is.
struct Fault {
    std::string where, what;
};

/// Every count, offset and index that the runtime relies on without further checks: indices below
/// the number of coefficients, vertices, images and rows they refer to; ranges inside their arrays.
Fault find_structure_fault(const AssetView& asset);

/// What a sound baker never writes: numbers that are not finite, scales below zero, normals that
/// are neither unit nor zero, colours below zero, coefficient indices out of order.
Fault find_value_fault(const AssetView& asset);

}  // namespace opaline::formats
