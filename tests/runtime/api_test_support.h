#pragma once

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal/write_opal.h"
#include "runtime/opaline.hpp"
#include "tests/runtime/shade_test_support.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

/// The bytes of a small file, aligned as a memory map is.
struct FileBytes {
    std::vector<char> storage;
    std::size_t size = 0;

    char* data() {
        void* p = storage.data();
        std::size_t room = storage.size();
        return static_cast<char*>(std::align(64, size, p, room));
    }
};

inline formats::Asset make_asset(std::uint32_t n) {
    formats::Asset asset;
    asset.provenance = "{}";
    formats::PrimitiveRecord p;
    p.node = 4;
    p.bands = 3;
    p.flags = formats::PrimitiveRecord::kDoubleSided;
    add_random_primitive(asset, n, p, 21);
    return asset;
}

inline FileBytes write(const formats::Asset& asset,
                       formats::Compression compression = formats::Compression::none) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file && formats::write_opal_bytes(asset.view(), *file, {}, compression) &&
                file->commit());
    std::ifstream in(folder / "a.opal", std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    FileBytes bytes{std::vector<char>(content.size() + 64), content.size()};
    std::memcpy(bytes.data(), content.data(), content.size());
    return bytes;
}

/// An asset that the library has loaded from memory, and a light of it.
struct LoadedAsset {
    explicit LoadedAsset(const formats::Asset& source) : file(write(source)) {
        auto loaded = load_asset(file.data(), file.size);
        EXPECT_TRUE(loaded) << opaline_last_error();
        asset = std::move(loaded.handle);
        light = new_light();
    }
    LightHandle new_light() const {
        auto created = create_light(asset);
        EXPECT_TRUE(created) << opaline_last_error();
        return std::move(created.handle);
    }
    std::uint32_t receivers() const { return opaline_asset_receiver_count(asset.get()); }
    std::vector<float> shaded(std::uint32_t flags = 0) const {
        std::vector<float> out(std::size_t{3} * receivers(), -1.0f);
        EXPECT_EQ(opaline_shade(asset.get(), light.get(), flags, out.data(), out.size()),
                  OPALINE_OK)
            << opaline_last_error();
        return out;
    }
    FileBytes file;
    AssetHandle asset;
    LightHandle light;
};

/// A rotation as the interface takes it, column by column.
inline std::array<float, 9> matrix(const runtime::Rotation& r) {
    return {r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z};
}

using Statuses = std::vector<opaline_status>;

}  // namespace opaline::tests
