#include <gtest/gtest.h>

#include "bake/check/stored_luminance.h"

namespace opaline::bake {
namespace {

RowLayout make_layout(std::uint32_t harmonics, bool separate) {
    RowLayout layout;
    layout.translucent = true;
    layout.constant = true;
    layout.harmonics = harmonics;
    layout.separate = separate;
    return layout;
}

// Separate rows without harmonics were written one past their end: found by the address sanitizer.
TEST(ViewOfRows, HasOneFactorForEachRowWhateverTheLayout) {
    constexpr float kY0 = 0.2820948f, kY1 = 0.4886025f;
    const glm::vec3 up(0, 1, 0);
    EXPECT_EQ(view_of_rows(make_layout(0, false), up), std::vector<float>({1}));
    RowLayout sheet;
    sheet.sheet = true;
    EXPECT_EQ(view_of_rows(sheet, up), std::vector<float>({1, 0}));
    EXPECT_EQ(view_of_rows(sheet, up, true), std::vector<float>({0, 1})) << "from behind";
    EXPECT_EQ(view_of_rows(make_layout(0, true), up), std::vector<float>({1}));
    EXPECT_EQ(view_of_rows(make_layout(1, true), up).size(), 2u);
    const std::vector<float> apart = view_of_rows(make_layout(4, true), up);
    ASSERT_EQ(apart.size(), 5u);
    EXPECT_EQ(apart[0], 1);
    EXPECT_NEAR(apart[1], kY0, 1e-6);
    EXPECT_NEAR(apart[2], kY1, 1e-6);
}

TEST(ViewOfRows, OneHarmonicOfOneEffectStandsAmongTheFourOfAnother) {
    RowLayout layout = make_layout(1, false);
    layout.view_harmonics = 4;
    EXPECT_EQ(layout.terms(), 4u);
    const std::vector<float> h = view_of_rows(layout, {0, 1, 0});
    ASSERT_EQ(h.size(), 4u);
    EXPECT_NEAR(static_cast<double>(h[0]), layout.view_of_constant(), 1e-6);
    EXPECT_NEAR(h[1], 0.4886025f, 1e-6);
}

}  // namespace
}  // namespace opaline::bake
