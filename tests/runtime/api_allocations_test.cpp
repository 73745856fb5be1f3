// What allocates, as runtime/README.md says: counted in operator new, which the library uses for
// all that it does not take from a host's allocator.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/runtime/api_test_support.h"
#include "tests/runtime/light_test_support.h"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
    ++allocations;
    return std::malloc(size > 0 ? size : 1);
}

void* counted_aligned(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto step = static_cast<std::size_t>(alignment);
    return std::aligned_alloc(step, (size + step - 1) / step * step);
}

}  // namespace

// Not inlined: g++ would take malloc and delete for a pair that does not match.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* const p = counted(size)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return counted(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    if (void* const p = counted_aligned(size, alignment)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment,
                                     const std::nothrow_t&) noexcept {
    return counted_aligned(size, alignment);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

namespace opaline::runtime {
namespace {

/// How often `work` allocates once it has run before.
template <class Work>
long allocations_of(const Work& work) {
    work();
    const long before = allocations;
    work();
    return allocations - before;
}

TEST(ApiAllocations, ShadingAndTurningALightAllocateNothing) {
    const tests::LoadedAsset loaded(tests::make_asset(16));
    const opaline_asset* const asset = loaded.asset.get();
    opaline_light* const l = loaded.light.get();
    const formats::Environment map = tests::lat_long_map(256, 128, tests::smooth_sky);
    const float up[3] = {0, 1, 0}, white[3] = {9, 9, 9}, eye[3] = {1, 2, 3};
    ASSERT_EQ(opaline_light_set_lat_long(l, &map.pixel[0].r, 256, 128), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(l, up, 0.01f, white), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(l, up, 0.4f, white), OPALINE_OK);

    const std::uint32_t receivers = loaded.receivers();
    std::vector<float> out(std::size_t{3} * receivers), rgb(18 * 16 * 16);
    EXPECT_EQ(allocations_of([&] {
                  EXPECT_EQ(opaline_shade(asset, l, 0, out.data(), out.size()), OPALINE_OK);
                  EXPECT_EQ(
                      opaline_shade_from(asset, l, 0, eye, 0, receivers, out.data(), out.size()),
                      OPALINE_OK);
              }),
              0);
    const auto turn = tests::matrix(rotation_about_y(0.4f));
    EXPECT_EQ(allocations_of([&] { EXPECT_EQ(opaline_light_turn(l, turn.data()), OPALINE_OK); }),
              0);
    EXPECT_EQ(allocations_of([&] {
                  EXPECT_EQ(opaline_light_get_coefficients(l, rgb.data(), rgb.size()), OPALINE_OK);
              }),
              0);
    // A call that fails has no memory to ask for either.
    EXPECT_EQ(allocations_of([&] {
                  EXPECT_EQ(opaline_shade(asset, l, 0, out.data(), 1), OPALINE_BUFFER_TOO_SMALL);
              }),
              0);
    // Harmonics change every frame in some engines.
    ASSERT_EQ(opaline_light_clear(l), OPALINE_OK);
    const std::array<float, 27> harmonics{3, 3, 3, 1, 0, 0, 0, 1, 0};
    EXPECT_EQ(allocations_of([&] {
                  EXPECT_EQ(opaline_light_set_harmonics(l, harmonics.data()), OPALINE_OK);
                  EXPECT_EQ(opaline_light_set_rotation(l, turn.data()), OPALINE_OK);
              }),
              0);
    // The count counts.
    EXPECT_GT(allocations_of([&] {
                  EXPECT_EQ(opaline_light_set_lat_long(l, &map.pixel[0].r, 256, 128), OPALINE_OK);
              }),
              0);
}

}  // namespace
}  // namespace opaline::runtime
