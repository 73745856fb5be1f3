// Files of a later or earlier version, and numbers that are none.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "formats/opal/layout.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

// A small asset after change(FileHeader&, SectionEntry&) for each of its sections.
Result<LoadedAsset> read_changed(const std::function<void(FileHeader&, SectionEntry&)>& change) {
    tests::AlignedBytes stored(tests::encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    std::byte* const table = stored.bytes().data() + sizeof header;
    for (std::uint32_t s = 0; s < header.section_count; ++s) {
        SectionEntry entry;
        std::memcpy(&entry, table + s * sizeof entry, sizeof entry);
        change(header, entry);
        std::memcpy(table + s * sizeof entry, &entry, sizeof entry);
    }
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    tests::repair_checksums(stored.bytes(), 0);  // of the table alone
    return read_opal(stored.bytes(), "a.opal");
}

Result<LoadedAsset> read_with_version(std::uint32_t id, std::uint32_t version) {
    return read_changed([=](FileHeader&, SectionEntry& entry) {
        if (entry.id == id) entry.version = version;
    });
}

TEST(OpalVersion, ALaterVersionAsksForAnUpdate) {
    const auto loaded =
        read_changed([](FileHeader& header, SectionEntry&) { header.version = kOpalVersion + 1; });
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::newer_file);
    for (const auto& [id, version] : {std::pair{kPrimSection, kCopiesVersion + 1},
                                      std::pair{kTranSection, kTransportVersion + 1}}) {
        const auto section = read_with_version(id, version);
        ASSERT_FALSE(section);
        EXPECT_EQ(section.error().kind, ErrorKind::newer_file);
        EXPECT_EQ(section.error().diagnostics.front().where, "section " + section_name(id));
    }
}

// Its codes would be taken for square roots.
TEST(OpalVersion, TransportOfAnEarlierVersionAsksForAnotherBake) {
    ASSERT_TRUE(read_with_version(kTranSection, kTransportVersion));
    const auto loaded = read_with_version(kTranSection, 1);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(loaded.error().diagnostics.front().remedy, "bake it again");
}

TEST(OpalVersion, AnUnknownSectionIsSkipped) {
    // The provenance is the one section that nothing else needs.
    const auto loaded = read_changed([](FileHeader&, SectionEntry& entry) {
        if (entry.id != kProvSection) return;
        entry.id = section_id("XTRA");
        entry.version = 99;
    });
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->view.provenance.empty());
}

TEST(OpalDamage, TheFullCheckFindsNumbersThatAreNotFinite) {
    const auto bad_position = [](Asset& asset) {
        asset.position[3].y = std::numeric_limits<float>::quiet_NaN();
    };
    const auto bad_scale = [](Asset& asset) {
        asset.transport.detail_scale[2] = std::numeric_limits<float>::infinity();
    };
    const Asset asset = tests::make_small_asset();
    EXPECT_EQ(tests::fault_after(asset, bad_position), "");
    EXPECT_NE(tests::fault_after(asset, bad_position, Checks::full), "");
    EXPECT_NE(tests::fault_after(asset, bad_scale, Checks::full), "");
}

}  // namespace
}  // namespace opaline::formats
