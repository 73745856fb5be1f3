#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include "formats/opal/spherical_harmonics.h"
#include "runtime/api_support.h"
#include "tests/runtime/api_test_support.h"
#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;
using tests::matrix;

class ApiLight : public testing::Test, protected tests::LoadedAsset {
  protected:
    ApiLight() : LoadedAsset(tests::make_asset(16)) {}
    std::vector<float> coefficients(const LightHandle& of) const {
        std::vector<float> rgb(std::size_t{18} * size * size);
        EXPECT_EQ(opaline_light_get_coefficients(of.get(), rgb.data(), rgb.size()), OPALINE_OK);
        return rgb;
    }
    std::vector<float> coefficients() const { return coefficients(light); }
    std::size_t size = 16;
};

Rotation tilted() {
    const Vec3 x = formats::normalize({0.6f, 0.5f, -0.4f});
    const Vec3 z = formats::normalize(cross(x, Vec3{0, 1, 0}));
    return {x, cross(z, x), z};
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference += std::pow(double{a[i]} - double{b[i]}, 2);
        norm += std::pow(double{b[i]}, 2);
    }
    return std::sqrt(difference / norm);
}

// Edges of sixty times their surroundings, and a sun of one pixel.
formats::Environment harsh_sky() {
    formats::Environment map = tests::lat_long_map(512, 256, [](Vec3 d) {
        const Rgb sky = tests::smooth_sky(d);
        return std::abs(d.x - 0.3f) < 0.05f && std::abs(d.y - 0.5f) < 0.05f ? 60 * sky : sky;
    });
    map.pixel[70 * 512 + 100] = {2e4f, 2e4f, 2e4f};
    return map;
}

TEST_F(ApiLight, TurnedWhileItMovesItErrsLittleAndAtRestNotAtAll) {
    for (const std::uint32_t n : {16u, 32u}) {
        const LoadedAsset loaded(tests::make_asset(n));
        size = n;
        const formats::Environment map = harsh_sky();
        const auto turn = matrix(tilted());
        const LightHandle exact = loaded.new_light(), moving = loaded.new_light();
        ASSERT_EQ(opaline_light_set_rotation(exact.get(), turn.data()), OPALINE_OK);
        ASSERT_EQ(opaline_light_set_lat_long(exact.get(), &map.pixel[0].r, 512, 256), OPALINE_OK);
        ASSERT_EQ(opaline_light_set_lat_long(moving.get(), &map.pixel[0].r, 512, 256), OPALINE_OK);
        ASSERT_EQ(opaline_light_turn(moving.get(), turn.data()), OPALINE_OK);
        // Light within half a sample of the border of a texel of 10 samples a side, at n = 32.
        EXPECT_LT(distance(coefficients(moving), coefficients(exact)), 0.01) << n;
        ASSERT_EQ(opaline_light_set_rotation(moving.get(), turn.data()), OPALINE_OK);
        EXPECT_EQ(coefficients(moving), coefficients(exact)) << n;
    }
}

TEST_F(ApiLight, HarmonicsLightAsTheMapThatTheyDescribe) {
    std::array<float, 27> rgb{};
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        rgb[i] = std::sin(static_cast<float>(i));
    }
    rgb[0] = rgb[1] = rgb[2] = 6;  // positive everywhere, so that it can be a map
    const formats::Environment map = tests::lat_long_map(1024, 512, [&](Vec3 w) {
        std::array<float, 9> y;
        formats::eval_spherical_harmonics(w, y);
        Rgb sum;
        for (std::size_t k = 0; k < 9; ++k) {
            sum = sum + y[k] * Rgb{rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2]};
        }
        return sum;
    });
    const LightHandle mapped = new_light();
    ASSERT_EQ(opaline_light_set_lat_long(mapped.get(), &map.pixel[0].r, 1024, 512), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_harmonics(light.get(), rgb.data()), OPALINE_OK);
    EXPECT_LT(distance(coefficients(), coefficients(mapped)), 1e-4);
    const auto turn = matrix(tilted());
    ASSERT_EQ(opaline_light_set_rotation(mapped.get(), turn.data()), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_rotation(light.get(), turn.data()), OPALINE_OK);
    EXPECT_LT(distance(coefficients(), coefficients(mapped)), 1e-4);
}

