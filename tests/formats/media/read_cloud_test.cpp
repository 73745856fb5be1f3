#include "formats/media/read_cloud.h"

#include <numbers>

#include "formats/image/png.h"
#include "tests/formats/media/cloud_text.h"

namespace opaline::tests {
namespace {

using formats::CloudEntry;
using formats::CloudLayer;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Code = std::array<std::uint8_t, 4>;

CloudEntry read_layer(const std::string& entry) {
    const TemporaryFolder folder;
    return cloud_of(read_cloud_in(folder, entry));
}

TEST(ReadCloud, EveryKeyArrives) {
    const CloudEntry cloud = read_layer(R"("procedural": {"type": "waves", "scale": 900,
        "coverage": 0.75, "seed": 4, "resolution": 128}, "thickness": 250, "N0": 2e8, "r_e": 9e-6,
        "gamma": 6, "substance": "ice",
        "fidelity": "paper", "base": 1500, "ground_height": -20, "size": [10000, 12000],
        "center": [100, -200], "wind": [5, -7], "repeat": true, "visibility": 30000,
        "forward_angle": 4.5, "ground_albedo": [0, 1, 0.2])");
    EXPECT_EQ(cloud.where, "clouds > 0");
    ASSERT_TRUE(cloud.shape);
    EXPECT_EQ(cloud.shape->type, formats::HeightFieldShape::Type::waves);
    EXPECT_EQ(cloud.shape->scale, 900);
    EXPECT_EQ(cloud.shape->coverage, 0.75);
    EXPECT_EQ(cloud.shape->seed, 4u);
    EXPECT_EQ(cloud.shape->resolution, 128u);
    EXPECT_EQ(cloud.thickness, 250);
    const CloudLayer& layer = cloud.layer;
    EXPECT_EQ(layer.name, "layer 1 (waves)");
    EXPECT_EQ(layer.droplets, 2e8);
    EXPECT_EQ(layer.effective_radius, 9e-6);
    EXPECT_EQ(layer.gamma, 6);
    EXPECT_TRUE(layer.ice);
    EXPECT_TRUE(layer.paper);
    EXPECT_EQ(layer.base, 1500);
    EXPECT_EQ(layer.ground, -20);
    EXPECT_EQ(layer.size, glm::dvec2(10000, 12000));
    EXPECT_EQ(layer.center, glm::dvec2(100, -200));
    EXPECT_EQ(layer.wind, glm::dvec2(5, -7));
    EXPECT_TRUE(layer.repeats);
    EXPECT_EQ(layer.visibility, 30000);
    EXPECT_NEAR(layer.peak_angle.value(), 4.5 * std::numbers::pi / 180, 1e-12);
    ASSERT_EQ(layer.ground_albedo.size(), 1u);
    EXPECT_EQ(layer.ground_albedo[0], (Code{0, 255, 124, 255}));  // sRGB of .2: .4845
}

TEST(ReadCloud, WithoutAPictureOrAFormulaALayerIsEven) {
    const CloudEntry cloud = read_layer(R"("thickness": 120)");
    EXPECT_FALSE(cloud.shape);
    EXPECT_EQ(cloud.layer.name, "layer 1 (even)");
    EXPECT_TRUE(is_sound(cloud));
    EXPECT_THAT(cloud.layer.thickness, ::testing::Each(120.0f));
}

TEST(ReadCloud, BoundsThemselvesAreInRange) {
    for (const char* entry :
         {R"("N0": 1e3)", R"("N0": 1e13, "r_e": 1e-7)", R"("r_e": 1e-4, "N0": 1e9)",
          R"("gamma": 0.1)", R"("gamma": 1e4)", R"("substance": "water")",
          R"("base": 1e6, "ground_height": 999999.8)", R"("base": -999999, "ground_height": -1e6)",
          R"("size": [1, 1e7])", R"("center": [1e7, -1e7])", R"("wind": [-1e4, 1e4])",
          R"("visibility": 1)", R"("visibility": 1e7)", R"("forward_angle": 0)",
          R"("forward_angle": 20)", R"("ground_albedo": [0, 0, 0])", R"("repeat": false)"}) {
        EXPECT_TRUE(is_sound(read_layer(R"("thickness": 1e5, )" + std::string(entry)))) << entry;
    }
    for (const char* formula : {R"("scale": 1e7)", R"("coverage": 0)", R"("coverage": 1)",
                                R"("seed": 0)", R"("seed": 2147483647)", R"("seed": 1e3)",
                                R"("resolution": 2048)", R"("resolution": 16, "scale": 5000)"}) {
        EXPECT_TRUE(is_sound(
            read_layer(R"("procedural": {"type": "waves", )" + std::string(formula) + "}")))
            << formula;
    }
}

TEST(ReadCloud, FaultsAreNamedWithTheirPlaceAndWhatIsExpected) {
    const std::vector<CloudFault> cases = {
        {R"("hight_field": "a.exr")", "clouds > 0 > hight_field", "no such key"},
        {R"("N0": 999)", "clouds > 0 > N0", "from 1000.0 to"},
        {R"("N0": 1.1e13)", "clouds > 0 > N0", "from 1000.0 to"},
        {R"("N0": [3e8])", "clouds > 0 > N0", "a number"},
        {R"("r_e": 9e-8)", "clouds > 0 > r_e", "from 1e-07 to 0.0001"},
        {R"("r_e": 7)", "clouds > 0 > r_e", "from 1e-07 to 0.0001"},
        {R"("gamma": 0.09)", "clouds > 0 > gamma", "from 0.1 to 10000.0"},
        {R"("gamma": 10001)", "clouds > 0 > gamma", "from 0.1 to 10000.0"},
        {R"("N0": 1e12, "r_e": 2e-5)", "clouds > 0", "more than a hundredth of the space"},
        {R"("substance": "steam")", "clouds > 0 > substance", "one of water, ice"},
        {R"("fidelity": "high")", "clouds > 0 > fidelity", "one of physical, paper"},
        {R"("fidelity": true)", "clouds > 0 > fidelity", "one of physical, paper"},
        {R"("base": 1e7)", "clouds > 0 > base", "from -1000000.0 to"},
        {R"("base": 0)", "clouds > 0 > base", "not above the ground"},
        {R"("ground_height": 1000)", "clouds > 0 > ground_height", "not above the ground"},
        {R"("ground_height": 999.95)", "clouds > 0 > ground_height", "0.1 m above"},
        {R"("ground_height": "sea")", "clouds > 0 > ground_height", "a number"},
        {R"("size": [0.5, 100])", "clouds > 0 > size", "two numbers [x, z], each from 1.0"},
        {R"("size": [100, 1e8])", "clouds > 0 > size", "two numbers [x, z]"},
        {R"("size": 100)", "clouds > 0 > size", "two numbers [x, z]"},
        {R"("size": [1, 2, 3])", "clouds > 0 > size", "two numbers [x, z]"},
        {R"("center": [1e8, 0])", "clouds > 0 > center", "two numbers [x, z]"},
        {R"("wind": [0, "x"])", "clouds > 0 > wind", "two numbers [x, z]"},
        {R"("wind": [0, 20000])", "clouds > 0 > wind", "two numbers [x, z]"},
        {R"("repeat": 1)", "clouds > 0 > repeat", "true or false"},
        {R"("visibility": 0)", "clouds > 0 > visibility", "from 1.0 to"},
        {R"("visibility": 1e8)", "clouds > 0 > visibility", "from 1.0 to"},
        {R"("forward_angle": -1)", "clouds > 0 > forward_angle", "from 0.0 to 20.0"},
        {R"("forward_angle": 21)", "clouds > 0 > forward_angle", "from 0.0 to 20.0"},
        {R"("ground_albedo": [0, 0, 1.1])", "clouds > 0 > ground_albedo", "from 0.0 to 1.0"},
        {R"("ground": "nowhere.png")", "clouds > 0 > ground", ""},
        {R"("ground": "../a.png")", "clouds > 0 > ground", "leaves"},
        {R"("ground": "media.json")", "clouds > 0 > ground", "neither PNG nor JPEG"},
        {R"("ground": 3)", "clouds > 0 > ground", "a text"},
        {R"("ground": "a.png", "ground_albedo": [0, 0, 0])", "clouds > 0 > ground_albedo",
         "contradicts ground"},
        {R"("base": 2, "base": 3)", "JSON", "'base' stands twice"},
    };
    const TemporaryFolder folder;
    expect_cloud_faults(folder, R"("thickness": 100, )", cases);
}

TEST(ReadCloud, ALayerIsAnObjectOfAnArrayOfOneAtMost) {
    EXPECT_THAT(faults(read_text_as_media(R"({"clouds": {}})")), HasSubstr("not an array"));
    EXPECT_THAT(faults(read_text_as_media(R"({"clouds": [1]})")),
                AllOf(HasSubstr("clouds > 0"), HasSubstr("not an object")));
    EXPECT_THAT(faults(read_text_as_media(R"({"clouds": [{"thickness": 1}, {"thickness": 1}]})")),
                HasSubstr("this version simulates one"));
    EXPECT_TRUE(read_text_as_media(R"({"clouds": []})"));
    EXPECT_TRUE(read_text_as_media(R"({"materials": {}, "volumes": [], "clouds": []})"));
}

TEST(ReadCloud, TheGroundsPictureKeepsItsCodesAndLosesItsAlpha) {
    const TemporaryFolder folder;
    const formats::Image8 image{3, 2, {1,  2,  3,  255, 4,  5,  6,  0, 7,  8,  9,  128,
                                       10, 11, 12, 255, 13, 14, 15, 1, 16, 17, 18, 255}};
    ASSERT_TRUE(formats::write_png(folder / "ground.png", image));
    const auto media = read_cloud_in(folder, R"("thickness": 1, "ground": "ground.png")");
    const CloudLayer layer = cloud_of(media).layer;
    EXPECT_EQ(layer.ground_columns, 3u);
    EXPECT_EQ(layer.ground_rows, 2u);
    ASSERT_EQ(layer.ground_albedo.size(), 6u);
    EXPECT_EQ(layer.ground_albedo[0], (Code{1, 2, 3, 255}));
    EXPECT_EQ(layer.ground_albedo[1], (Code{4, 5, 6, 255}));
    EXPECT_EQ(layer.ground_albedo[5], (Code{16, 17, 18, 255}));
    EXPECT_EQ(media->inputs.size(), 2u) << "the picture is an input";
    const formats::Image8 wide{4097, 1, std::vector<std::uint8_t>(4 * 4097, 255)};
    ASSERT_TRUE(formats::write_png(folder / "ground.png", wide));
    EXPECT_THAT(faults(read_cloud_in(folder, R"("thickness": 1, "ground": "ground.png")")),
                AllOf(HasSubstr("clouds > 0 > ground"), HasSubstr("more than 4096")));
}

}  // namespace
}  // namespace opaline::tests
