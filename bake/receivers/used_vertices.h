#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Running numbers over all primitives, ascending, of the vertices that some triangle uses, or of
/// their slots where there are some; of all where none is used. The others are never seen, so
/// nothing is compared there. Where vertices are mixed, of each place that is used the slot of the
/// largest weight, some of them often: draws of it weigh slots by what they stand for.
std::vector<std::uint32_t> find_used_vertices(const formats::Scene& scene,
                                              const formats::SlotsView& slots = {});

}  // namespace opaline::bake
