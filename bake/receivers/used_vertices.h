#pragma once

#include <cstdint>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Running numbers over all primitives, ascending, of the vertices that some triangle uses; of all
/// where none is used. The others are never seen, so nothing is compared there.
std::vector<std::uint32_t> find_used_vertices(const formats::Scene& scene);

}  // namespace opaline::bake
