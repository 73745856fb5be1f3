#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace opaline::tests {

/// Where large models and environments lie: the folder that OPALINE_ASSETS_DIR names, or
/// `shared/assets` beside the project.
inline std::filesystem::path assets_folder() {
    const char* given = std::getenv("OPALINE_ASSETS_DIR");
    return given != nullptr ? std::filesystem::path(given)
                            : std::filesystem::path(OPALINE_SOURCE_DIR) / "../shared/assets";
}

}  // namespace opaline::tests

/// Names the path of an asset, or skips the test where it is absent. tests/run.sh lists such tests.
#define OPALINE_ASSET(name, relative)                                                          \
    const std::filesystem::path name = opaline::tests::assets_folder() / (relative);           \
    if (!std::filesystem::exists(name)) {                                                      \
        GTEST_SKIP() << "no asset " << (relative) << " (OPALINE_ASSETS_DIR names the folder)"; \
    }
