#pragma once

#include <cstdint>
#include <vector>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {

inline constexpr unsigned kSheetSide = 12;

/// A wavy sheet of kSheetSide * kSheetSide vertices with exactly representable coordinates.
std::vector<float> sheet_positions();
std::vector<std::uint32_t> sheet_indices();

/// Both buffer views of the sheet in EXT_meshopt_compression, over a placeholder buffer.
AssetBuilder meshopt_sheet();

enum class DracoMethod { sequential, edgebreaker };
/// Without quantisation: lossless.
AssetBuilder draco_sheet(DracoMethod method);

}  // namespace opaline::tests
