#include "formats/image/load_environment.h"

#include <OpenEXR/ImfEnvmap.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "tests/formats/image/image_files.h"
#include "tests/support/assets.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;

constexpr float kPi = std::numbers::pi_v<float>;

// A smooth radiance that tells every direction from every other.
Rgb radiance(Vec3 d) {
    return {1.0f + 0.9f * d.x, 1.0f + 0.9f * d.y, 1.0f + 0.9f * d.z};
}

Image filled(std::uint32_t width, std::uint32_t height,
             const std::function<Vec3(std::uint32_t, std::uint32_t)>& direction) {
    Image image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            image.pixel.push_back(radiance(normalize(direction(x, y))));
        }
    }
    return image;
}

std::vector<Vec3> directions() {
    std::vector<Vec3> result;
    for (int i = 0; i < 400; ++i) {  // a spiral over the sphere
        const float y = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 400.0f;
        const float phi = 2.39996f * static_cast<float>(i), r = std::sqrt(1 - y * y);
        result.push_back({r * std::cos(phi), y, r * std::sin(phi)});
    }
    return result;
}

// Largest difference between the loaded map and `radiance`.
float worst(const LoadedEnvironment& loaded) {
    float largest = 0;
    for (const Vec3 d : directions()) {
        const Rgb a = sample_map(loaded.environment, d), b = radiance(d);
        largest =
            std::max({largest, std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    }
    return largest;
}

LoadedEnvironment load(const std::string& bytes) {
    return must(decode_environment(as_bytes(bytes), "env"));
}

// 256 x 128, with +X in the centre.
Image lat_long() {
    return filled(256, 128, [](std::uint32_t x, std::uint32_t y) -> Vec3 {
        const float phi = kPi * ((static_cast<float>(x) + 0.5f) / 128.0f - 1.0f);
        const float theta = kPi * (static_cast<float>(y) + 0.5f) / 128.0f;
        return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
    });
}

TEST(LoadEnvironment, LatLongWithoutAttributeHasPlusXInTheCentre) {
    const Image image = lat_long();
    const LoadedEnvironment loaded = load(make_exr(image));
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_EQ(loaded.environment.pixel, image.pixel);
    EXPECT_LT(worst(loaded), 0.015f);  // half a pixel at the poles, where rows end
}

// OpenEXR's own functions say which direction each of its pixels shows.
TEST(LoadEnvironment, OpenExrLatLongAttributeAgreesWithOpenExr) {
    const Imath::Box2i window({0, 0}, {256, 128});
    const Image image = filled(257, 129, [&](std::uint32_t x, std::uint32_t y) -> Vec3 {
        const auto d = OPENEXR_IMF_NAMESPACE::LatLongMap::direction(
            window, {static_cast<float>(x), static_cast<float>(y)});
        return {d.x, d.y, d.z};
    });
    const LoadedEnvironment loaded = load(make_exr(image, {.envmap = Envmap::lat_long}));
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_EQ(loaded.environment.width, 256u);  // without the repeated column
    EXPECT_TRUE(loaded.environment.rows_include_poles);
    EXPECT_LT(worst(loaded), 3e-4f);  // linear interpolation: (2 pi / 256)^2 / 8 per axis
}

TEST(LoadEnvironment, OpenExrCubeAttributeAgreesWithOpenExr) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    const int n = 64;
    const Imath::Box2i window({0, 0}, {n - 1, 6 * n - 1});
    Image image{n, 6 * n, std::vector<Rgb>(n * 6 * n, {-1, -1, -1})};
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i < n * n; ++i) {
            const auto name = static_cast<imf::CubeMapFace>(face);
            const Imath::V2f in_face(static_cast<float>(i % n), static_cast<float>(i / n));
            const Imath::V3f d = imf::CubeMap::direction(name, window, in_face);
            const Imath::V2f at = imf::CubeMap::pixelPosition(name, window, in_face);
            const auto index = std::lround(at.y) * n + std::lround(at.x);
            image.pixel[static_cast<std::size_t>(index)] = radiance(normalize({d.x, d.y, d.z}));
        }
    }
    const LoadedEnvironment loaded = load(make_exr(image, {.envmap = Envmap::cube}));
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_EQ(loaded.environment.layout, Environment::Layout::cube);
    EXPECT_LT(worst(loaded), 0.02f);  // a texel of 1/32 across edges, which are nearest-neighbour
}

TEST(LoadEnvironment, CubeStripsAreOpenGlFacesInEitherDirection) {
    const std::uint32_t n = 16;
    Image column{n, 6 * n, {}};
    for (std::uint32_t i = 0; i < 6 * n * n; ++i) {
        column.pixel.push_back(radiance(texel_direction(n, i / (n * n), i / n % n, i % n)));
    }
    Image row{6 * n, n, std::vector<Rgb>(6 * n * n)};
    for (std::uint32_t i = 0; i < 6 * n * n; ++i) {
        row.pixel[(i / n % n) * 6 * n + i / (n * n) * n + i % n] = column.pixel[i];
    }
    const LoadedEnvironment a = load(make_exr(column)), b = load(make_exr(row));
    EXPECT_EQ(a.environment.layout, Environment::Layout::cube);
    EXPECT_EQ(a.environment.width, n);
    EXPECT_EQ(a.environment.pixel, column.pixel);
    EXPECT_EQ(b.environment.layout, Environment::Layout::cube);
    EXPECT_EQ(b.environment.pixel, column.pixel);
    EXPECT_TRUE(a.warnings.empty() && b.warnings.empty());
}

