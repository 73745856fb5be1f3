// Meshes, and the vertices that a baker added, through the C interface.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "formats/opal/asset.h"
#include "formats/opal/section.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/runtime/api_test_support.h"

namespace opaline::runtime {
namespace {

// A host's allocator that knows what it gave out.
struct HostMemory {
    std::map<void*, std::size_t> given;
    std::size_t calls = 0, fails_at = ~std::size_t{0};
    bool wrong = false;

    static void* allocate(void* user, std::size_t size, std::size_t alignment) {
        auto& host = *static_cast<HostMemory*>(user);
        if (host.calls++ >= host.fails_at) return nullptr;
        void* const p = std::aligned_alloc(64, (size + 63) / 64 * 64);
        host.wrong = host.wrong || alignment > 64 || p == nullptr;
        host.given[p] = size;
        return p;
    }
    static void release(void* user, void* memory, std::size_t size, std::size_t) {
        auto& host = *static_cast<HostMemory*>(user);
        host.wrong = host.wrong || host.given.count(memory) == 0 || host.given[memory] != size;
        host.given.erase(memory);
        std::free(memory);
    }
    opaline_load_options options() {
        return {sizeof(opaline_load_options), OPALINE_LOAD_DEFAULT, allocate, release, this};
    }
};

class ApiLoad : public testing::Test {
  protected:
    opaline_status load(const opaline_load_options* options) {
        opaline_asset* loaded = nullptr;
        const opaline_status status =
            opaline_asset_load_with(file.data(), file.size, options, &loaded);
        asset.reset(loaded);
        return status;
    }
    std::vector<float> shaded() {
        const auto light = create_light(asset);
        const float white[3] = {1, 1, 1};
        EXPECT_EQ(opaline_light_set_lat_long(light.handle.get(), white, 1, 1), OPALINE_OK);
        std::vector<float> out(std::size_t{3} * opaline_asset_receiver_count(asset.get()));
        EXPECT_EQ(opaline_shade(asset.get(), light.handle.get(), 0, out.data(), out.size()),
                  OPALINE_OK);
        return out;
    }
    std::vector<float> shaded_by_default() {
        EXPECT_EQ(load(nullptr), OPALINE_OK);
        return shaded();
    }
    std::vector<formats::SectionEntry> sections() {
        auto table = formats::read_section_table(
            {reinterpret_cast<const std::byte*>(file.data()), file.size}, {});
        EXPECT_TRUE(table);
        return std::move(table).value();
    }
    tests::FileBytes file = tests::write(tests::make_asset(8));
    AssetHandle asset;
};
constexpr opaline_load_options kTrusted{sizeof(opaline_load_options), OPALINE_LOAD_TRUSTED, nullptr,
                                        nullptr, nullptr};

TEST_F(ApiLoad, MemoryOfTheAssetIsTheHostsAndGoesBack) {
    const std::vector<float> expected = shaded_by_default();
    HostMemory host;
    const opaline_load_options options = host.options();
    ASSERT_EQ(load(&options), OPALINE_OK) << opaline_last_error();
    EXPECT_GE(host.given.size(), 2u);  // the handle, and the preview mesh, which is compressed
    EXPECT_EQ(shaded(), expected);
    asset.reset();
    EXPECT_TRUE(host.given.empty());
    EXPECT_FALSE(host.wrong);
}

TEST_F(ApiLoad, AFileIsReadByItsPath) {
    const std::vector<float> expected = shaded_by_default();
    const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / "a.opal";
    std::ofstream(path, std::ios::binary)
        .write(file.data(), static_cast<std::streamsize>(file.size));
    auto made = load_asset(path.c_str());
    std::filesystem::remove(path);  // its bytes are in memory
    ASSERT_TRUE(made) << opaline_last_error();
    asset = std::move(made.handle);
    EXPECT_EQ(shaded(), expected);
    opaline_asset* out = nullptr;
    EXPECT_EQ(opaline_asset_load_path(path.c_str(), &out), OPALINE_BAD_FILE);
    EXPECT_THAT(opaline_last_error(), testing::HasSubstr("No such file"));
    EXPECT_EQ(opaline_asset_load_path(nullptr, &out), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(out, nullptr);
}

// Compressed rows come from the host's memory, and shade the same.
TEST_F(ApiLoad, CompressedRowsAreTheSameAsset) {
    // Codes that repeat themselves, so that they compress.
    std::vector<float> expected;
    formats::Asset repeated = tests::make_asset(8);
    std::ranges::fill(repeated.transport.code8, static_cast<std::int8_t>(3));
    for (const auto compression :
         {formats::Compression::none, formats::Compression::fast, formats::Compression::best}) {
        file = tests::write(repeated, compression);
        HostMemory host;
        const opaline_load_options options = host.options();
        ASSERT_EQ(load(&options), OPALINE_OK) << opaline_last_error();
        const auto table = sections();
        const auto rows =
            std::ranges::find(table, formats::kTranSection, &formats::SectionEntry::id);
        EXPECT_EQ(rows->stored_size < rows->size, compression != formats::Compression::none);
        if (expected.empty()) expected = shaded();
        EXPECT_EQ(shaded(), expected);
        asset.reset();
        EXPECT_TRUE(host.given.empty());
    }
}

TEST_F(ApiLoad, AHostWithoutMemoryIsToldSoAndKeepsNothing) {
    std::size_t failures = 0;
    for (HostMemory host;; host.fails_at = ++failures) {
        host.fails_at = failures;
        host.calls = 0;
        const opaline_load_options options = host.options();
        const opaline_status status = load(&options);
        asset.reset();
        EXPECT_TRUE(host.given.empty());
        EXPECT_FALSE(host.wrong);
        if (status == OPALINE_OK) break;
        ASSERT_EQ(status, OPALINE_OUT_OF_MEMORY) << failures;
        ASSERT_LT(failures, 20u);
    }
    EXPECT_GE(failures, 2u);
}

TEST_F(ApiLoad, TrustedFilesAreTheSameAssetWithoutChecksOfContent) {
    const std::vector<float> expected = shaded_by_default();
    ASSERT_EQ(load(&kTrusted), OPALINE_OK);
    EXPECT_EQ(shaded(), expected);
    // Another byte of provenance, which no function reads.
    for (const formats::SectionEntry& entry : sections()) {
        if (entry.id == formats::kProvSection) file.data()[entry.offset] = '[';
    }
    EXPECT_EQ(load(nullptr), OPALINE_BAD_FILE);
    EXPECT_EQ(load(&kTrusted), OPALINE_OK);
    EXPECT_EQ(shaded(), expected);
    // What is outside of the file is refused all the same.
    file.size /= 2;
    EXPECT_EQ(load(&kTrusted), OPALINE_BAD_FILE);
}

TEST_F(ApiLoad, WrongUseIsRefused) {
    opaline_asset* out = nullptr;
    opaline_load_options options{};
    EXPECT_EQ(load(&options), OPALINE_INVALID_ARGUMENT);  // struct_size
    options.struct_size = sizeof options;
    EXPECT_EQ(load(&options), OPALINE_OK);
    options.flags = 2;
    EXPECT_EQ(load(&options), OPALINE_INVALID_ARGUMENT);
    options.flags = 0;
    options.allocate = HostMemory::allocate;  // without release
    EXPECT_EQ(load(&options), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_load_with(nullptr, 1, nullptr, &out), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_load_with(file.data(), file.size, nullptr, nullptr),
              OPALINE_INVALID_ARGUMENT);
    // A file of a later version says so, whether trusted or not.
    formats::FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    ++header.version;
    std::memcpy(file.data(), &header, sizeof header);
    EXPECT_EQ(load(nullptr), OPALINE_NEWER_FILE);
    EXPECT_EQ(load(&kTrusted), OPALINE_NEWER_FILE);
}

formats::Asset make_refined_asset() {
    formats::Asset asset = tests::make_small_asset();
    asset.added.count = {1, 2};
    asset.added.vertex = {{{0, 1, 2}, {0.5f, 0.5f}}, {{0, 1, 1}, {0.25f, 0}}, {{1, 0, 0}, {1, 0}}};
    return asset;
}

class ApiMesh : public testing::Test, protected tests::LoadedAsset {
  protected:
    ApiMesh() : LoadedAsset(make_refined_asset()) {}
};

TEST_F(ApiMesh, OfEachPrimitiveHasItsOwnVerticesAndThoseThatWereAdded) {
    opaline_primitive_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    ASSERT_EQ(opaline_asset_primitive_mesh(asset.get(), 1, &mesh), OPALINE_OK);
    EXPECT_EQ(mesh.position[3 * 3 + 2], 1);  // z of the last vertex
    EXPECT_EQ(mesh.normal[2], 1);
    EXPECT_EQ(mesh.texcoord[2 * 3], 1);
    EXPECT_EQ(mesh.base_color[1], 0.6f);
    ASSERT_EQ(mesh.index_count, 6u);
    EXPECT_EQ(mesh.index[4], 3u);
    ASSERT_EQ(mesh.added_count, 2u);
    EXPECT_EQ(mesh.added[0].corner[1], 1u);
    EXPECT_EQ(mesh.added[0].weight[0], 0.25f);
    EXPECT_EQ(mesh.added[1].weight[0], 1);
}

TEST_F(ApiMesh, WhatIsNotThereIsRefused) {
    opaline_primitive_mesh mesh{};
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 0, &mesh), OPALINE_INVALID_ARGUMENT);
    mesh.struct_size = sizeof mesh;
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 2, &mesh), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_primitive_mesh(nullptr, 0, &mesh), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 0, nullptr), OPALINE_INVALID_ARGUMENT);
}

}  // namespace

}  // namespace opaline::runtime
