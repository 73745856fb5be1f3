#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "tests/formats/opal/opal_bytes.h"

namespace opaline::tests {

/// What is tested of every section whose arrays are used in place. Each takes a sound asset.

/// Expects that no beginning of the file is read.
inline void expect_truncations_refused(const formats::Asset& asset) {
    const std::vector<std::byte> whole = encode(asset);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(size));
        const auto loaded = formats::read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes";
        ASSERT_EQ(loaded.error().kind, formats::ErrorKind::bad_input);
    }
}

/// Expects that no beginning of the section `id`, the file's last one, is read, though all the rest
/// agrees with its being cut.
inline void expect_section_truncations_refused(const formats::Asset& asset, std::uint32_t id) {
    const std::vector<std::byte> whole = encode(asset);
    AlignedBytes sound(whole);
    auto table = formats::read_section_table(sound.bytes(), "a.opal");
    ASSERT_TRUE(table);
    ASSERT_EQ(table->back().id, id);
    for (std::uint64_t size = 0; size < table->back().size; ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(table->back().offset + size));
        formats::FileHeader header;
        std::memcpy(&header, stored.bytes().data(), sizeof header);
        header.file_size = stored.bytes().size();
        std::memcpy(stored.bytes().data(), &header, sizeof header);
        formats::SectionEntry cut = table->back();
        cut.size = cut.stored_size = size;
        std::memcpy(stored.bytes().data() + sizeof header + (table->size() - 1) * sizeof cut, &cut,
                    sizeof cut);
        repair_checksums(stored.bytes(), id);
        const auto loaded = formats::read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes of the section";
        ASSERT_EQ(loaded.error().diagnostics.front().where, "section " + formats::section_name(id));
    }
}

/// Expects that the full check finds every byte of the section that is not as it was.
inline void expect_flipped_bytes_found(const formats::Asset& asset, std::uint32_t id) {
    AlignedBytes stored(encode(asset));
    const auto table = formats::read_section_table(stored.bytes(), "a.opal");
    ASSERT_TRUE(table);
    const formats::SectionEntry section = section_of(*table, id);
    for (std::uint64_t i = 0; i < section.stored_size; ++i) {
        std::byte& byte = stored.bytes()[section.offset + i];
        byte ^= std::byte{0x40};
        ASSERT_FALSE(formats::read_opal(stored.bytes(), "a.opal", formats::Checks::full))
            << "byte " << i;
        byte ^= std::byte{0x40};
    }
    EXPECT_TRUE(formats::read_opal(stored.bytes(), "a.opal", formats::Checks::full));
}

/// How many forged files were refused for their structure, accepted by that check, and of these
/// refused for their values.
struct Forged {
    std::size_t refused = 0, accepted = 0, refused_for_values = 0;
};

/// Reads the file with bits of the section changed and its checksums right, and calls
/// use(AssetView) where it is accepted. Of the first `record_bytes` bytes, which decide most,
/// several bits are changed one by one, of the others one a byte.
template <class Use>
Forged forge_section(const formats::Asset& asset, std::uint32_t id, std::size_t record_bytes,
                     Use use) {
    const std::vector<std::byte> whole = encode(asset);
    AlignedBytes sound(whole);
    const auto table = formats::read_section_table(sound.bytes(), "a.opal");
    EXPECT_TRUE(table);
    const formats::SectionEntry section = section_of(*table, id);
    Forged forged;
    for (std::uint64_t i = 0; i < section.stored_size; ++i) {
        for (const int bit : i < record_bytes ? std::vector{0, 2, 4, 7} : std::vector{int(i % 8)}) {
            AlignedBytes stored(whole);
            stored.bytes()[section.offset + i] ^= static_cast<std::byte>(1 << bit);
            const auto loaded = formats::read_opal(stored.bytes(), "a.opal");
            repair_checksums(stored.bytes(), id);
            const bool is_sound =
                formats::read_opal(stored.bytes(), "a.opal", formats::Checks::full).has_value();
            if (!loaded) {
                EXPECT_FALSE(is_sound);
                ++forged.refused;
                continue;
            }
            use(loaded->view);
            ++forged.accepted;
            forged.refused_for_values += is_sound ? 0 : 1;
        }
    }
    return forged;
}

}  // namespace opaline::tests
