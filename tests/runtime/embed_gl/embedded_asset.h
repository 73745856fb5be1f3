#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal/write_opal.h"
#include "runtime/opaline.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::test {

/// An asset loaded as a host does: through bytes and opaline.h.
class EmbeddedAsset {
  public:
    explicit EmbeddedAsset(const formats::Asset& asset) {
        const std::filesystem::path path = std::filesystem::path(testing::TempDir()) /
                                           ("embedded-" + std::to_string(getpid()) + ".opal");
        auto file = formats::AtomicFile::create(path);
        EXPECT_TRUE(file && formats::write_opal(asset.view(), std::move(*file)));
        std::ifstream in(path, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(in), {}};
        std::filesystem::remove(path);
        storage_.resize(content.size() + 64);
        void* bytes = storage_.data();
        std::size_t room = storage_.size();
        std::align(64, content.size(), bytes, room);
        std::memcpy(bytes, content.data(), content.size());
        EXPECT_EQ(opaline_asset_load(bytes, content.size(), &asset_), OPALINE_OK)
            << opaline_last_error();
        EXPECT_EQ(opaline_light_create(asset_, &light_), OPALINE_OK);
        light_up();
    }
    EmbeddedAsset(const EmbeddedAsset&) = delete;
    EmbeddedAsset& operator=(const EmbeddedAsset&) = delete;
    ~EmbeddedAsset() {
        opaline_light_release(light_);
        opaline_asset_release(asset_);
    }

    const opaline_asset* asset() const { return asset_; }
    opaline_light* light() const { return light_; }
    std::uint32_t receivers() const { return opaline_asset_receiver_count(asset_); }

    /// What opaline_gl hands out, from the CPU: three floats a receiver.
    std::vector<float> expected(const float* eye) const {
        std::vector<float> rgb(3 * std::size_t{receivers()});
        EXPECT_EQ(
            opaline_shade_from(asset_, light_,
                               OPALINE_SHADE_WITHOUT_BASE_COLOR | OPALINE_SHADE_WITHOUT_FRESNEL,
                               eye, 0, receivers(), rgb.data(), rgb.size()),
            OPALINE_OK)
            << opaline_last_error();
        return rgb;
    }

  private:
    // A gradient that differs between bands, and a sun.
    void light_up() {
        std::vector<float> map;
        for (int i = 0; i < 32 * 16; ++i) {
            const float x = static_cast<float>(i % 32) / 32, y = static_cast<float>(i / 32) / 16;
            map.insert(map.end(), {0.2f + x, 1 - y, 0.5f + x * y});
        }
        const float direction[3] = {1, 2, 0.5f}, radiance[3] = {900, 800, 700};
        EXPECT_EQ(opaline_light_set_lat_long(light_, map.data(), 32, 16), OPALINE_OK);
        EXPECT_EQ(opaline_light_add_sun(light_, direction, 0.02f, radiance), OPALINE_OK);
    }

    std::vector<char> storage_;
    opaline_asset* asset_ = nullptr;
    opaline_light* light_ = nullptr;
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

}  // namespace opaline::test