TEST(LoadEnvironment, WrittenEnvironmentsReadBackInEveryConvention) {
    const Image image = lat_long();
    Environment environment;
    environment.width = 256;
    environment.height = 128;
    environment.pixel = image.pixel;
    const auto path = temporary("env.exr");
    ASSERT_TRUE(write_exr(path, environment));
    EXPECT_EQ(load(read_bytes(path)).environment.pixel, image.pixel);
    ASSERT_TRUE(write_exr(path, environment, Envmap::lat_long));
    const LoadedEnvironment theirs = load(read_bytes(path));
    EXPECT_TRUE(theirs.warnings.empty());
    EXPECT_LT(worst(theirs), 0.015f);
    ASSERT_TRUE(write_exr(path, theirs.environment));  // and resampled back
    const LoadedEnvironment back = load(read_bytes(path));
    EXPECT_FALSE(back.environment.rows_include_poles);
    EXPECT_LT(worst(back), 0.015f);
    std::filesystem::remove(path);
    environment.discs.push_back({});
    EXPECT_EQ(write_exr(path, environment).error().kind, ErrorKind::usage);
}

TEST(LoadEnvironment, ImpossibleRadianceIsRepairedAndCounted) {
    Image image{8, 4, std::vector<Rgb>(32, {1, 2, 3})};
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    image.pixel[0] = {nan, -1, inf};
    image.pixel[1] = {nan, -inf, 50};
    const LoadedEnvironment loaded = load(make_exr(image));
    EXPECT_EQ(loaded.environment.pixel[0], (Rgb{0, 0, 50}));
    EXPECT_EQ(loaded.environment.pixel[1], (Rgb{0, 0, 50}));
    EXPECT_EQ(loaded.environment.pixel[2], (Rgb{1, 2, 3}));
    ASSERT_EQ(loaded.warnings.size(), 3u);
    EXPECT_THAT(loaded.warnings[0].fault, HasSubstr("2 of 96 values are NaN"));
    EXPECT_THAT(loaded.warnings[1].fault, HasSubstr("2 of 96 values are negative"));
    EXPECT_THAT(loaded.warnings[2].fault, HasSubstr("1 of 96 values are infinite"));

    image.pixel[0] = {3e38f, 3e38f, inf};
    float sum = 0;
    for (const Rgb& c : load(make_exr(image)).environment.pixel) {
        sum += c.r + c.g + c.b;
    }
    EXPECT_TRUE(std::isfinite(sum));
}

// Lossy compression leaves some: a thousandth of the light is below what a bake errs by.
TEST(LoadEnvironment, NegativeLightThatDoesNotMatterIsDroppedWithoutAWord) {
    Image image{8, 4, std::vector<Rgb>(32, {1, 1, 1})};
    image.pixel[7].g = -0.05f;
    const LoadedEnvironment loaded = load(make_exr(image));
    EXPECT_EQ(loaded.environment.pixel[7], (Rgb{1, 0, 1}));
    EXPECT_TRUE(loaded.warnings.empty());
    image.pixel[7].g = -0.5f;
    EXPECT_EQ(load(make_exr(image)).warnings.size(), 1u);
}

TEST(LoadEnvironment, OddShapesAreTakenWithAWarningAndWrongAttributesRefused) {
    EXPECT_EQ(load(make_exr(ramp(10, 10))).warnings.size(), 1u);
    EXPECT_TRUE(load(make_exr(ramp(10, 5), {.envmap = Envmap::lat_long})).warnings.empty());
    const auto refused = [](const Image& image, Envmap envmap) {
        return refusal(decode_environment(as_bytes(make_exr(image, {.envmap = envmap})), "env"));
    };
    EXPECT_THAT(refused(ramp(10, 5), Envmap::cube), HasSubstr("expected n x 6n"));
    EXPECT_THAT(refused(ramp(1, 5), Envmap::lat_long), HasSubstr("at least 2 x 2"));
}

TEST(LoadEnvironment, OtherFilesAreRefusedByContent) {
    const auto refused = [](const std::string& bytes) {
        return refusal(decode_environment(as_bytes(bytes), "env.exr"));
    };
    EXPECT_THAT(refused(""), HasSubstr("is empty"));
    EXPECT_THAT(refused("hello"), HasSubstr("neither an OpenEXR nor a Radiance HDR"));
    EXPECT_THAT(refused("\x89PNG\r\n\x1a\n"), HasSubstr("is a PNG image"));
    EXPECT_EQ(load_environment("/nonexistent.exr").error().kind, ErrorKind::bad_input);
}

TEST(LoadEnvironment, AssetEnvironmentsLoadWithNothingWorseThanNegativeTexels) {
    OPALINE_ASSET(folder, "env");
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const LoadedEnvironment loaded = must(load_environment(entry.path()));
        for (const Diagnostic& warning : loaded.warnings) {
            EXPECT_THAT(warning.fault, HasSubstr("values are negative, taken as 0"))
                << entry.path();
        }
        EXPECT_EQ(loaded.environment.width, 2 * loaded.environment.height);
        double mean = 0;
        for (const Rgb& c : loaded.environment.pixel) {
            mean += static_cast<double>(luminance(c));
        }
        mean /= static_cast<double>(loaded.environment.pixel.size());
        EXPECT_GT(mean, 1e-3) << entry.path();
        EXPECT_LT(mean, 1e3) << entry.path();
        ++count;
    }
    EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace opaline::formats
