#include "tests/runtime/gl/gl_comparison.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "runtime/gl/egl_context.h"

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
    double sum = 0, difference = 0;
    std::size_t off = 0;
    for (std::size_t i = 0; i < cpu.pixel.size(); ++i) {
        const Rgb a = cpu.pixel[i], b = gl.pixel[i];
        bool is_off = false;
        for (const auto& [x, y] : {std::pair{a.r, b.r}, std::pair{a.g, b.g}, std::pair{a.b, b.b}}) {
            ASSERT_TRUE(std::isfinite(x) && std::isfinite(y));
            sum += std::abs(static_cast<double>(x));
            difference += std::abs(static_cast<double>(x) - static_cast<double>(y));
            is_off |= std::abs(x - y) > 0.005f * std::max(x, 1e-3f);
        }
        off += is_off ? 1u : 0u;
    }
    ASSERT_GT(sum, 0);
    std::cout << "[ agreement] mean " << difference / sum << ", off " << off << " of "
              << cpu.pixel.size() << "\n";
    EXPECT_LT(difference / sum, 1e-3);
    // GPUs snap vertices to 1/256 of a pixel: a pixel on an edge may show what is behind it.
    EXPECT_LE(off, cpu.pixel.size() / 500);
}

}  // namespace opaline::test
