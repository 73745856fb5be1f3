#include "tests/runtime/gl/gl_comparison.h"

#include <cmath>
#include <iostream>

#include "runtime/gl/egl_context.h"
#include "tests/runtime/gl/picture_difference.h"

namespace opaline::test {

using formats::Rgb;
using runtime::Picture;

void Gl::SetUp() {
    const auto context = runtime::EglContext::create();
    if (!context) {
        std::cerr << "NO OPENGL ON THIS MACHINE: the GPU half is NOT tested: "
                  << context.error().diagnostics[0].fault << "\n";
        GTEST_SKIP() << context.error().diagnostics[0].fault;
    }
}

std::string text_of(const formats::Error& error) {
    return error.diagnostics[0].where + ": " + error.diagnostics[0].fault;
}

void expect_same_radiance(const std::vector<Rgb>& cpu, const std::vector<Rgb>& gl) {
    ASSERT_EQ(cpu.size(), gl.size());
    for (std::size_t v = 0; v < cpu.size(); ++v) {
        // Float sums of a few hundred products in another order.
        EXPECT_NEAR(cpu[v].r, gl[v].r, 2e-5f * (std::abs(cpu[v].r) + 1)) << "vertex " << v;
        EXPECT_NEAR(cpu[v].g, gl[v].g, 2e-5f * (std::abs(cpu[v].g) + 1)) << "vertex " << v;
        EXPECT_NEAR(cpu[v].b, gl[v].b, 2e-5f * (std::abs(cpu[v].b) + 1)) << "vertex " << v;
    }
}

void expect_same_picture(const Picture& cpu, const Picture& gl) {
    ASSERT_EQ(cpu.width, gl.width);
    ASSERT_EQ(cpu.height, gl.height);
    const PictureDifference found = picture_difference(cpu.pixel, gl.pixel);
    ASSERT_TRUE(std::isfinite(found.mean));
    std::cout << "[ agreement] mean " << found.mean << ", off " << found.off << " of "
              << cpu.pixel.size() << "\n";
    EXPECT_TRUE(found.is_small());
}

}  // namespace opaline::test
