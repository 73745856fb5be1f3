#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal/write_opal.h"
#include "tests/runtime/row_test_support.h"

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
    asset.transport = tests::random_rows(n, 8, 3, 21);
    formats::PrimitiveRecord p;
    p.node = 4;
    p.vertex_count = asset.transport.view().rows();
    p.bands = 3;
    p.flags = formats::PrimitiveRecord::kDoubleSided;
    asset.primitives = {p};
    asset.position.resize(p.vertex_count);
    asset.normal.resize(p.vertex_count, {0, 1, 0});
    asset.base_color.resize(p.vertex_count, {0.5f, 0.5f, 0.5f});
    return asset;
}

inline FileBytes write(const formats::Asset& asset, const std::string& name,
                       formats::Compression compression = formats::Compression::none) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
    auto file = formats::AtomicFile::create(path);
    EXPECT_TRUE(file && formats::write_opal_bytes(asset.view(), *file, {}, compression) &&
                file->commit());
    std::ifstream in(path, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    std::filesystem::remove(path);
    FileBytes bytes{std::vector<char>(content.size() + 64), content.size()};
    std::memcpy(bytes.data(), content.data(), content.size());
    return bytes;
}

}  // namespace opaline::tests
