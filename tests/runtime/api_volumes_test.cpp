// The C interface of volumes: the same numbers as the C++ functions, errors by name, many threads.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "runtime/volumes/volume_sample.h"
#include "tests/runtime/api_volumes_support.h"
#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;
using formats::Vec3;
using test::VolumeHandles;
using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Some of them miss.
std::vector<opaline_march_ray> make_rays(std::size_t count) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> value(0, 1);
    std::vector<opaline_march_ray> rays(count);
    for (opaline_march_ray& ray : rays) {
        ray = {{0.3f + value(generator), 2 * value(generator), -1},
               {0.2f * value(generator), -0.1f * value(generator), 3},
               0,
               value(generator) < 0.5f ? kInfinity : 2 * value(generator)};
    }
    return rays;
}

class ApiVolumes : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(opaline_light_set_lat_long(light, &sky.pixel[0].r, 64, 32), OPALINE_OK);
    }
    void update(std::uint32_t flags = 0, std::uint32_t threads = 1) {
        ASSERT_EQ(opaline_volume_light_update(volume_light, asset, light, flags, threads),
                  OPALINE_OK)
            << opaline_last_error();
    }
    std::vector<opaline_march_result> march(const opaline_march_options* options = nullptr) {
        std::vector<opaline_march_result> results(rays.size());
        EXPECT_EQ(opaline_volumes_march(asset, volume_light, options, rays.data(),
                                        static_cast<std::uint32_t>(rays.size()), results.data()),
                  OPALINE_OK)
            << opaline_last_error();
        return results;
    }
    formats::Environment sky = tests::lat_long_map(64, 32, tests::smooth_sky);
    formats::Asset source = test::make_smoky_asset(test::kSmokySize);
    formats::VolumesView volumes = source.volumes.view();
    VolumeHandles handles{source};
    opaline_asset* asset = handles.asset.get();
    opaline_light* light = handles.light.get();
    opaline_volume_light* volume_light = handles.volume_light.get();
    std::vector<opaline_march_ray> rays = make_rays(300);
    LightVector vector = project_environment(sky, test::kSmokySize);
};

bool same(const float found[3], Rgb expected) {
    return std::memcmp(found, &expected, sizeof expected) == 0;
}

Vec3 unit(const float v[3]) {
    const double x = static_cast<double>(v[0]), y = static_cast<double>(v[1]),
                 z = static_cast<double>(v[2]), norm = std::hypot(x, y, z);
    return {static_cast<float>(x / norm), static_cast<float>(y / norm),
            static_cast<float>(z / norm)};
}

Vec3 point(const float v[3]) {
    return {v[0], v[1], v[2]};
}

