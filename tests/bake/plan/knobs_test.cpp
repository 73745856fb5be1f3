#include "bake/plan/knobs.h"

#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

std::uint32_t kept_for(std::uint32_t coefficients) {
    Knobs knobs;
    knobs.coefficients = coefficients;
    return sample_coefficients(knobs);
}

TEST(SampleCoefficients, AreThoseOfARowUpTo512AndHalfOfThemFrom1024On) {
    EXPECT_EQ(kept_for(1), 1u);
    EXPECT_EQ(kept_for(128), 128u);
    EXPECT_EQ(kept_for(512), 512u);
    EXPECT_EQ(kept_for(700), 512u);
    EXPECT_EQ(kept_for(1024), 512u);
    EXPECT_EQ(kept_for(3000), 1500u);
    EXPECT_EQ(kept_for(kAllCoefficients), 4096u) << "memory has an end";
}

}  // namespace
}  // namespace opaline::bake
