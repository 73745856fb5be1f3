#pragma once

#include <filesystem>
#include <vector>

#include "bake/truth/test_lights.h"

namespace opaline::bake {

/// The test lights that this very program (its file, byte for byte) wrote before, without
/// TestLight::coarse; empty where there are none, or a byte of them is wrong.
std::vector<TestLight> read_test_lights(const std::filesystem::path& file);

/// Keeps them for the next time. A failure is no error: they are computed again.
void write_test_lights(const std::filesystem::path& file, const std::vector<TestLight>& lights);

}  // namespace opaline::bake
