// Emitters that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string>

#include "formats/opal/half.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_emitter_asset;

TEST(Half, EveryFiniteHalfComesBackFromItsFloat) {
    for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
        const auto half = static_cast<std::uint16_t>(bits);
        if (!is_half_finite(half)) {
            EXPECT_FALSE(std::isfinite(float_from_half(half)));
        } else {
            EXPECT_EQ(half_from_float(float_from_half(half)), half);
        }
    }
    EXPECT_EQ(float_from_half(0x3c00), 1);
    EXPECT_EQ(float_from_half(0xc000), -2);
    EXPECT_EQ(float_from_half(0x0001), 0x1p-24f);
    EXPECT_EQ(float_from_half(0x7bff), kLargestHalf);
}

TEST(Half, IsTheNearestOneWithTiesToEven) {
    EXPECT_EQ(half_from_float(1 + 0x1p-11f), half_from_float(1));
    EXPECT_EQ(half_from_float(1 + 0x1.8p-11f), half_from_float(1 + 0x1p-10f));
    EXPECT_EQ(half_from_float(1 + 0x3p-11f), half_from_float(1 + 0x1p-9f));
    EXPECT_EQ(half_from_float(0x1p-25f), 0);
    EXPECT_EQ(half_from_float(0x1.1p-25f), 1);
    EXPECT_EQ(half_from_float(-0x1.fffp-15f), 0x8400);
}

TEST(EmitterBlocks, ValuesErrByTheirLastBitAtMost) {
    std::vector<Rgb> rows;
    for (int i = -3000; i < 3000; ++i) {
        const float value = std::pow(10.0f, 0.002f * static_cast<float>(i));
        rows.push_back({value, -value, 0});
    }
    Emitters emitters;
    append_emitter(emitters, "a");
    append_block(emitters, 0, 0, rows);
    append_block(emitters, 0, 1, std::vector<Rgb>(3));  // nothing
    ASSERT_EQ(emitters.block.size(), 1u);
    const float largest = rows.back().r;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Rgb value = block_value(emitters.view(), emitters.block[0], i);
        EXPECT_NEAR(value.r, rows[i].r, std::max(0x1p-11f * rows[i].r, 2e-9f * largest));
        EXPECT_EQ(value.g, -value.r);
        EXPECT_EQ(value.b, 0);
    }
}

TEST(EmittersFile, ReturnsEveryValueItWasGivenAndIsAbsentWithoutEmitters) {
    const Asset asset = make_emitter_asset();
    tests::StoredAsset stored(asset);
    const EmittersView& emitters = stored.view().emitters;
    tests::expect_same_bytes(emitters.name_end, asset.emitters.name_end);
    tests::expect_same_bytes(emitters.text, asset.emitters.text);
    tests::expect_same_bytes(emitters.block, asset.emitters.block);
    tests::expect_same_bytes(emitters.own, asset.emitters.own);
    tests::expect_same_bytes(emitters.value, asset.emitters.value);
    EXPECT_EQ(stored.version_of(kEmitSection), 1u);
    EXPECT_EQ(opal_size(asset.view()), stored.stored.bytes().size());
    EXPECT_EQ(emitters.name(1), "Panel");
    EXPECT_EQ(find_emitter(emitters, "Panel"), 1u);
    EXPECT_EQ(find_emitter(emitters, "Pane"), 2u);
    EXPECT_EQ(list_emitters(emitters), "'Lamp', 'Panel'");
    EXPECT_EQ(emitters.blocks_of(1).size(), 2u);
    EXPECT_EQ(emitters.blocks_of(7).size(), 0u);
    EXPECT_EQ(emitters.own_of(0)->radiance, (Rgb{100, 50, 25}));
    EXPECT_EQ(emitters.own_of(1), nullptr);
    EXPECT_EQ(tests::StoredAsset(tests::make_small_asset()).version_of(kEmitSection), 0u);
}

template <class Change>
void expect_refused(const char* what, Change change) {
    EXPECT_THAT(tests::fault_after(make_emitter_asset(), [&](Asset& a) { change(a.emitters); }),
                HasSubstr(what));
}

TEST(EmittersFile, NamesThatAreNoneAreRefused) {
    const char* const bad = "section EMIT, emitter 1: its name is empty";
    expect_refused(bad, [](Emitters& e) { e.name_end[1] = e.name_end[0]; });
    expect_refused(bad, [](Emitters& e) { e.name_end[1] = 100; });
    expect_refused(bad, [](Emitters& e) {
        e.text.resize(300, 'a');
        e.name_end[1] = 300;
    });
    expect_refused("emitter 0: its name has control", [](Emitters& e) { e.text[1] = '\n'; });
    expect_refused("emitter 1: its name stands twice", [](Emitters& e) {
        e = {};
        append_emitter(e, "a");
        append_emitter(e, "a");
    });
    expect_refused("it has 65 emitters; expected 64", [](Emitters& e) {
        e = {};
        for (int i = 0; i < 65; ++i)
            append_emitter(e, std::to_string(i));
    });
}

TEST(EmittersFile, BlocksThatReferToNothingAreRefused) {
    expect_refused("block 0: its primitive or", [](Emitters& e) { e.block[0].primitive = 2; });
    expect_refused("block 2: its primitive or", [](Emitters& e) { e.block[2].emitter = 2; });
    expect_refused("block 2: it is out of order", [](Emitters& e) { e.block[2].emitter = 0; });
    expect_refused("block 1: it is out of order",
                   [](Emitters& e) { std::swap(e.block[0].primitive, e.block[1].primitive); });
    for (const float scale : {-1.0f, std::numeric_limits<float>::infinity(), NAN}) {
        expect_refused("block 1: its scale", [=](Emitters& e) { e.block[1].scale = scale; });
    }
    expect_refused("block 1: its scale", [](Emitters& e) { e.block[1].reserved = 1; });
    expect_refused("block 1: its values", [](Emitters& e) { e.block[1].first_value = 0; });
    expect_refused("block 2: its values", [](Emitters& e) { e.block[2].first_value += 1; });
    expect_refused("block 2: its values", [](Emitters& e) { e.block[2].first_value = UINT64_MAX; });
    expect_refused("block 2: its values", [](Emitters& e) { e.value.pop_back(); });
}

TEST(EmittersFile, OwnLightThatIsNoneIsRefused) {
    expect_refused("own light 0: its primitive or", [](Emitters& e) { e.own[0].primitive = 9; });
    expect_refused("own light 0: its primitive or", [](Emitters& e) { e.own[0].emitter = 9; });
    expect_refused("own light 1: it is out of", [](Emitters& e) { e.own.push_back(e.own[0]); });
    expect_refused("own light 0: its radiance", [](Emitters& e) { e.own[0].radiance.g = -1; });
    expect_refused("own light 0: its radiance", [](Emitters& e) { e.own[0].radiance.b = NAN; });
    expect_refused("own light 0: it uses an image", [](Emitters& e) { e.own[0].image = 1; });
    expect_refused("own light 0: unknown texture wrap",
                   [](Emitters& e) { e.own[0].wrap_v = static_cast<Wrap>(3); });
}

TEST(EmittersFile, ValuesThatAreNotFiniteAreRefusedByTheFullCheck) {
    const auto break_value = [](Asset& asset) { asset.emitters.value[5] = 0x7c01; };
    EXPECT_EQ(tests::fault_after(make_emitter_asset(), break_value), "");
    EXPECT_EQ(tests::fault_after(make_emitter_asset(), break_value, Checks::full),
              "section EMIT, value 5: it is not finite");
}

}  // namespace
}  // namespace opaline::formats