// Y_0 = 1 / sqrt(4 pi), and 0.488603 x alone shines from +X and, negative, from -X.
TEST_F(ApiLight, HarmonicsHaveTheNormalisationThatTheHeaderStates) {
    const float white[3] = {1, 1, 1};
    std::array<float, 27> rgb{};
    rgb[0] = rgb[1] = rgb[2] = 1 / 0.282095f;
    const LightHandle mapped = new_light();
    ASSERT_EQ(opaline_light_set_lat_long(mapped.get(), white, 1, 1), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_harmonics(light.get(), rgb.data()), OPALINE_OK);
    EXPECT_LT(distance(coefficients(), coefficients(mapped)), 2e-6);
    rgb = {};
    rgb[9] = 1;  // red of Y_3
    ASSERT_EQ(opaline_light_set_harmonics(light.get(), rgb.data()), OPALINE_OK);
    // A face's average times its size is the sum of its texels: the integral of 0.488603 x over
    // face +X.
    double moment = 0;
    const std::vector<Vec3> moments = formats::texel_moments(16);
    for (std::size_t j = 0; j < 256; ++j) {
        moment += double{moments[j].x};
    }
    EXPECT_NEAR(coefficients()[0] * 16, 0.488603 * moment, 1e-5);
    EXPECT_NEAR(coefficients()[std::size_t{3} * 256] * 16, -0.488603 * moment, 1e-5);
}

TEST_F(ApiLight, CoefficientsComeBackAsTheyWereGiven) {
    const formats::Environment map = harsh_sky();
    ASSERT_EQ(opaline_light_set_lat_long(light.get(), &map.pixel[0].r, 512, 256), OPALINE_OK);
    const std::vector<float> given = coefficients();
    const LightHandle other = new_light();
    ASSERT_EQ(opaline_light_set_coefficients(other.get(), given.data(), given.size()), OPALINE_OK);
    EXPECT_LT(distance(coefficients(other), given), 1e-6);
    // Light that is negative in places is light all the same.
    std::vector<float> negative = given;
    for (float& x : negative) {
        x = -x;
    }
    ASSERT_EQ(opaline_light_set_coefficients(other.get(), negative.data(), negative.size()),
              OPALINE_OK);
    EXPECT_LT(distance(coefficients(other), negative), 1e-6);
}

TEST_F(ApiLight, AMovedSunIsASunOfThatPlace) {
    const float up[3] = {0, 1, 0}, side[3] = {1, 0.2f, 0}, white[3] = {9, 9, 9};
    ASSERT_EQ(opaline_light_add_sun(light.get(), up, 0.1f, white), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(light.get(), up, 0.3f, white), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_sun(light.get(), 0, side, 0.2f, white), OPALINE_OK);
    EXPECT_EQ(opaline_light_set_sun(light.get(), 2, side, 0.2f, white), OPALINE_INVALID_ARGUMENT);
    const LightHandle other = new_light();
    ASSERT_EQ(opaline_light_add_sun(other.get(), side, 0.2f, white), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(other.get(), up, 0.3f, white), OPALINE_OK);
    EXPECT_EQ(coefficients(), coefficients(other));
}

