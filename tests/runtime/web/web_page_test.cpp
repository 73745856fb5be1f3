// The files of a page.
#include "runtime/web/web_page.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/map_geometry.h"
#include "runtime/web/data_script.h"
#include "runtime/web/divide_light.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

TEST(DataScript, Base64IsThatOfTheStandard) {
    const std::string pairs[][2] = {{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"},
                                    {"\xff\xfe\xfb", "//77"}};
    for (const auto& [bytes, text] : pairs) {
        EXPECT_EQ(base64_of(std::as_bytes(std::span<const char>(bytes))), text);
    }
}

// The reader of page/data.js, which the pictures of pages test.
std::vector<std::uint16_t> unpack(std::span<const std::byte> bytes, std::size_t width,
                                  std::size_t count) {
    std::vector<std::uint16_t> values(count);
    std::size_t used = 0;
    const auto number = [&](unsigned bits) {
        unsigned value = 0;
        for (; bits > 0; --bits, ++used) {
            value = 2 * value + (std::to_integer<unsigned>(bytes[used / 8]) >> (7 - used % 8) & 1u);
        }
        return value;
    };
    unsigned k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 16 == 0) k = number(4);
        unsigned folded = 0;
        if (k != 15) {
            while (number(1) == 1)
                ++folded;
            folded = (folded << k) + number(k);
        }
        const int a = i % (3 * width) >= 3 ? values[i - 3] : 0;
        const int b = i >= 3 * width ? values[i - 3 * width] : 0;
        const bool has_both = i % (3 * width) >= 3 && i >= 3 * width;
        const int guess =
            has_both ? std::clamp(a + b - values[i - 3 * width - 3], std::min(a, b), std::max(a, b))
                     : a + b;
        const int left_over =
            folded % 2 == 1 ? -static_cast<int>(folded + 1) / 2 : static_cast<int>(folded / 2);
        values[i] = static_cast<std::uint16_t>(guess + left_over);
    }
    return values;
}

TEST(PackedImage, ComesBackWithoutLossAndIsSmallWhereItIsSmooth) {
    const std::size_t width = 64, count = 3 * width * 37 - 3;  // no whole number of blocks
    std::vector<std::uint16_t> smooth(count), noise(count), flat(count, 7);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < count; ++i) {
        smooth[i] = static_cast<std::uint16_t>(1000 * (i % 3) + i / 3 % width * 5 + i / 300);
        state = 1664525 * state + 1013904223;
        noise[i] = static_cast<std::uint16_t>(state >> 16);
    }
    const auto packed_bytes = [&](const std::vector<std::uint16_t>& values) {
        const std::vector<std::byte> packed = pack_image(values, width);
        EXPECT_EQ(unpack(packed, width, count), values);
        return packed.size();
    };
    EXPECT_LT(packed_bytes(smooth), count / 2);
    EXPECT_LT(packed_bytes(flat), count / 16);
    EXPECT_LT(packed_bytes(noise), 5 * count / 2);
    EXPECT_TRUE(pack_image({}, 1).empty());
}

TEST(DataScript, LiteralsEndNeitherTheirStringNorTheirScript) {
    EXPECT_EQ(script_literal("a\"b\\c\n"), "\"a\\u0022b\\u005cc\\u000a\"");
    EXPECT_EQ(script_literal("</script>&"), "\"\\u003c/script\\u003e\\u0026\"");
    EXPECT_EQ(script_literal("Bäume"), "\"Bäume\"");
}

TEST(WebPage, AssetsThatAPageDoesNotShowAreRefused) {
    const auto fault_of = [](const formats::Asset& asset) {
        const PageLight lights[] = {{"white", {}}};
        const auto page = make_web_page(asset.view(), lights, "a", "a.opal", 0);
        EXPECT_FALSE(page);
        EXPECT_EQ(page.error().kind, formats::ErrorKind::bad_input);
        return page.error().diagnostics[0].fault;
    };
    formats::Asset asset = test::make_asset(8, 8);
    EXPECT_THAT(fault_of(asset),
                testing::HasSubstr("neither surfaces nor volumes nor a cloud layer"));
    asset.volumes.records.resize(kMostPageVolumes + 1);
    EXPECT_THAT(fault_of(asset), testing::HasSubstr("a page draws at most 4"));
}

TEST(WebPage, FilesAreAlikeForAnyNumberOfThreadsAndKnownAsThoseOfAPage) {
    formats::Asset asset = test::make_asset(8, 8);
    test::add_primitive(asset, test::make_sphere({0, 0, 0}, 1, 8, 6), {.bands = 3});
    const PageLight lights[] = {{"sky", tests::lat_long_map(64, 32, test::two_lights)},
                                {"none", {}}};
    const auto one = make_web_page(asset.view(), lights, "a", "a.opal", 1);
    const auto many = make_web_page(asset.view(), lights, "a", "a.opal", 7);
    ASSERT_TRUE(one && many);
    ASSERT_EQ(one->size(), many->size());
    for (std::size_t i = 0; i < one->size(); ++i) {
        EXPECT_EQ((*one)[i].name, (*many)[i].name);
        EXPECT_EQ((*one)[i].text, (*many)[i].text) << (*one)[i].name;
        EXPECT_TRUE(is_page_file((*one)[i].name)) << (*one)[i].name;
    }
    EXPECT_FALSE(is_page_file("notes.txt"));
    EXPECT_FALSE(is_page_file("light-a.js"));
}

// The flux of a sun in a few pixels stands in points, all other in the cube map.
TEST(DividedLight, FluxOfASunInTheMapIsKept) {
    const formats::Vec3 sun = normalize(formats::Vec3{0.3f, 0.8f, 0.5f});
    const double radiance = 5000;
    const formats::Environment map = tests::lat_long_map(1024, 512, [&](formats::Vec3 d) {
        return dot(d, sun) > 0.9999f ? formats::Rgb{5000, 5000, 5000} : formats::Rgb{1, 1, 1};
    });
    const std::vector<double> edges = row_edges(map);
    double of_sun = 0;
    for (std::uint32_t i = 0; i < map.pixel.size(); ++i) {
        const bool is_sun = map.pixel[i].r > 1;
        of_sun += is_sun ? radiance * cell_solid_angle(map, edges, i % 1024, i / 1024) : 0;
    }
    const DividedLight light = divide_light(map, 0);
    double points = 0, cube = 0;
    for (std::size_t i = 0; i < light.points.size(); i += 6) {
        points += static_cast<double>(light.points[i + 3]);
        EXPECT_GT(
            light.points[i] * sun.x + light.points[i + 1] * sun.y + light.points[i + 2] * sun.z,
            0.999f);
    }
    const std::vector<double> solid_angle = formats::texel_solid_angles(kPageTexels);
    for (std::size_t j = 0; j < light.cube.size(); ++j) {
        cube += static_cast<double>(light.cube[j].r) * solid_angle[j % solid_angle.size()];
        EXPECT_LT(light.cube[j].r, 0.1 * radiance);
    }
    EXPECT_GT(points, 0.9 * of_sun);
    EXPECT_NEAR(points + cube, of_sun + 4 * std::numbers::pi, 2e-3 * of_sun);
}

}  // namespace
}  // namespace opaline::runtime
