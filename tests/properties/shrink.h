#pragma once

#include <functional>

#include "tests/properties/things.h"

namespace opaline::tests {

/// The scene with as few things, and these as plain, as still fail: things are dropped, then
/// attributes set to those of Thing{}, as long as either succeeds.
SceneWords shrink(SceneWords scene, const std::function<bool(const SceneWords&)>& fails);

}  // namespace opaline::tests