bool same_bytes(const std::vector<opaline_march_result>& a,
                const std::vector<opaline_march_result>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

TEST_F(ApiVolumes, DescribeThemselves) {
    EXPECT_EQ(opaline_asset_volume_count(nullptr), 0u);
    ASSERT_EQ(opaline_asset_volume_count(asset), 2u);
    EXPECT_EQ(opaline_asset_receiver_count(asset), 0u);
    opaline_volume_info info{};
    EXPECT_EQ(opaline_asset_volume(asset, 1, &info), OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("struct_size"));
    info.struct_size = sizeof info;
    ASSERT_EQ(opaline_asset_volume(asset, 1, &info), OPALINE_OK);
    EXPECT_EQ(info.bricks, 8u);
    EXPECT_EQ(info.nodes, 125u);
    EXPECT_EQ(info.node_terms, 5u);
    EXPECT_EQ(info.bands, 1u);
    // Voxels of density from 2 to 14, and the ramp of one voxel around them.
    EXPECT_NEAR(info.corner[0][0], 0.7f + 0.1f, 1e-6f);
    EXPECT_NEAR(info.corner[0][1], 0.1f, 1e-6f);
    EXPECT_NEAR(info.corner[7][0], 0.7f + 1.5f, 1e-6f);
    EXPECT_NEAR(info.corner[7][2], 1.5f, 1e-6f);
    EXPECT_EQ(opaline_asset_volume(asset, 2, &info), OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("no volume of that index"));
    EXPECT_EQ(opaline_asset_volume(asset, 0, nullptr), OPALINE_INVALID_ARGUMENT);
}

TEST_F(ApiVolumes, AbsorbUntilTheyAreRelit) {
    for (const opaline_march_result& result : march()) {
        EXPECT_TRUE(same(result.radiance, {}));
    }
    EXPECT_LT(march().front().transmittance[0], 1.0f);
}

TEST_F(ApiVolumes, MarchAsTheLibraryDoesWithEveryComponentAndOption) {
    const auto expect = [&](std::uint32_t flags, TermSet terms) {
        update(flags);
        const VolumeLight lit_by = relight_volumes(volumes, vector, {.terms = terms, .threads = 1});
        const LitVolumes lit = light_volumes(volumes, lit_by);
        const opaline_march_options fine{sizeof fine, 0.25f, 0.2f, 3};
        for (const opaline_march_options* options :
             {(const opaline_march_options*)nullptr, &fine}) {
            const MarchOptions same_options =
                options == nullptr ? MarchOptions{} : MarchOptions{0.25f, 0.2f};
            const auto results = march(options);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const MarchResult expected = march_volumes(
                    lit,
                    {point(rays[i].origin), unit(rays[i].direction),
                     static_cast<double>(rays[i].begin), static_cast<double>(rays[i].end)},
                    same_options);
                ASSERT_TRUE(same(results[i].radiance, expected.radiance)) << i;
                ASSERT_TRUE(same(results[i].transmittance, expected.transmittance)) << i;
            }
        }
    };
    expect(OPALINE_SHADE_DEFAULT, TermSet::all);
    EXPECT_GT(march().front().radiance[0], 0.0f);
    expect(OPALINE_SHADE_WITHOUT_SINGLE, TermSet::volume_multiple);
    expect(OPALINE_SHADE_WITHOUT_MULTIPLE, TermSet::volume_single);
    expect(OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SINGLE, TermSet::none);
}

TEST_F(ApiVolumes, SampleAsTheLibraryDoes) {
    update();
    const VolumeLight lit_by = relight_volumes(volumes, vector);
    const LitVolumes lit = light_volumes(volumes, lit_by);
    const std::vector<opaline_sample_point> points{
        {{0.8f, 0.8f, 0.8f}, {0, 0, -5}}, {{1.2f, 0.7f, 0.9f}, {1, 2, 3}}, {{9, 9, 9}, {1, 0, 0}}};
    std::vector<opaline_sample_result> results(points.size());
    ASSERT_EQ(opaline_volumes_sample(asset, volume_light, points.data(), 3, results.data()),
              OPALINE_OK);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const VolumeSample expected =
            sample_volumes(lit, point(points[i].position), unit(points[i].to_eye));
        EXPECT_TRUE(same(results[i].extinction, expected.extinction)) << i;
        EXPECT_TRUE(same(results[i].scattered, expected.scattered)) << i;
    }
    EXPECT_GT(results[0].scattered[1], 0.0f);
    EXPECT_EQ(results[2].extinction[0], 0.0f);
}

TEST_F(ApiVolumes, LightsAreCopiedAndThreadsChangeNoBit) {
    update();
    const auto first = march();
    ASSERT_EQ(opaline_light_clear(light), OPALINE_OK);
    EXPECT_TRUE(same_bytes(march(), first));
    update();
    EXPECT_FALSE(same_bytes(march(), first));
    ASSERT_EQ(opaline_light_set_lat_long(light, &sky.pixel[0].r, 64, 32), OPALINE_OK);
    for (const std::uint32_t threads : {0u, 3u}) {
        update(0, threads);
        const opaline_march_options options{sizeof options, 0.5f, 1e-3f, threads};
        EXPECT_TRUE(same_bytes(march(&options), first)) << threads;
    }
}

