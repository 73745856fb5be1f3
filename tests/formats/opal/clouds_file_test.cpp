// Cloud layers that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <cstdint>
#include <limits>
#include <string>

#include "formats/opal/check_clouds.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/cloud_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::formats {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using tests::make_cloud_asset;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kEndless = std::numeric_limits<float>::infinity();

void expect_same_clouds(const CloudsView& a, const CloudsView& b) {
    tests::expect_same_bytes(a.records, b.records);
    tests::expect_same_bytes(a.thickness, b.thickness);
    tests::expect_same_bytes(a.ground, b.ground);
    tests::expect_same_bytes(a.value, b.value);
}

TEST(CloudsFile, ReturnsEveryValueInPlaceWithoutAnyPrimitive) {
    for (const bool has_all : {true, false}) {
        const Asset asset = make_cloud_asset({.has_peak = has_all, .has_radiance = has_all});
        tests::StoredAsset stored(asset);
        const AssetView& view = stored.view();
        EXPECT_TRUE(view.primitives.empty() && view.position.empty() && view.volumes.empty());
        expect_same_clouds(view.clouds, asset.clouds.view());
        EXPECT_TRUE(stored.holds(view.clouds.records) && stored.holds(view.clouds.thickness));
        EXPECT_TRUE(stored.holds(view.clouds.ground) && stored.holds(view.clouds.value));
        EXPECT_EQ(stored.version_of(kClouSection), 1u);
        EXPECT_EQ(opal_size(asset.view()), stored.stored.bytes().size());
    }
}

TEST(CloudsFile, StandsBesideAllElseAndIsAbsentWithoutLayers) {
    Asset asset = tests::make_small_asset();
    tests::add_volume(asset, {});
    const tests::StoredAsset without(asset);
    EXPECT_TRUE(without.view().clouds.empty());
    EXPECT_EQ(without.version_of(kClouSection), 0u);
    tests::add_layer(asset);
    const tests::StoredAsset stored(asset);
    expect_same_clouds(stored.view().clouds, asset.clouds.view());
    EXPECT_EQ(stored.view().volumes.records.size(), 1u);
    EXPECT_EQ(stored.view().primitives.size(), 2u);
}

// The fault of the fixture's layer after change(Clouds&, LayerRecord&).
template <class Change>
std::string layer_fault(Change change, Checks checks = Checks::structure) {
    return tests::fault_after(
        make_cloud_asset(), [&](Asset& asset) { change(asset.clouds, asset.clouds.records[0]); },
        checks);
}

// Of a change that the check of the structure lets pass.
template <class Change>
std::string table_fault(Change change) {
    EXPECT_EQ(layer_fault(change), "");
    return layer_fault(change, Checks::full);
}

template <class Change>
void expect_layer_fault(const char* what, Change change) {
    EXPECT_THAT(layer_fault([&](Clouds&, LayerRecord& layer) { change(layer); }),
                AllOf(HasSubstr("section CLOU, layer 0: "), HasSubstr(what)));
}

// Sets the number that `field`, a reference to it from the record, gives.
template <class Field>
void expect_refused(const char* what, const std::vector<float>& bad, Field field) {
    for (const float value : bad) {
        SCOPED_TRACE(value);
        expect_layer_fault(what, [&](LayerRecord& layer) { field(layer) = value; });
    }
}

TEST(CloudsFile, PlacesOutOfRangeAreRefusedByName) {
    EXPECT_EQ(layer_fault([](Clouds&, LayerRecord&) {}), "");
    using Layer = LayerRecord;
    const float nan = kNotANumber, inf = kEndless;
    const std::vector<float> beyond{nan, inf, -2e9f}, below{-1e-6f, 2e9f, nan, inf};
    expect_refused("its base at", {-20, -21, nan, inf, 2e9f},
                   [](Layer& l) -> float& { return l.base; });
    expect_refused("its base at", {800, 900, nan, -inf, -2e9f},
                   [](Layer& l) -> float& { return l.ground; });
    for (const std::size_t i : {0u, 1u}) {
        expect_refused("its centre", beyond, [=](Layer& l) -> float& { return l.center[i]; });
        expect_refused("wind", beyond, [=](Layer& l) -> float& { return l.wind[i]; });
        expect_refused("m wide", {0, -1, 1e-4f, 2e9f, nan, inf},
                       [=](Layer& l) -> float& { return l.size[i]; });
    }
    expect_refused("thickness", below, [](Layer& l) -> float& { return l.highest; });
    expect_refused("haze", below, [](Layer& l) -> float& { return l.haze; });
}

