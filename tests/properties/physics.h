#pragma once

#include <optional>
#include <string>

#include "tests/properties/things.h"

namespace opaline::tests {

/// What a scene does that physics, or the baker's contract, does not allow.
struct Fault {
    std::string property;  ///< "furnace", "bounds", ...
    std::string detail;
};

/// Bakes the scene, coarsely and as often as it says, and judges the result. Properties:
///   bakes      no error, whatever the scene;
///   finite     under every light, a black one and texels of 1e30 among them, nothing is NaN,
///              infinite or negative; under black nothing shines but lamps;
///   bounds     lights of 0 <= L <= 1 and black lamps of radiance 1 make nothing brighter than 1,
///              and lamps nothing brighter than they are;
///   furnace    where nothing absorbs, an even light of 1 and such lamps make all that is seen 1,
///              within the error that the bake states;
///   linear     lights that are added up or scaled add up what they show, or scale it;
///   again      what a second bake shows (bake_again.h).
std::optional<Fault> find_fault(const SceneWords& words);

/// What a look at one scene needs: slow stages, and what each primitive shows under even light.
std::string inspect(const SceneWords& words);

}  // namespace opaline::tests
