#pragma once

#include <optional>
#include <string>

#include "bake/pipeline/pipeline.h"
#include "tests/properties/build_scene.h"
#include "tests/properties/physics.h"

namespace opaline::tests {

/// Bakes the scene once more as `again` says, and compares with `baked`:
///   threads    the same bytes;
///   darker     nothing is brighter, under any light;
///   all others what is seen is the same, under the light turned along.
/// Either within the error that both bakes state.
std::optional<Fault> find_fault_again(const BuiltScene& built, const bake::BakeResult& baked,
                                      Again again);

/// How far both are apart, in words.
std::string describe_again(const BuiltScene& built, const bake::BakeResult& baked, Again again);

}  // namespace opaline::tests