TEST(CloudsFile, BandsOutOfRangeAreRefusedByName) {
    using Layer = LayerRecord;
    const float nan = kNotANumber, inf = kEndless;
    expect_refused("its forward peak of", {-0.1f, 1.5708f, nan, inf},
                   [](Layer& l) -> float& { return l.peak_angle; });
    expect_refused("its extinction", {-1e-6f, 2e6f, nan, inf},
                   [](Layer& l) -> float& { return l.band[1].kappa; });
    expect_refused("of the light", {-1e-6f, 1, nan, inf},
                   [](Layer& l) -> float& { return l.band[2].peak_weight; });
    expect_refused("a mean cosine", {-1, 1, nan, inf},
                   [](Layer& l) -> float& { return l.band[0].g; });
    expect_refused("a band has a value", {1, nan},
                   [](Layer& l) -> float& { return l.band[2].reserved; });
}

TEST(CloudsFile, FlagsAndValuesOfLaterVersionsAreRefused) {
    for (const std::uint32_t flags : {0u, 1u, 2u, 3u, 4u, 7u, 256u, 259u}) {
        EXPECT_EQ(layer_fault([=](Clouds&, LayerRecord& l) { l.flags = flags; }), "");
    }
    const char* const later = "only later versions know";
    EXPECT_THAT(layer_fault([](Clouds&, LayerRecord& l) { l.flags = 1u << 31; }), HasSubstr(later));
    EXPECT_THAT(layer_fault([](Clouds& c, LayerRecord& l) { c.records.push_back(l); }),
                HasSubstr("section CLOU: it has 2 layers"));
}

TEST(CloudsFile, FramesThatDoNotExistAreRefusedByName) {
    for (const std::uint32_t frames : {0u, kMaxLayerFrames + 1, 0xffffffffu}) {
        EXPECT_THAT(layer_fault([=](Clouds&, LayerRecord& l) { l.frames = frames; }),
                    HasSubstr("it has " + std::to_string(frames) + " frames of thickness"));
    }
    EXPECT_THAT(layer_fault([](Clouds&, LayerRecord& l) { l.frames = kMaxLayerFrames; }),
                HasSubstr("lie outside their arrays"));
    expect_refused("frames of thickness are", {0, -1, 1e-4f, 2e9f, kNotANumber, kEndless},
                   [](LayerRecord& l) -> float& { return l.frame_seconds; });
    const auto of_one = [](float seconds, std::uint32_t flags) {
        return layer_fault([=](Clouds&, LayerRecord& l) {
            l.frames = 1;
            l.frame_seconds = seconds;
            l.flags = flags;
        });
    };
    EXPECT_EQ(of_one(0, 3), "");
    EXPECT_THAT(of_one(90, 3), HasSubstr("0 of one frame"));
    EXPECT_THAT(of_one(0, LayerRecord::kLoop), HasSubstr("says that they loop"));
}

TEST(CloudsFile, CountsThatDoNotExistAreRefusedByName) {
    for (const std::uint32_t side : {0u, kMaxLayerSide + 1, 0xffffffffu}) {
        EXPECT_THAT(layer_fault([=](Clouds&, LayerRecord& l) { l.columns = side; }),
                    HasSubstr("its thickness has " + std::to_string(side) + " x 3 cells"));
        EXPECT_THAT(layer_fault([=](Clouds&, LayerRecord& l) { l.ground_rows = side; }),
                    HasSubstr("its ground 2 x " + std::to_string(side)));
    }
    expect_layer_fault("1 angles", [](LayerRecord& l) { l.phase_angles = 1; });
    expect_layer_fault("0 depths", [](LayerRecord& l) { l.flux_depths = 0; });
    expect_layer_fault("1 cosines", [](LayerRecord& l) { l.flux_cosines = 1; });
    expect_layer_fault("its glow has 1 angles", [](LayerRecord& l) { l.glow_angles = 1; });
    expect_layer_fault("0 numbers of events", [](LayerRecord& l) { l.glow_events = 0; });
    expect_layer_fault("its glow", [](LayerRecord& l) { l.glow_angles = l.glow_events = 0; });
    expect_layer_fault("of the light", [](LayerRecord& l) { l.peak_angle = 0; });
    expect_layer_fault("its glow", [](LayerRecord& l) {
        l.peak_angle = 0;
        for (LayerBand& band : l.band)
            band.peak_weight = 0;
    });
    expect_layer_fault("1 depths", [](LayerRecord& l) { l.radiance_depths = 1; });
    expect_layer_fault("1 cosines", [](LayerRecord& l) { l.radiance_cosines = 1; });
    expect_layer_fault("0 modes", [](LayerRecord& l) { l.radiance_modes = 0; });
}

