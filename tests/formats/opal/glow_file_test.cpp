// Light of volumes that is written comes back; damaged or impossible light is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "formats/opal/shared_exponent.h"
#include "tests/formats/opal/glow_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/section_damage.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_glow_asset;

TEST(SharedExponent, EachChannelErrsByLittleOfTheLargest) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> exponent(-15, 15), mantissa(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const float scale = std::exp2(exponent(generator));
        const Rgb c{scale * mantissa(generator), scale * mantissa(generator),
                    scale * mantissa(generator)};
        const float most = std::max({c.r, c.g, c.b});
        const Rgb back = unpack_shared(pack_shared(c));
        const float allowed = most * 0x1p-9f + 0x1p-25f;
        EXPECT_NEAR(back.r, c.r, allowed);
        EXPECT_NEAR(back.g, c.g, allowed);
        EXPECT_NEAR(back.b, c.b, allowed);
    }
    for (const Rgb exact :
         {Rgb{0, 0, 0}, Rgb{1, 0.5f, 0.25f}, Rgb{kLargestShared, 0, 128}, Rgb{0x1p-24f, 0, 0}}) {
        EXPECT_EQ(unpack_shared(pack_shared(exact)), exact);
    }
    EXPECT_EQ(unpack_shared(pack_shared({1e30f, -1, 0})), (Rgb{kLargestShared, 0, 0}));
    EXPECT_EQ(unpack_shared(pack_shared({1.9999f, 0, 0})), (Rgb{2, 0, 0}));
}

TEST(GlowFile, ReturnsEveryValueItWasGivenAndIsAbsentWithoutLight) {
    const Asset asset = make_glow_asset();
    tests::AlignedBytes stored(tests::encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    const GlowView& glow = loaded->view.volumes.glow;
    tests::expect_same_bytes(glow.record, asset.volumes.glow.view().record);
    tests::expect_same_bytes(glow.brick, asset.volumes.glow.view().brick);
    tests::expect_same_bytes(glow.code, asset.volumes.glow.view().code);
    tests::expect_same_bytes(glow.value, asset.volumes.glow.view().value);
    EXPECT_EQ(loaded->sections.back().id, kGlowSection);
    EXPECT_EQ(loaded->sections.back().version, 1u);
    ASSERT_EQ(glow.of_volume(1).size(), 1u);
    EXPECT_EQ(glow.of_volume(1).data(), &glow.record[1]);
    EXPECT_EQ(glow.own_of(0), &glow.record[0]);
    EXPECT_EQ(glow.own_of(1), nullptr);
    EXPECT_TRUE(glow.of_volume(2).empty());

    tests::AlignedBytes plain(tests::encode(tests::make_volume_asset()));
    const auto other = read_opal(plain.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(other);
    EXPECT_TRUE(other->view.volumes.glow.empty());
}

template <class Change>
std::string glow_fault(Change change, Checks checks = Checks::structure) {
    Asset asset = make_glow_asset();
    change(asset.volumes.glow);
    return tests::fault_of(asset, checks);
}

TEST(GlowFile, RecordsOfWhatIsNotThereAreRefused) {
    EXPECT_EQ(glow_fault([](Glow&) {}), "");
    const char* const absent = "section GLOW, record 1: its volume or emitter does not exist";
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].volume = 2; }), HasSubstr(absent));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].emitter = 1; }), HasSubstr(absent));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].volume = 0; }), HasSubstr("stands twice"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.brick[0] = 2; }), HasSubstr("a brick that its volume"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].first_brick = 1; }), HasSubstr("lie outside"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].terms = 9; }), HasSubstr("overlap"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].first_value = 0; }), HasSubstr("overlap"));
}

TEST(GlowFile, NumbersThatAreNoneAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].terms = 2; }), HasSubstr("2 terms"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].value_scale = -1; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([&](Glow& g) { g.record[0].code_scale = nan; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].code_scale = 3e38f; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.value[5] = 0x7c00; }, Checks::full),
                HasSubstr("section GLOW, value 5: it is not finite"));
    EXPECT_EQ(glow_fault([](Glow& g) { g.value[5] = 0x7c00; }), "");
}

TEST(GlowFile, EveryTruncationOfTheSectionIsRefused) {
    tests::expect_section_truncations_refused(make_glow_asset(), kGlowSection);
}

TEST(GlowFile, EveryFlippedByteIsFoundByTheFullCheck) {
    tests::expect_flipped_bytes_found(make_glow_asset(), kGlowSection);
}

TEST(GlowFile, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    const auto [refused, accepted, refused_for_values] = tests::forge_section(
        make_glow_asset(), kGlowSection, 48 + 2 * sizeof(GlowRecord), [](const AssetView& asset) {
            double sum = 0;
            const GlowView& glow = asset.volumes.glow;
            for (const GlowRecord& record : glow.record) {
                for (std::uint32_t b = 0; b < record.brick_count; ++b) {
                    const std::size_t brick = record.first_brick + b;
                    sum +=
                        asset.volumes
                            .density_scale[asset.volumes.records[record.volume].first_brick_number +
                                           glow.brick[brick]];
                    for (std::size_t i = 0; i < kBrickVoxels; ++i) {
                        sum += unpack_shared(glow.code[brick * kBrickVoxels + i]).g;
                    }
                }
                const std::size_t values =
                    std::size_t{3} * record.terms * asset.volumes.records[record.volume].node_count;
                for (std::size_t i = 0; i < values; ++i) {
                    sum += glow.value[record.first_value + i];
                }
                sum += asset.emitters.name(record.emitter).size();
            }
            volatile double used = sum;
            (void)used;
        });
    EXPECT_GT(refused, 200u);
    EXPECT_GT(accepted, 500u);
    (void)refused_for_values;
}

}  // namespace
}  // namespace opaline::formats