TEST_F(ApiLight, WrongUseOfLightsIsRefusedAndChangesNothing) {
    const float up[3] = {0, 1, 0}, white[3] = {9, 9, 9};
    opaline_light* const l = light.get();
    ASSERT_EQ(opaline_light_add_sun(l, up, 0.1f, white), OPALINE_OK);
    const std::vector<float> before = coefficients();
    std::vector<float> some(before.size() + 3);
    const auto identity = matrix({});
    auto bad = matrix({});
    bad[4] = NAN;
    std::array<float, 27> rgb{}, damaged{};
    damaged[26] = INFINITY;
    std::vector<float> with_nan = some;
    with_nan[7] = NAN;
    const std::size_t count = before.size();
    EXPECT_THAT((tests::Statuses{opaline_light_turn(l, bad.data()), opaline_light_turn(l, nullptr),
                                 opaline_light_turn(nullptr, identity.data()),
                                 opaline_light_set_harmonics(l, damaged.data()),
                                 opaline_light_set_harmonics(l, nullptr),
                                 opaline_light_set_harmonics(nullptr, rgb.data()),
                                 opaline_light_set_coefficients(l, some.data(), count + 3),
                                 opaline_light_set_coefficients(l, nullptr, count),
                                 opaline_light_set_coefficients(l, with_nan.data(), count),
                                 opaline_light_get_coefficients(nullptr, some.data(), count + 3),
                                 opaline_light_get_coefficients(l, nullptr, count + 3),
                                 opaline_light_set_sun(l, 0, up, -1, white),
                                 opaline_light_set_sun(nullptr, 0, up, 1, white)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(opaline_light_set_coefficients(l, some.data(), count - 1), OPALINE_BUFFER_TOO_SMALL);
    EXPECT_EQ(opaline_light_get_coefficients(l, some.data(), count - 1), OPALINE_BUFFER_TOO_SMALL);
    EXPECT_EQ(coefficients(), before);
}

TEST_F(ApiLight, WhoComesWhileAnotherChangesItIsToldSo) {
    const float up[3] = {0, 1, 0}, white[3] = {9, 9, 9};
    std::vector<float> rgb(std::size_t{18} * size * size);
    std::vector<float> radiance(std::size_t{3} * receivers());
    const auto identity = matrix({});
    const std::array<float, 27> harmonics{};
    opaline_light* const l = light.get();
    const auto try_changes = [&] {
        return tests::Statuses{opaline_light_turn(l, identity.data()),
                               opaline_light_set_rotation(l, identity.data()),
                               opaline_light_set_lat_long(l, white, 1, 1),
                               opaline_light_set_harmonics(l, harmonics.data()),
                               opaline_light_set_coefficients(l, rgb.data(), rgb.size()),
                               opaline_light_add_sun(l, up, 0.1f, white),
                               opaline_light_set_threads(l, 1),
                               opaline_light_clear(l)};
    };
    const auto try_reading = [&] {
        return tests::Statuses{opaline_shade(asset.get(), l, 0, radiance.data(), radiance.size()),
                               opaline_light_get_coefficients(l, rgb.data(), rgb.size())};
    };
    {
        const Writing other(l->users);
        ASSERT_TRUE(other);
        EXPECT_THAT(try_changes(), testing::Each(OPALINE_BUSY));
        EXPECT_THAT(try_reading(), testing::Each(OPALINE_BUSY));
        EXPECT_STRNE(opaline_last_error(), "");
    }
    {
        const Reading other(l->users);
        ASSERT_TRUE(other);
        EXPECT_THAT(try_changes(), testing::Each(OPALINE_BUSY));
        EXPECT_THAT(try_reading(), testing::Each(OPALINE_OK));
    }
    EXPECT_THAT(try_changes(), testing::Each(OPALINE_OK));
}

// For the thread sanitizer: eight readers of a light while another light changes, and then of the
// light that changes, which they find before or after a change or are kept from.
TEST_F(ApiLight, EightThreadsRelightWhileAnotherChangesALight) {
    const float up[3] = {0, 1, 0}, side[3] = {1, 0, 0}, white[3] = {9, 9, 9};
    const auto shaded = [&](const LightHandle& of, std::vector<float>& out) {
        return opaline_shade(asset.get(), of.get(), 0, out.data(), out.size());
    };
    ASSERT_EQ(opaline_light_add_sun(light.get(), up, 0.2f, white), OPALINE_OK);
    std::vector<float> first(std::size_t{3} * receivers()), second(first.size());
    ASSERT_EQ(shaded(light, first), OPALINE_OK);
    const LightHandle other = new_light();
    ASSERT_EQ(opaline_light_add_sun(other.get(), side, 0.2f, white), OPALINE_OK);
    ASSERT_EQ(shaded(other, second), OPALINE_OK);
    for (const bool same : {false, true}) {
        std::atomic<int> wrong{0};
        std::vector<std::thread> threads;
        for (int t = 0; t < 8; ++t) {
            threads.emplace_back([&] {
                std::vector<float> out(first.size());
                for (int i = 0; i < 40; ++i) {
                    const opaline_status status = shaded(light, out);
                    const bool known = out == first || (same && out == second);
                    const bool busy = same && status == OPALINE_BUSY;
                    wrong += (status == OPALINE_OK && known) || busy ? 0 : 1;
                }
            });
        }
        const LightHandle& changed = same ? light : other;
        for (int i = 0; i < 40; ++i) {
            const opaline_status status =
                opaline_light_set_sun(changed.get(), 0, i % 2 == 0 ? side : up, 0.2f, white);
            wrong += status == OPALINE_OK || (same && status == OPALINE_BUSY) ? 0 : 1;
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        EXPECT_EQ(wrong, 0) << same;
    }
}

// A pool that runs its tasks one after the other on the calling thread, the last one first.
TEST_F(ApiLight, AHostsThreadPoolDoesTheWorkWithTheSameBits) {
    std::vector<float> map(std::size_t{3} * 256 * 128);
    for (std::size_t i = 0; i < map.size(); ++i) {
        map[i] = static_cast<float>(i % 97);
    }
    ASSERT_EQ(opaline_light_set_threads(light.get(), 3), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_lat_long(light.get(), map.data(), 256, 128), OPALINE_OK);
    const std::vector<float> expected = coefficients();
    struct Pool {
        std::uint32_t calls = 0, most = 0;
    } pool;
    opaline_set_thread_pool(
        [](void* user, std::uint32_t count, void (*task)(void*, std::uint32_t), void* context) {
            auto& own = *static_cast<Pool*>(user);
            ++own.calls;
            own.most = std::max(own.most, count);
            for (std::uint32_t i = count; i-- > 0;) {
                task(context, i);
            }
        },
        &pool);
    const LightHandle other = new_light();
    EXPECT_EQ(opaline_light_set_threads(other.get(), 3), OPALINE_OK);
    EXPECT_EQ(opaline_light_set_lat_long(other.get(), map.data(), 256, 128), OPALINE_OK);
    opaline_set_thread_pool(nullptr, nullptr);
    EXPECT_GT(pool.calls, 0u);
    EXPECT_EQ(pool.most, 3u);
    EXPECT_EQ(coefficients(other), expected);
}

}  // namespace
}  // namespace opaline::runtime
