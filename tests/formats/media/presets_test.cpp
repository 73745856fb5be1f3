#include "formats/media/presets.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::media_preset;
using formats::media_preset_names;
using formats::Medium;
using formats::PhaseFunction;
using formats::Rgb;

TEST(MediaPresets, AllTwelveMeasuredMediaAreThereAndSound) {
    ASSERT_EQ(media_preset_names().size(), 12u);
    EXPECT_TRUE(std::is_sorted(media_preset_names().begin(), media_preset_names().end()));
    for (const std::string_view name : media_preset_names()) {
        const auto medium = media_preset(name);
        ASSERT_TRUE(medium.has_value()) << name;
        EXPECT_TRUE(is_sound(*medium)) << name;
        EXPECT_EQ(medium->phase.type, PhaseFunction::Type::isotropic) << name;
        EXPECT_EQ(medium->eta, name == "marble" ? 1.5f : 1.3f) << name;
    }
}

TEST(MediaPresets, CoefficientsArePerMetreNotPerMillimetre) {
    EXPECT_EQ(media_preset("marble")->sigma_s, (Rgb{2190, 2620, 3000}));
    EXPECT_EQ(media_preset("marble")->sigma_a, (Rgb{2.1f, 4.1f, 7.1f}));
}

TEST(MediaPresets, OnlySpectralonAbsorbsNothing) {
    for (const std::string_view name : media_preset_names()) {
        EXPECT_EQ(media_preset(name)->sigma_a == Rgb{}, name == "spectralon") << name;
    }
}

TEST(MediaPresets, KetchupIsRedAndSkimMilkScattersBlueMost) {
    const Medium ketchup = *media_preset("ketchup"), milk = *media_preset("skim-milk");
    EXPECT_LT(ketchup.sigma_a.r, 0.1f * ketchup.sigma_a.b);
    EXPECT_GT(milk.sigma_s.b, 2 * milk.sigma_s.r);
}

TEST(MediaPresets, SkimMilkHasTwoSpellingsAndOtherNamesAreUnknown) {
    EXPECT_EQ(media_preset("skimmilk")->sigma_s, media_preset("skim-milk")->sigma_s);
    for (const char* name : {"", "Marble", "milk", "skin3"}) {
        EXPECT_FALSE(media_preset(name).has_value()) << name;
    }
}

}  // namespace
}  // namespace opaline::tests
