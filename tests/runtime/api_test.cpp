#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "tests/runtime/api_test_support.h"
#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;
using testing::HasSubstr;
using tests::LoadedAsset;
using tests::make_asset;

class Api : public testing::Test, protected LoadedAsset {
  protected:
    Api() : LoadedAsset(make_asset(8)) {}
};

// With so many rows a vertex.
formats::Asset make_translucent(std::uint32_t terms) {
    formats::Asset source = make_asset(8);
    formats::PrimitiveRecord& p = source.primitives[0];
    p.shading = formats::Shading::translucent;
    p.eta = 1.4f;
    p.terms = terms;
    p.vertex_count /= terms;
    source.position.resize(p.vertex_count);
    source.normal.resize(p.vertex_count);
    source.base_color.resize(p.vertex_count);
    return source;
}

TEST_F(Api, DescribesTheAsset) {
    EXPECT_EQ(receivers(), 41u);
    EXPECT_EQ(opaline_asset_cubemap_size(asset.get()), 8u);
    ASSERT_EQ(opaline_asset_primitive_count(asset.get()), 1u);
    opaline_primitive_info info{};
    info.struct_size = sizeof info;
    ASSERT_EQ(opaline_asset_primitive(asset.get(), 0, &info), OPALINE_OK);
    EXPECT_EQ(info.node, 4u);
    EXPECT_EQ(info.receiver_count, 41u);
    EXPECT_EQ(info.bands, 3u);
    EXPECT_EQ(info.double_sided, 1u);
    EXPECT_EQ(opaline_asset_primitive(asset.get(), 1, &info), OPALINE_INVALID_ARGUMENT);
    info.struct_size = 3;
    EXPECT_EQ(opaline_asset_primitive(asset.get(), 0, &info), OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("struct_size"));
}

TEST_F(Api, ShadesAsTheLibraryDoes) {
    const formats::Environment map = tests::lat_long_map(64, 32, tests::smooth_sky);
    ASSERT_EQ(opaline_light_set_lat_long(light.get(), &map.pixel[0].r, 64, 32), OPALINE_OK);
    const formats::Asset same = make_asset(8);
    std::vector<Rgb> expected(receivers());
    shade(same.view(), project_environment(map, 8), expected);
    const std::vector<float> out = shaded();
    EXPECT_EQ(std::memcmp(out.data(), expected.data(), out.size() * sizeof(float)), 0);
    shade(same.view(), project_environment(map, 8), expected, {.base_color = false});
    EXPECT_EQ(std::memcmp(shaded(OPALINE_SHADE_WITHOUT_BASE_COLOR).data(), expected.data(),
                          out.size() * sizeof(float)),
              0);
}

TEST_F(Api, OrderOfRotationMapAndSunDoesNotMatter) {
    const formats::Environment map = tests::cube_map(8, tests::smooth_sky);
    const auto turn = tests::matrix(rotation_about_y(0.8f)), identity = tests::matrix({});
    const float direction[3] = {0, 3, 4}, radiance[3] = {1e4f, 1e4f, 9e3f};
    ASSERT_EQ(opaline_light_set_rotation(light.get(), turn.data()), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_cubemap(light.get(), &map.pixel[0].r, 8), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(light.get(), direction, 0.005f, radiance), OPALINE_OK);
    const std::vector<float> first = shaded();

    ASSERT_EQ(opaline_light_clear(light.get()), OPALINE_OK);
    EXPECT_THAT(shaded(), testing::Each(0.0f));
    ASSERT_EQ(opaline_light_set_rotation(light.get(), identity.data()), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_threads(light.get(), 2), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(light.get(), direction, 0.005f, radiance), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_cubemap(light.get(), &map.pixel[0].r, 8), OPALINE_OK);
    EXPECT_NE(shaded(), first);
    ASSERT_EQ(opaline_light_set_rotation(light.get(), turn.data()), OPALINE_OK);
    EXPECT_EQ(shaded(), first);
}

