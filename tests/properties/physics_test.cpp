// Scenes by chance.
#include <gtest/gtest.h>

#include "tests/properties/physics.h"

namespace opaline::tests {
namespace {

TEST(SceneWords, AreReadAsTheyAreWritten) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const std::string text = describe(random_scene(seed));
        EXPECT_EQ(describe(parse_scene(text)), text);
    }
}

}  // namespace
}  // namespace opaline::tests
