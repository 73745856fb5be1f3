#pragma once

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/opal/write_opal.h"
#include "tests/runtime/embed_gl/host/host_context.h"
#include "tests/runtime/embed_gl/host/loaded_file.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::test {

/// An asset loaded from a file as a host does, lit by light_by_gradient.
class EmbeddedAsset : public LoadedFile {
  public:
    explicit EmbeddedAsset(const formats::Asset& asset) : LoadedFile(written(asset)) {
        std::filesystem::remove(path());
        light_by_gradient(light());
    }

  private:
    static std::filesystem::path path() {
        return std::filesystem::path(testing::TempDir()) /
               ("embedded-" + std::to_string(getpid()) + ".opal");
    }
    static std::filesystem::path written(const formats::Asset& asset) {
        auto file = formats::AtomicFile::create(path());
        EXPECT_TRUE(file && formats::write_opal(asset.view(), std::move(*file)));
        return path();
    }
};

/// Every kind of receiver: opaque of one and three bands, thin-walled, translucent of several
/// numbers of rows; two emitters light them.
inline formats::Asset make_every_kind(std::uint32_t n, std::uint32_t code_bits) {
    formats::Asset asset = make_asset(n, code_bits);
    add_primitive(asset, make_sphere({0, 0, 0}, 1, 9, 7), {.bands = 1, .details = 37});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 8, 6), {.bands = 3, .details = 30});
    add_primitive(asset, make_sheet({0, 3, 0}, {1, 0, 0}, {0, 0.7f, 0.4f}, 5, 1),
                  {.bands = 3, .is_sheet = true});
    add_primitive(asset, make_sphere({0, 0, 3}, 1, 7, 6),
                  {.bands = 3, .details = 20, .eta = 1.3f, .terms = 9});
    add_primitive(asset, make_sphere({3, 0, 3}, 1, 7, 6),
                  {.details = 20, .eta = 1.4f, .terms = 4, .is_double_sided = true});
    add_primitive(asset, make_sphere({3, 3, 3}, 1, 6, 6),
                  {.bands = 3, .details = 20, .eta = 1.3f, .terms = 17, .is_separate = true});
    append_emitter(asset.emitters, "lamp");
    append_emitter(asset.emitters, "panel");
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        std::vector<formats::Rgb> rows;
        for (std::uint32_t i = 0; i < primitive.vertex_count * primitive.terms; ++i) {
            rows.push_back(
                {0.3f * static_cast<float>(i % 5), 0.2f * static_cast<float>(i % 3), 0.5f});
        }
        append_block(asset.emitters, 0, p, rows);
        if (p % 2 == 0) append_block(asset.emitters, 1, p, rows);
    }
    return asset;
}

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