TEST_F(Api, RangesOnSeveralThreadsMakeTheWhole) {
    const float up[3] = {0, 1, 0}, radiance[3] = {10, 10, 10};
    ASSERT_EQ(opaline_light_add_sun(light.get(), up, 0.1f, radiance), OPALINE_OK);
    const std::vector<float> whole = shaded();
    std::vector<float> parts(whole.size());
    std::vector<std::thread> threads;
    for (std::uint32_t first = 0; first < receivers(); first += 10) {
        threads.emplace_back([&, first] {
            const std::uint32_t count = std::min(10u, receivers() - first);
            opaline_shade_range(asset.get(), light.get(), 0, first, count, &parts[3 * first],
                                std::size_t{3} * count);
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(parts, whole);
}

TEST_F(Api, BadArgumentsAreRefusedWithAReasonAndChangeNothing) {
    const float up[3] = {0, 1, 0}, white[3] = {1, 1, 1}, none[3] = {0, 0, 0};
    const float bad[3] = {1, NAN, 1};
    opaline_light* const l = light.get();
    ASSERT_EQ(opaline_light_add_sun(l, up, 0.1f, white), OPALINE_OK);
    const std::vector<float> before = shaded();
    const float shear[9] = {1, 0, 0, 0.1f, 1, 0, 0, 0, 1};
    EXPECT_EQ(opaline_light_set_rotation(l, shear), OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("rotation"));
    std::vector<float> out(std::size_t{3} * receivers());
    const opaline_asset* const a = asset.get();
    EXPECT_THAT(
        (tests::Statuses{
            opaline_light_add_sun(l, none, 0.1f, white), opaline_light_add_sun(l, bad, 0.1f, white),
            opaline_light_add_sun(l, up, 0.1f, bad), opaline_light_add_sun(l, up, 0.0f, white),
            opaline_light_add_sun(l, up, NAN, white), opaline_light_add_sun(l, up, 1.6f, white),
            opaline_light_add_sun(nullptr, up, 0.1f, white),
            opaline_light_set_lat_long(l, bad, 1, 1), opaline_light_set_lat_long(l, white, 0, 1),
            opaline_light_set_lat_long(l, white, 40000, 1), opaline_light_set_cubemap(l, white, 0),
            opaline_light_set_threads(l, 257), opaline_shade(a, l, 128, out.data(), out.size()),
            opaline_shade(a, l, 0, nullptr, out.size()),
            opaline_shade_range(a, l, 0, 41, 1, out.data(), 3),
            opaline_shade_range(a, l, 0, 40, 0xffffffffu, out.data(), 3)}),
        testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(opaline_shade(a, l, 0, out.data(), out.size() - 1), OPALINE_BUFFER_TOO_SMALL);
    EXPECT_EQ(opaline_shade_range(asset.get(), l, 0, 41, 0, out.data(), 0), OPALINE_OK);
    EXPECT_EQ(shaded(), before);
    opaline_asset_release(nullptr);
    opaline_light_release(nullptr);
    EXPECT_EQ(opaline_asset_receiver_count(nullptr), 0u);
}

TEST_F(Api, LightOfAnotherBasisIsRefused) {
    const LoadedAsset other(make_asset(16));
    std::vector<float> out(std::size_t{3} * receivers());
    EXPECT_EQ(opaline_shade(asset.get(), other.light.get(), 0, out.data(), out.size()),
              OPALINE_INVALID_ARGUMENT);
}

TEST_F(Api, DamagedFilesAreRefusedWhereverTheDamageIs) {
    EXPECT_EQ(load_asset(nullptr, 10).status, OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(load_asset(file.data() + 1, file.size - 1).status, OPALINE_INVALID_ARGUMENT);
    for (std::size_t size = 0; size < file.size; size += 61) {
        const auto loaded = load_asset(file.data(), size);
        EXPECT_EQ(loaded.status, OPALINE_BAD_FILE) << size;
        EXPECT_STRNE(opaline_last_error(), "");
    }
    // A flipped bit is refused or, in padding, harmless.
    for (std::size_t at = 0; at < file.size; at += 7) {
        file.data()[at] = static_cast<char>(file.data()[at] ^ 0x10);
        if (const auto loaded = load_asset(file.data(), file.size)) {
            std::vector<float> out(std::size_t{3} * receivers());
            const auto l = create_light(loaded.handle);
            opaline_shade(loaded.handle.get(), l.handle.get(), 0, out.data(), out.size());
        }
        file.data()[at] = static_cast<char>(file.data()[at] ^ 0x10);
    }
}

TEST_F(Api, TranslucentPrimitivesAreShadedFromTheEyeThatIsGiven) {
    const formats::Asset source = make_translucent(4);
    const LoadedAsset translucent(source);
    const opaline_asset* const a = translucent.asset.get();
    opaline_primitive_shading shading{};
    EXPECT_EQ(opaline_asset_primitive_shading(a, 0, &shading), OPALINE_INVALID_ARGUMENT);
    shading.struct_size = sizeof shading;
    ASSERT_EQ(opaline_asset_primitive_shading(a, 0, &shading), OPALINE_OK);
    EXPECT_EQ(shading.shading, std::uint32_t{OPALINE_SHADING_TRANSLUCENT});
    EXPECT_EQ(shading.terms, 4u);
    EXPECT_EQ(shading.eta, 1.4f);
    EXPECT_EQ(opaline_asset_primitive_shading(a, 1, &shading), OPALINE_INVALID_ARGUMENT);
    ASSERT_EQ(opaline_asset_primitive_shading(asset.get(), 0, &shading), OPALINE_OK);
    EXPECT_EQ(shading.shading, std::uint32_t{OPALINE_SHADING_DIFFUSE});
    EXPECT_EQ(shading.eta, 0.0f);

    const formats::Environment map = tests::lat_long_map(64, 32, tests::smooth_sky);
    ASSERT_EQ(opaline_light_set_lat_long(light.get(), &map.pixel[0].r, 64, 32), OPALINE_OK);
    const LightVector vector = project_environment(map, 8);
    const std::uint32_t count = translucent.receivers();
    const float eye[3] = {1, 2, -1};
    const auto expect = [&](std::uint32_t flags, const float* from, const ShadeOptions& options) {
        std::vector<Rgb> expected(count);
        shade(source.view(), vector, expected, options);
        std::vector<float> out(3 * std::size_t{count});
        ASSERT_EQ(opaline_shade_from(a, light.get(), flags, from, 0, count, out.data(), out.size()),
                  OPALINE_OK)
            << opaline_last_error();
        EXPECT_EQ(std::memcmp(out.data(), expected.data(), out.size() * sizeof(float)), 0) << flags;
    };
    const formats::Vec3 at{1, 2, -1};
    expect(0, nullptr, {});
    expect(0, eye, {.eye = at});
    expect(OPALINE_SHADE_WITHOUT_BASE_COLOR, eye, {.base_color = false, .eye = at});
    expect(OPALINE_SHADE_WITHOUT_BASE_COLOR | OPALINE_SHADE_WITHOUT_FRESNEL, eye,
           {.base_color = false, .eye = at, .fresnel = false});
    std::vector<float> out(3 * std::size_t{count});
    const float nowhere[3] = {0, INFINITY, 0};
    EXPECT_EQ(opaline_shade_from(a, light.get(), 0, nowhere, 0, count, out.data(), out.size()),
              OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("eye"));
}

TEST_F(Api, ComponentsAndGlossAreThoseOfTheLibrary) {
    formats::Asset source = make_translucent(5);
    const std::size_t vertices = source.position.size();
    source.primitives[0].flags = formats::PrimitiveRecord::kSeparate;
    source.roughness = {0.5f};
    source.openness.resize(vertices, formats::encode_openness({0, 1, 0}, 0.9f));
    const LoadedAsset glossy(source);
    const opaline_asset* const a = glossy.asset.get();
    opaline_light* const l = glossy.light.get();
    // Map, sun, rotation: all three reach the mirrored light.
    formats::Environment map = tests::lat_long_map(64, 32, tests::smooth_sky);
    map.discs = {{{0, 0.6f, 0.8f}, 0.01f, {900, 800, 700}}};
    ASSERT_EQ(opaline_light_set_lat_long(l, &map.pixel[0].r, 64, 32), OPALINE_OK);
    const float direction[3] = {0, 0.6f, 0.8f}, radiance[3] = {900, 800, 700};
    ASSERT_EQ(opaline_light_add_sun(l, direction, 0.01f, radiance), OPALINE_OK);
    const float turn[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    ASSERT_EQ(opaline_light_set_rotation(l, turn), OPALINE_OK);
    const Rotation rotation{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    const LightVector vector = project_environment(map, 8, rotation);
    const std::uint32_t level = roughness_level(0.5f);
    const SpecularLight specular = prefilter_specular(map, {&level, 1}, rotation, 1);
    const auto expect = [&](std::uint32_t flags, TermSet terms) {
        std::vector<Rgb> expected(vertices);
        shade(source.view(), vector, expected, {.terms = terms, .specular = &specular});
        std::vector<float> out(3 * vertices);
        ASSERT_EQ(opaline_shade(a, l, flags, out.data(), out.size()), OPALINE_OK)
            << opaline_last_error();
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_NEAR(out[3 * i + 1], expected[i].g, 1e-5f * (1 + expected[i].g)) << flags;
        }
    };
    expect(0, TermSet::all);
    expect(OPALINE_SHADE_WITHOUT_SPECULAR, TermSet::all & ~TermSet::specular);
    expect(OPALINE_SHADE_WITHOUT_SINGLE | OPALINE_SHADE_WITHOUT_SPECULAR, TermSet::multiple);
    expect(OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SPECULAR, TermSet::single);
    expect(OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SINGLE, TermSet::specular);
    // A light of an asset without gloss has nothing to mirror.
    std::vector<float> out(3 * vertices);
    EXPECT_EQ(opaline_shade(a, light.get(), 0, out.data(), out.size()), OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("roughness"));
    EXPECT_EQ(opaline_shade(a, light.get(), OPALINE_SHADE_WITHOUT_SPECULAR, out.data(), out.size()),
              OPALINE_OK);
    // Merged rows cannot be taken apart.
    source.primitives[0].flags = 0;
    source.primitives[0].terms = 4;
    const LoadedAsset merged(source);
    EXPECT_EQ(
        opaline_shade(merged.asset.get(), l, OPALINE_SHADE_WITHOUT_SINGLE, out.data(), out.size()),
        OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("--separate-terms"));
}

}  // namespace
}  // namespace opaline::runtime
