#include "formats/media/presets.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::media_preset;
using formats::media_preset_names;
using formats::PhaseFunction;

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

TEST(MediaPresets, SkimMilkHasTwoSpellingsAndOtherNamesAreUnknown) {
    EXPECT_EQ(media_preset("skimmilk")->sigma_s, media_preset("skim-milk")->sigma_s);
    for (const char* name : {"", "Marble", "milk", "skin3"}) {
        EXPECT_FALSE(media_preset(name).has_value()) << name;
    }
}

}  // namespace
}  // namespace opaline::tests
