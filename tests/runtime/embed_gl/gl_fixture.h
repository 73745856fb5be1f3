#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::test {

using Statuses = std::vector<opaline_status>;

/// An asset in a host's context. Skips only where no context can be made.
class EmbedGl : public testing::TestWithParam<HostApi> {
  protected:
    void SetUp() override {
        context_ = HostContext::create(GetParam());
        if (context_) return;
        std::cerr << "NO OPENGL ON THIS MACHINE: Opaline::gl is NOT tested\n";
        GTEST_SKIP() << "EGL offers no context of that version";
    }
    void TearDown() override {
        if (context_) context_->make_current();
        EXPECT_EQ(opaline_gl_release(gl_), OPALINE_OK);
    }
    void make(const formats::Asset& asset, std::uint32_t flags = 0) {
        EXPECT_EQ(opaline_gl_release(gl_), OPALINE_OK);
        host_ = std::make_unique<EmbeddedAsset>(asset);
        ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, flags, &gl_), OPALINE_OK)
            << opaline_last_error();
    }
    void relight() const {
        ASSERT_EQ(opaline_gl_relight(gl_, host_->light()), OPALINE_OK) << opaline_last_error();
    }
    void look_from(formats::Vec3 eye) const {
        ASSERT_EQ(opaline_gl_look_from(gl_, &eye.x), OPALINE_OK) << opaline_last_error();
    }
    std::optional<HostContext> context_;
    std::unique_ptr<EmbeddedAsset> host_;
    opaline_gl* gl_ = nullptr;
};

/// Three floats a receiver on the CPU, four on the GPU, to 1e-5 of the brightest: sums of some
/// hundred floats in another order.
inline void expect_same_receivers(const std::vector<float>& cpu, const std::vector<float>& gl) {
    ASSERT_GE(gl.size() / 4, cpu.size() / 3);
    const float brightest = *std::max_element(cpu.begin(), cpu.end());
    ASSERT_GT(brightest, 0.1f);
    float largest = 0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        const float difference = std::abs(cpu[i] - gl[i / 3 * 4 + i % 3]);
        EXPECT_LE(difference, 1e-5f * brightest) << "receiver " << i / 3;
        largest = std::max(largest, difference);
    }
    std::cout << "[ agreement] " << largest / brightest << "\n";
}

inline const auto kBothContexts = testing::Values(HostApi::desktop_43, HostApi::es_31);

inline std::string api_name(const testing::TestParamInfo<HostApi>& info) {
    return info.param == HostApi::es_31 ? "Es31" : "Desktop43";
}

}  // namespace opaline::test
