#include "formats/media/read_thickness.h"

#include <limits>

#include "tests/formats/image/image_files.h"
#include "tests/formats/media/cloud_text.h"
#include "tests/support/float_traps.h"

namespace opaline::tests {
namespace {

using formats::CloudEntry;
using formats::ExrStyle;
using formats::Image;
using formats::Result;
using formats::Rgb;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ReadThickness : public testing::Test {
  protected:
    Result<formats::MediaFile> read(const Image& image, const ExrStyle& style = {.is_grey = true},
                                    const std::string& more = "") const {
        write_text(folder_ / "layer.exr", make_exr(image, style));
        return read_cloud_in(folder_, R"("height_field": "layer.exr")" + more);
    }
    const TemporaryFolder folder_;
};

Image grey_image(std::uint32_t width, std::uint32_t height, const std::vector<float>& values) {
    const UntrappedFloats any_value;  // the other channels, which count for nothing, may not fit
    Image image{width, height, {}};
    for (const float value : values) {
        image.pixel.push_back({value, 2 * value, 3 * value});
    }
    return image;
}

TEST_F(ReadThickness, RowsOfTheImageGoTowardPlusZInMetres) {
    const Image image = grey_image(3, 2, {0, 100, 200, 300, 400, 500});
    const auto media = read(image);
    const CloudEntry cloud = cloud_of(media);
    EXPECT_EQ(cloud.layer.name, "layer 1 (layer.exr)");
    EXPECT_FALSE(cloud.shape);
    EXPECT_EQ(cloud.layer.columns, 3u);
    EXPECT_EQ(cloud.layer.rows, 2u);
    EXPECT_THAT(cloud.layer.thickness, ElementsAre(0, 100, 200, 300, 400, 500));
    EXPECT_EQ(media->inputs.size(), 2u) << "the image is an input";
    const CloudEntry scaled = cloud_of(read(image, {.is_grey = true}, R"(, "thickness": 0.5)"));
    EXPECT_THAT(scaled.layer.thickness, ElementsAre(0, 50, 100, 150, 200, 250));
}

TEST_F(ReadThickness, WithoutAChannelYItIsRed) {
    const CloudEntry cloud = cloud_of(read(grey_image(2, 2, {1, 2, 3, 4}), {.has_alpha = true}));
    EXPECT_THAT(cloud.layer.thickness, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(faults(read(grey_image(2, 2, {1, 2, 3, 4}), {.prefix = "other."})),
                AllOf(HasSubstr("clouds > 0 > height_field"), HasSubstr("no channel Y or R")));
}

TEST_F(ReadThickness, WhatNoLayerCanBeIsNamedWithItsTexel) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const struct {
        float value;
        const char* fault;
    } cases[] = {{kNaN, "is not a number"},    {-kNaN, "is not a number"},
                 {-1e-30f, "is negative"},     {-kInf, "is negative"},
                 {kInf, "is infinite"},        {1.1e5f, "is more than 1e5 m"},
                 {3e38f, "is more than 1e5 m"}};
    for (const auto& c : cases) {
        EXPECT_THAT(faults(read(grey_image(3, 2, {0, 1, 2, 3, c.value, 5}))),
                    AllOf(HasSubstr("clouds > 0 > height_field"),
                          HasSubstr("column 1 of row 1 " + std::string(c.fault))))
            << c.value;
    }
    const CloudEntry zero = cloud_of(read(grey_image(2, 2, {-0.0f, 1e5f, 1e-45f, 0})));
    EXPECT_FALSE(std::signbit(zero.layer.thickness[0]));
    EXPECT_TRUE(is_sound(zero));
}

TEST_F(ReadThickness, ScalesAreBoundedToo) {
    const Image image = grey_image(2, 2, {0, 1, 2, 3});
    for (const char* metres : {"0", "-1", "1.1e5", "\"1\"", "1e-7"}) {
        EXPECT_THAT(
            faults(read(image, {.is_grey = true}, R"(, "thickness": )" + std::string(metres))),
            AllOf(HasSubstr("clouds > 0 > thickness"), HasSubstr("from 1e-06 to 100000.0")))
            << metres;
    }
    EXPECT_THAT(faults(read(image, {.is_grey = true}, R"(, "thickness": 5e4)")),
                HasSubstr("more than 1e5 m"));
}

TEST_F(ReadThickness, SidesHaveFrom2To4096Texels) {
    EXPECT_THAT(faults(read(grey_image(1, 3, {1, 2, 3}))), HasSubstr("one texel on a side"));
    EXPECT_THAT(faults(read(grey_image(3, 1, {1, 2, 3}))), HasSubstr("one texel on a side"));
    EXPECT_THAT(faults(read(grey_image(4097, 2, std::vector<float>(2 * 4097, 1)))),
                HasSubstr("the limit is 4096"));
    EXPECT_TRUE(is_sound(cloud_of(read(grey_image(4096, 2, std::vector<float>(2 * 4096, 1))))));
}

TEST_F(ReadThickness, AListOfPicturesIsAFrameAfterFrame) {
    for (const char* name : {"a.exr", "b.exr", "c.exr"}) {
        const auto first = static_cast<float>(name[0]);
        write_text(folder_ / name,
                   make_exr(grey_image(3, 2, {first, 1, 2, 3, 4, 5}), {.is_grey = true}));
    }
    write_text(folder_ / "wide.exr",
               make_exr(grey_image(2, 3, {0, 1, 2, 3, 4, 5}), {.is_grey = true}));
    const std::string list = R"("height_field": ["a.exr", "b.exr", "c.exr"], "frame_seconds": )";
    const auto media = read_cloud_in(folder_, list + "30");
    const formats::CloudLayer layer = cloud_of(media).layer;
    EXPECT_TRUE(is_sound(cloud_of(media)));
    EXPECT_EQ(media->inputs.size(), 4u);
    EXPECT_EQ(layer.name, "layer 1 (a.exr and 2 more)");
    EXPECT_EQ(layer.frames, 3u);
    EXPECT_EQ(layer.frame_seconds, 30);
    EXPECT_FALSE(layer.loops);
    EXPECT_EQ(layer.columns, 3u);
    EXPECT_THAT(layer.thickness,
                ElementsAre(97, 1, 2, 3, 4, 5, 98, 1, 2, 3, 4, 5, 99, 1, 2, 3, 4, 5));
    EXPECT_TRUE(cloud_of(read_cloud_in(folder_, list + R"(30, "loop": true)")).layer.loops);
    const formats::CloudLayer one =
        cloud_of(read_cloud_in(folder_, R"("height_field": ["a.exr"])")).layer;
    EXPECT_EQ(one.frames, 1u);
    EXPECT_EQ(one.frame_seconds, 0);

    const std::vector<CloudFault> cases = {
        {R"("height_field": ["a.exr", "b.exr"])", "clouds > 0", "how long each picture"},
        {R"("height_field": ["a.exr", "b.exr"], "frame_seconds": 0)", "frame_seconds", "from 0.01"},
        {R"("height_field": ["a.exr", "b.exr"], "frame_seconds": 1, "loop": 1)", "loop", "true or"},
        {R"("height_field": ["a.exr", "wide.exr"], "frame_seconds": 1)", "height_field > 1",
         "2 x 3 texels, the first one has 3 x 2"},
        {R"("height_field": ["a.exr", "none.exr"], "frame_seconds": 1)", "height_field > 1", ""},
        {R"("height_field": [])", "height_field", "a list of 1 to 4096 texts"},
        {R"("height_field": ["a.exr", 3])", "height_field", "a list of 1 to 4096 texts"},
        {R"("height_field": "a.exr", "frame_seconds": 3)", "frame_seconds", "one picture only"},
        {R"("height_field": ["a.exr"], "loop": true)", "loop", "one picture only"},
        {R"("thickness": 3, "loop": true)", "loop", "no height_field"},
    };
    expect_cloud_faults(folder_, "", cases);
}

TEST_F(ReadThickness, AllFramesTogetherAreBounded) {
    write_text(folder_ / "a.exr",
               make_exr(grey_image(130, 130, std::vector<float>(130 * 130, 1)), {.is_grey = true}));
    std::string names = "\"a.exr\"";
    for (int i = 1; i < 4096; ++i) {
        names += ",\"a.exr\"";
    }
    EXPECT_THAT(
        faults(read_cloud_in(folder_, R"("frame_seconds": 1, "height_field": [)" + names + "]")),
        AllOf(HasSubstr("height_field > 0"), HasSubstr("4096 frames of 130 x 130 texels")));
}

TEST_F(ReadThickness, FormulasEvolveOverAPeriodOfFrames) {
    const auto evolving = [&](const std::string& evolution) {
        return read_cloud_in(folder_, R"("procedural": {"type": "waves", "resolution": 128,
            "scale": 4000, "evolution": )" +
                                          evolution + "}");
    };
    const CloudEntry cloud = cloud_of(evolving(R"({"period": 1200, "frames": 20})"));
    EXPECT_TRUE(is_sound(cloud));
    EXPECT_EQ(cloud.shape->frames, 20u);
    EXPECT_EQ(cloud.layer.frame_seconds, 60);
    EXPECT_TRUE(cloud.layer.loops);
    EXPECT_EQ(cloud_of(evolving("{}")).shape->frames, 16u);
    EXPECT_EQ(cloud_of(evolving("{}")).layer.frame_seconds, 225);
    const struct {
        const char *evolution, *place, *fault;
    } cases[] = {{"3", "evolution", "not an object"},
                 {R"({"speed": 3})", "evolution > speed", "no such key"},
                 {R"({"period": 0})", "evolution > period", "from 1.0"},
                 {R"({"frames": 3})", "evolution > frames", "from 4 to 256"},
                 {R"({"frames": 257})", "evolution > frames", "from 4 to 256"}};
    for (const auto& c : cases) {
        EXPECT_THAT(faults(evolving(c.evolution)), AllOf(HasSubstr(c.place), HasSubstr(c.fault)))
            << c.evolution;
    }
    EXPECT_THAT(faults(read_cloud_in(folder_, R"("procedural": {"type": "waves",
        "resolution": 2048, "evolution": {"frames": 17}})")),
                AllOf(HasSubstr("evolution > frames"), HasSubstr("17 frames")));
}

TEST_F(ReadThickness, DamagedImagesGiveASoundLayerOrAMessage) {
    const std::string whole =
        make_exr(grey_image(5, 4, std::vector<float>(20, 250)), {.is_half = true, .is_grey = true});
    const auto read_damaged = [&](const std::string& bytes) {
        write_text(folder_ / "layer.exr", bytes);
        const auto media = read_cloud_in(folder_, R"("height_field": "layer.exr")");
        if (!media) {
            EXPECT_THAT(faults(media), HasSubstr("clouds > 0 > height_field"));
        }
        return !media || is_sound(media->clouds.at(0));
    };
    for (std::size_t size = 0; size < whole.size(); size += 3) {
        ASSERT_TRUE(read_damaged(whole.substr(0, size))) << size;
    }
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 11) {
        std::string damaged = whole;
        damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
        ASSERT_TRUE(read_damaged(damaged)) << bit;
    }
}

