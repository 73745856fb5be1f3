#include "bake/exchange/even_return.h"

#include <gtest/gtest.h>

#include "tests/support/media.h"

namespace opaline::bake {
namespace {

// A transport mean free path of 1 m.
formats::Medium make_medium() {
    return tests::make_grey_medium(0.9f, 0.1f);
}

TEST(EvenReturn, AtTheBottomOfAFoldIsThatOfItsSurroundings) {
    EvenReturn even(make_medium());
    even.add({0, 0, 0}, 0.1f, {0.3f, 0.2f, 0.1f});  // more leaves than arrives
    for (int i = 0; i < 99; ++i) {
        even.add({0.01f * static_cast<float>(i), 1, 0}, 1, {0.5f, 0.4f, 0.3f});
    }
    const BandColour share = even.share({0, 0, 0});
    EXPECT_NEAR(share[0], (0.3f + 99 * 0.5f) / 99.1f, 1e-4f);
    EXPECT_NEAR(share[2], (0.1f + 99 * 0.3f) / 99.1f, 1e-4f);
}

TEST(EvenReturn, OfAThinPartIsNotThatOfAThickOneFarAway) {
    EvenReturn even(make_medium());
    for (int i = 0; i < 100; ++i) {
        even.add({0, 0, 0}, 1, {0.9f, 0.9f, 0.9f});
        even.add({100, 0, 0}, 1, {0.3f, 0.3f, 0.3f});
    }
    EXPECT_NEAR(even.share({0, 0, 0})[0], 0.9f, 0.02f);
    EXPECT_NEAR(even.share({100, 0, 0})[0], 0.3f, 0.02f);
    EXPECT_NEAR(even.share({50, 0, 0})[0], 0.6f, 1e-5f) << "no point is near: of all";
}

TEST(EvenReturn, IsAShareWhateverThePoints) {
    EvenReturn none(make_medium());
    EXPECT_EQ(none.share({0, 0, 0})[0], 0);
    none.add({1e30f, -1e30f, 0}, 0, {1, 1, 1});
    EXPECT_EQ(none.share({1e30f, -1e30f, 0})[1], 0) << "nothing arrives";
    none.add({0, 0, 0}, 0.5f, {2, 2, 2});
    EXPECT_EQ(none.share({0, 0, 0})[2], 1);
}

}  // namespace
}  // namespace opaline::bake