TEST_F(ApiVolumes, MayBeReadFromManyThreadsWhileAnotherLightIsUpdated) {
    update();
    const auto whole = march();
    std::vector<opaline_march_result> parts(rays.size());
    std::vector<opaline_status> statuses(6, OPALINE_OUT_OF_MEMORY);
    std::vector<std::thread> threads;
    for (std::uint32_t t = 0; t < 6; ++t) {
        threads.emplace_back([&, t] {
            statuses[t] = opaline_volumes_march(asset, volume_light, nullptr, &rays[50 * t], 50,
                                                &parts[50 * t]);
        });
    }
    const auto other = create_volume_light(handles.asset);
    EXPECT_EQ(opaline_volume_light_update(other.handle.get(), asset, light, 0, 2), OPALINE_OK);
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_THAT(statuses, testing::Each(OPALINE_OK));
    EXPECT_TRUE(same_bytes(parts, whole));
}

TEST_F(ApiVolumes, BadRaysAndPointsAreRefusedByNumberAndNothingIsWritten) {
    update();
    opaline_march_result result{{7, 7, 7}, {7, 7, 7}};
    const opaline_march_ray good = rays[0];
    const auto refused = [&](const opaline_march_ray& ray, const char* fault) {
        const opaline_march_ray pair[2] = {good, ray};
        opaline_march_result results[2] = {result, result};
        EXPECT_EQ(opaline_volumes_march(asset, volume_light, nullptr, pair, 2, results),
                  OPALINE_INVALID_ARGUMENT);
        EXPECT_THAT(opaline_last_error(), testing::AllOf(HasSubstr("ray 1"), HasSubstr(fault)));
        EXPECT_EQ(std::memcmp(&results[0], &result, sizeof result), 0);
    };
    refused({{0, NAN, 0}, {0, 0, 1}, 0, 1}, "origin");
    refused({{0, 0, kInfinity}, {0, 0, 1}, 0, 1}, "origin");
    refused({{0, 0, 0}, {0, 0, 0}, 0, 1}, "direction");
    refused({{0, 0, 0}, {0, NAN, 0}, 0, 1}, "direction");
    refused({{0, 0, 0}, {0, 0, 1}, -1, 1}, "begin");
    refused({{0, 0, 0}, {0, 0, 1}, kInfinity, kInfinity}, "begin");
    refused({{0, 0, 0}, {0, 0, 1}, 0, NAN}, "end");
    const auto refused_point = [&](const opaline_sample_point& at, const char* fault) {
        opaline_sample_result sample{};
        EXPECT_EQ(opaline_volumes_sample(asset, volume_light, &at, 1, &sample),
                  OPALINE_INVALID_ARGUMENT);
        EXPECT_THAT(opaline_last_error(), testing::AllOf(HasSubstr("point 0"), HasSubstr(fault)));
    };
    refused_point({{0, -kInfinity, 0}, {0, 0, 1}}, "position");
    refused_point({{0, 0, 0}, {0, 0, 0}}, "eye");
    // An end before the begin, as a depth buffer may give, is no error.
    const opaline_march_ray none{{0.8f, 0.8f, -1}, {0, 0, 1}, 2, 1};
    ASSERT_EQ(opaline_volumes_march(asset, volume_light, nullptr, &none, 1, &result), OPALINE_OK);
    EXPECT_TRUE(same(result.radiance, {}));
    EXPECT_TRUE(same(result.transmittance, {1, 1, 1}));
}