TEST(CloudsFile, PartsBeyondTheirArraysAreRefused) {
    const char* const outside = "lie outside their arrays";
    expect_layer_fault(outside, [](LayerRecord& l) { l.first_thickness = 1; });
    expect_layer_fault(outside, [](LayerRecord& l) { l.first_ground = UINT64_MAX; });
    expect_layer_fault(outside, [](LayerRecord& l) { l.first_value = UINT64_MAX - 100; });
    expect_layer_fault(outside, [](LayerRecord& l) { ++l.columns; });
    expect_layer_fault(outside, [](LayerRecord& l) { ++l.ground_rows; });
    expect_layer_fault(outside, [](LayerRecord& l) { ++l.radiance_modes; });
    expect_layer_fault(outside, [](LayerRecord& l) { l.phase_angles = 0xffffffffu; });
    expect_layer_fault("larger than all", [](LayerRecord& l) { l.flux_cosines = 0x40000000u; });
    EXPECT_THAT(layer_fault([](Clouds& c, LayerRecord&) { c.value.pop_back(); }),
                HasSubstr(outside));
    EXPECT_THAT(layer_fault([](Clouds& c, LayerRecord&) { c.thickness.clear(); }),
                HasSubstr(outside));
}

TEST(CloudsFile, TablesOutOfRangeAreRefusedByName) {
    // Tables of the second band begin here; sizes are those of the fixture.
    const LayerRecord layer = make_cloud_asset().clouds.records[0];
    const std::size_t phase = layer.band_values(), glow = phase + layer.phase_angles,
                      t1 = glow + layer.glow_count(), mean_t = t1 + 3 * layer.flux_count(),
                      reflected = mean_t + layer.flux_depths;
    const auto expect_fault = [](std::size_t at, float bad, const char* what) {
        EXPECT_THAT(table_fault([=](Clouds& c, LayerRecord&) { c.value[at] = bad; }),
                    AllOf(HasSubstr("section CLOU, layer 0: band 1: "), HasSubstr(what)))
            << bad;
    };
    for (const float bad : {kNotANumber, kEndless, -kEndless}) {
        expect_fault(phase, bad, "the logarithm of its phase function");
        expect_fault(glow, bad, "its glow");
        for (std::size_t table = 0; table < 3; ++table) {
            expect_fault(t1 + table * layer.flux_count(), bad, "a share of its flux");
        }
        expect_fault(mean_t, bad, "a share of its flux");
        expect_fault(reflected, bad, "its tables of radiance");
        expect_fault(2 * layer.band_values() - 1, bad, "its tables of radiance");
    }
    expect_fault(phase, 41, "the logarithm");
    expect_fault(phase, -101, "the logarithm");
    expect_fault(glow, -1e-3f, "its glow");
    expect_fault(t1, -0.01f, "a share");
    expect_fault(mean_t, 1.01f, "a share");
    expect_fault(reflected, -2e9f, "its tables of radiance");
    EXPECT_EQ(table_fault([=](Clouds& c, LayerRecord&) { c.value[t1] = -1e-4f; }), "");
    EXPECT_THAT(table_fault([](Clouds& c, LayerRecord&) { c.ground[1][3] = 0; }),
                HasSubstr("the last byte of a colour"));
}

}  // namespace
}  // namespace opaline::formats