TEST_F(ReadThickness, FaultsOfKeysAreNamed) {
    const std::vector<CloudFault> cases = {
        {"", "clouds > 0", "how thick"},
        {R"("thickness": 0)", "clouds > 0 > thickness", "from 1e-06"},
        {R"("height_field": "nowhere.exr")", "clouds > 0 > height_field", ""},
        {R"("height_field": "media.json")", "clouds > 0 > height_field", "not an OpenEXR file"},
        {R"("height_field": "../layer.exr")", "clouds > 0 > height_field", "leaves"},
        {R"("height_field": [1])", "clouds > 0 > height_field", "a text"},
        {R"("height_field": "a.exr", "procedural": {"type": "waves"})", "clouds > 0 > procedural",
         "contradicts height_field"},
        {R"("procedural": "waves")", "clouds > 0 > procedural", "not an object"},
        {R"("procedural": {})", "clouds > 0 > procedural", "type is missing"},
        {R"("procedural": {"type": "flat"})", "procedural > type", "cellular, waves"},
        {R"("procedural": {"type": "waves", "hight": 3})", "procedural > hight", "no such key"},
        {R"("procedural": {"type": "waves", "scale": 0})", "procedural > scale", "from 1.0"},
        {R"("procedural": {"type": "waves", "coverage": 1.1})", "procedural > coverage", "0.0 to"},
        {R"("procedural": {"type": "waves", "seed": 1.5})", "procedural > seed", "whole number"},
        {R"("procedural": {"type": "waves", "seed": -1})", "procedural > seed", "whole number"},
        {R"("procedural": {"type": "waves", "resolution": 15})", "procedural > resolution",
         "a whole number from 16 to 2048"},
        {R"("procedural": {"type": "waves", "resolution": 2049})", "procedural > resolution",
         "a whole number from 16 to 2048"},
        {R"("procedural": {"type": "waves", "resolution": 16})", "procedural > scale",
         "four texels"},
        {R"("procedural": {"type": "waves"}, "thickness": -5)", "clouds > 0 > thickness", "from"},
    };
    expect_cloud_faults(folder_, "", cases);
}

}  // namespace
}  // namespace opaline::tests
