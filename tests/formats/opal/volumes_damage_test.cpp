// Volumes whose bytes are not as they were written: nothing may be read out of bounds.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::formats {
namespace {

using tests::AlignedBytes;
using tests::encode;

TEST(VolumesDamage, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = encode(tests::make_volume_asset());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(size));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes";
        ASSERT_EQ(loaded.error().kind, ErrorKind::bad_input);
    }
}

// The section alone is cut, and all the rest agrees with that.
TEST(VolumesDamage, EveryTruncationOfTheSectionIsRefused) {
    const std::vector<std::byte> whole = encode(tests::make_volume_asset());
    AlignedBytes sound(whole);
    auto table = read_section_table(sound.bytes(), "a.opal");
    ASSERT_TRUE(table);
    ASSERT_EQ(table->back().id, kVoluSection);
    for (std::uint64_t size = 0; size < table->back().size; ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(table->back().offset + size));
        FileHeader header;
        std::memcpy(&header, stored.bytes().data(), sizeof header);
        header.file_size = stored.bytes().size();
        std::memcpy(stored.bytes().data(), &header, sizeof header);
        SectionEntry cut = table->back();
        cut.size = cut.stored_size = size;
        std::memcpy(stored.bytes().data() + sizeof header + (table->size() - 1) * sizeof cut, &cut,
                    sizeof cut);
        tests::repair_checksums(stored.bytes(), kVoluSection);
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes of the section";
        ASSERT_EQ(loaded.error().diagnostics.front().where, "section VOLU");
    }
}

TEST(VolumesDamage, EveryFlippedByteIsFoundByTheFullCheck) {
    const std::vector<std::byte> whole = encode(tests::make_volume_asset());
    AlignedBytes stored(whole);
    const auto table = read_section_table(stored.bytes(), "a.opal");
    ASSERT_TRUE(table);
    const SectionEntry section = tests::section_of(*table, kVoluSection);
    for (std::uint64_t i = 0; i < section.stored_size; ++i) {
        std::byte& byte = stored.bytes()[section.offset + i];
        byte ^= std::byte{0x40};
        ASSERT_FALSE(read_opal(stored.bytes(), "a.opal", Checks::full)) << "byte " << i;
        byte ^= std::byte{0x40};
    }
    EXPECT_TRUE(read_opal(stored.bytes(), "a.opal", Checks::full));
}

// Uses everything that a runtime would use; the address sanitizer watches.
void use(const VolumesView& volumes) {
    double sum = 0;
    std::vector<float> dense(cubemap_texels(volumes.rows.cubemap_size));
    for (const float cosine : {-1.0f, 0.3f, 1.0f}) {
        sum += double{eval_phase_table(volumes.phase_of(volumes.records.size() - 1), cosine)};
    }
    for (const VolumeRecord& v : volumes.records) {
        const std::size_t cells = std::size_t{v.extent[0]} * v.extent[1] * v.extent[2];
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const std::uint32_t brick = volumes.table[v.first_cell + cell];
            if (brick == kNoBrick) continue;
            const std::size_t number = v.first_brick_number + brick;
            sum += double{volumes.density_scale[number]};
            for (std::size_t i = 0; i < kBrickVoxels; ++i) {
                sum += volumes.density[number * kBrickVoxels + i];
            }
            for (std::size_t i = 0; i < v.corners_of_brick(); ++i) {
                const std::uint32_t node =
                    volumes.corner[v.first_corner + brick * v.corners_of_brick() + i];
                if (node != kNoNode) sum += volumes.node[v.first_node + node][0];
            }
        }
        for (std::uint32_t row = 0; row < v.rows().rows; ++row) {
            decode_row(volumes.rows, v.rows(), row, v.bands - 1, dense);
            sum += double{dense[row % dense.size()]};
        }
    }
    volatile double used = sum;
    (void)used;
}

TEST(VolumesDamage, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    const std::vector<std::byte> whole = encode(tests::make_volume_asset());
    AlignedBytes sound(whole);
    const auto table = read_section_table(sound.bytes(), "a.opal");
    ASSERT_TRUE(table);
    const SectionEntry section = tests::section_of(*table, kVoluSection);
    std::size_t refused = 0, accepted = 0, refused_for_values = 0;
    for (std::uint64_t i = 0; i < section.stored_size; ++i) {
        // Heads and records decide most: several bits of each of their bytes, one of the others.
        const bool is_record = i < 48 + 2 * sizeof(VolumeRecord);
        for (const int bit : is_record ? std::vector{0, 2, 4, 7} : std::vector{int(i % 8)}) {
            AlignedBytes stored(whole);
            stored.bytes()[section.offset + i] ^= static_cast<std::byte>(1 << bit);
            const auto loaded = read_opal(stored.bytes(), "a.opal");
            tests::repair_checksums(stored.bytes(), kVoluSection);
            const bool is_sound = read_opal(stored.bytes(), "a.opal", Checks::full).has_value();
            if (!loaded) {
                ASSERT_FALSE(is_sound);
                ++refused;
                continue;
            }
            use(loaded->view.volumes);
            ++accepted;
            refused_for_values += is_sound ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 1000u);
    EXPECT_GT(accepted, 1000u);
    EXPECT_GT(refused_for_values, 1000u);
}

}  // namespace
}  // namespace opaline::formats