TEST_F(ApiVolumes, BadArgumentsAreRefusedWithAReasonAndChangeNothing) {
    update();
    const auto before = march();
    opaline_volume_light* out = nullptr;
    const auto update_with = opaline_volume_light_update;
    EXPECT_THAT((tests::Statuses{opaline_volume_light_create(nullptr, &out),
                                 opaline_volume_light_create(asset, nullptr),
                                 update_with(nullptr, asset, light, 0, 1),
                                 update_with(volume_light, nullptr, light, 0, 1),
                                 update_with(volume_light, asset, nullptr, 0, 1),
                                 update_with(volume_light, asset, light, 0, 257)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_THAT(opaline_last_error(), HasSubstr("256 threads"));
    opaline_volume_light_release(nullptr);
    EXPECT_EQ(update_with(volume_light, asset, light, OPALINE_SHADE_WITHOUT_SPECULAR, 1),
              OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("flags"));
    opaline_march_result result{};
    EXPECT_EQ(opaline_volumes_march(asset, volume_light, nullptr, rays.data(), 1, nullptr),
              OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_volumes_march(asset, volume_light, nullptr, nullptr, 0, nullptr), OPALINE_OK);
    EXPECT_EQ(opaline_volumes_sample(asset, volume_light, nullptr, 0, nullptr), OPALINE_OK);
    const auto refused = [&](const opaline_march_options& options, const char* fault) {
        EXPECT_EQ(opaline_volumes_march(asset, volume_light, &options, rays.data(), 1, &result),
                  OPALINE_INVALID_ARGUMENT);
        EXPECT_THAT(opaline_last_error(), HasSubstr(fault));
    };
    constexpr std::size_t size = sizeof(opaline_march_options);
    refused({0, 0.5f, 0, 1}, "struct_size");
    refused({size, 0, 0, 1}, "step");
    refused({size, NAN, 0, 1}, "step");
    refused({size, 9, 0, 1}, "step");
    refused({size, 0.5f, 1, 1}, "transmittance");
    refused({size, 0.5f, -0.1f, 1}, "transmittance");
    refused({size, 0.5f, 0, 257}, "256 threads");
    EXPECT_TRUE(same_bytes(march(), before));
}

TEST_F(ApiVolumes, OtherAssetsAndLightsOfAnotherBasisAreRefused) {
    const VolumeHandles again(source), other(test::make_smoky_asset(16));
    opaline_march_result result{};
    opaline_sample_result sample{};
    const opaline_sample_point at{{0, 0, 0}, {0, 0, 1}};
    for (const VolumeHandles* each : {&again, &other}) {
        opaline_asset* const a = each->asset.get();
        EXPECT_EQ(opaline_volumes_march(a, volume_light, nullptr, rays.data(), 1, &result),
                  OPALINE_INVALID_ARGUMENT);
        EXPECT_THAT(opaline_last_error(), HasSubstr("another asset"));
        EXPECT_EQ(opaline_volumes_sample(a, volume_light, &at, 1, &sample),
                  OPALINE_INVALID_ARGUMENT);
        EXPECT_EQ(opaline_volume_light_update(volume_light, a, each->light.get(), 0, 1),
                  OPALINE_INVALID_ARGUMENT);
    }
    EXPECT_EQ(opaline_volume_light_update(volume_light, asset, other.light.get(), 0, 1),
              OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), HasSubstr("cube map size"));
    // A light of the same file, loaded twice, fits.
    EXPECT_EQ(opaline_volume_light_update(volume_light, asset, again.light.get(), 0, 1),
              OPALINE_OK);
}

TEST_F(ApiVolumes, AnAssetReleasedAndLoadedAgainIsAnother) {
    handles.asset.reset();
    auto loaded = load_asset(handles.file.data(), handles.file.size);
    ASSERT_TRUE(loaded);
    opaline_march_result result{};
    EXPECT_EQ(
        opaline_volumes_march(loaded.handle.get(), volume_light, nullptr, rays.data(), 1, &result),
        OPALINE_INVALID_ARGUMENT);
    handles.volume_light.reset();
}

TEST(ApiWithoutVolumes, NothingIsMet) {
    const VolumeHandles handles(test::make_smoky_asset(16));
    EXPECT_EQ(opaline_asset_volume_count(handles.asset.get()), 0u);
    EXPECT_EQ(opaline_volume_light_update(handles.volume_light.get(), handles.asset.get(),
                                          handles.light.get(), 0, 0),
              OPALINE_OK);
    const opaline_march_ray ray{{0, 0, 0}, {0, 0, 1}, 0, kInfinity};
    opaline_march_result result{};
    ASSERT_EQ(opaline_volumes_march(handles.asset.get(), handles.volume_light.get(), nullptr, &ray,
                                    1, &result),
              OPALINE_OK);
    EXPECT_TRUE(same(result.radiance, {}));
    EXPECT_TRUE(same(result.transmittance, {1, 1, 1}));
}

}  // namespace
}  // namespace opaline::runtime
