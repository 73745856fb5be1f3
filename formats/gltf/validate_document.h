#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// Checks every link, every range and the node forest, so that later stages can index without
/// checks: views lie in their buffers, accessors and sparse blocks in their views (64-bit
/// arithmetic that cannot wrap), every index names something, every node has at most one parent and
/// no node is its own ancestor. Faults go to `report`, all of them.
void validate_document(const Document& document, const std::vector<Bytes>& buffers, Report& report);

}  // namespace opaline::formats::gltf
