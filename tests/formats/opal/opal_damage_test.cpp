// Bytes that are not as they were written: damaged, forged, or of a later version.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "formats/opal/layout.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using tests::AlignedBytes;
using tests::encode;

TEST(OpalDamage, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = encode(tests::make_small_asset());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(size));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes";
        ASSERT_EQ(loaded.error().kind, ErrorKind::bad_input);
    }
}

TEST(OpalDamage, TrailingBytesAreRefused) {
    std::vector<std::byte> bytes = encode(tests::make_small_asset());
    bytes.push_back(std::byte{0});
    AlignedBytes stored(bytes);
    EXPECT_FALSE(read_opal(stored.bytes(), "a.opal"));
}

// Padding between sections is the only place where a flipped bit means nothing.
TEST(OpalDamage, EveryFlippedByteOfASectionIsFoundByTheFullCheck) {
    const std::vector<std::byte> whole = encode(tests::make_small_asset());
    AlignedBytes sound(whole);
    const auto table = read_section_table(sound.bytes(), "a.opal");
    ASSERT_TRUE(table);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        AlignedBytes stored(whole);
        stored.bytes()[at] ^= std::byte{0x40};
        const bool in_section = std::any_of(table->begin(), table->end(), [at](const auto& s) {
            return at >= s.offset && at < s.offset + s.stored_size;
        });
        const bool accepted = read_opal(stored.bytes(), "a.opal", Checks::full).has_value();
        if (in_section) {
            ASSERT_FALSE(accepted) << "byte " << at;
        }
    }
}

// Damage that keeps its checksum is what a hostile writer makes: nothing may be read out of bounds.
TEST(OpalDamage, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f, false, 1);
    const std::vector<std::byte> whole = encode(asset);
    std::size_t refused = 0, accepted = 0;
    for (std::size_t at = sizeof(FileHeader); at < whole.size(); ++at) {
        for (const int bit : {0, 3, 7}) {
            AlignedBytes stored(whole);
            stored.bytes()[at] ^= static_cast<std::byte>(1 << bit);
            // Repair the table's own checksum, so that forged tables are looked at.
            FileHeader header;
            std::memcpy(&header, stored.bytes().data(), sizeof header);
            header.table_checksum = checksum(
                stored.bytes().subspan(sizeof header, header.section_count * sizeof(SectionEntry)));
            std::memcpy(stored.bytes().data(), &header, sizeof header);
            const auto loaded = read_opal(stored.bytes(), "a.opal");
            if (!loaded) {
                ++refused;
                continue;
            }
            ++accepted;
            // Use everything the runtime would use; the address sanitizer watches.
            std::vector<float> dense(cubemap_texels(loaded->view.cubemap_size));
            for (const PrimitiveRecord& p : loaded->view.primitives) {
                for (std::uint32_t r = 0; r < p.rows().rows; ++r) {
                    for (std::uint32_t band = 0; band < p.bands; ++band) {
                        decode_row(loaded->view.transport, p.rows(), r, band, dense);
                    }
                }
                for (std::uint32_t i = 0; i < p.index_count; ++i) {
                    const std::uint32_t v = p.first_vertex + loaded->view.index[p.first_index + i];
                    ASSERT_LT(v, loaded->view.position.size());
                }
            }
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(accepted, 100u);
}

TEST(OpalVersion, ALaterVersionAsksForAnUpdate) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    header.version = kOpalVersion + 1;
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::newer_file);
}

// A small asset whose section `id` claims the version.
Result<LoadedAsset> read_with_version(std::uint32_t id, std::uint32_t version) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    std::byte* const table = stored.bytes().data() + sizeof header;
    for (std::uint32_t s = 0; s < header.section_count; ++s) {
        SectionEntry entry;
        std::memcpy(&entry, table + s * sizeof entry, sizeof entry);
        if (entry.id == id) {
            entry.version = version;
            std::memcpy(table + s * sizeof entry, &entry, sizeof entry);
        }
    }
    header.table_checksum = checksum({table, header.section_count * sizeof(SectionEntry)});
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    return read_opal(stored.bytes(), "a.opal");
}

TEST(OpalVersion, ALaterSectionVersionAsksForAnUpdate) {
    for (const auto& [id, version] : {std::pair{kPrimSection, kSheetVersion + 1},
                                      std::pair{kTranSection, kTransportVersion + 1}}) {
        const auto loaded = read_with_version(id, version);
        ASSERT_FALSE(loaded);
        EXPECT_EQ(loaded.error().kind, ErrorKind::newer_file);
        EXPECT_EQ(loaded.error().diagnostics.front().where, "section " + section_name(id));
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
    AlignedBytes stored(encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    // The provenance is the one section that nothing else needs: rename it.
    SectionEntry entry;
    std::byte* table = stored.bytes().data() + sizeof header;
    std::memcpy(&entry, table, sizeof entry);
    ASSERT_EQ(entry.id, kProvSection);
    entry.id = section_id("XTRA");
    entry.version = 99;
    std::memcpy(table, &entry, sizeof entry);
    header.table_checksum = checksum({table, header.section_count * sizeof(SectionEntry)});
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->view.provenance.empty());
}

TEST(OpalDamage, TheFullCheckFindsNumbersThatAreNotFinite) {
    Asset asset = tests::make_small_asset();
    asset.position[3].y = std::numeric_limits<float>::quiet_NaN();
    AlignedBytes bad_position(encode(asset));
    EXPECT_TRUE(read_opal(bad_position.bytes(), "a.opal"));
    EXPECT_FALSE(read_opal(bad_position.bytes(), "a.opal", Checks::full));
    asset = tests::make_small_asset();
    asset.transport.detail_scale[2] = std::numeric_limits<float>::infinity();
    AlignedBytes bad_scale(encode(asset));
    EXPECT_FALSE(read_opal(bad_scale.bytes(), "a.opal", Checks::full));
}

}  // namespace
}  // namespace opaline::formats
