// Errors by receiver that are written come back to tools, readers of assets skip them, and what no
// writer may write is refused by name.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "tests/formats/opal/receiver_error_fixture.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::AlignedBytes;
using tests::encode_with_errors;
using tests::make_receiver_errors;

Result<std::vector<float>> read_errors(std::span<const std::byte> bytes) {
    const auto loaded = read_opal(bytes, "a.opal", Checks::full);
    EXPECT_TRUE(loaded);
    return read_receiver_errors(bytes, *loaded, "a.opal");
}

TEST(ReceiverErrorsFile, WhatIsWrittenComesBackAndAssetsAreReadAsWithout) {
    AlignedBytes stored(encode_with_errors(make_receiver_errors()));
    const auto errors = read_errors(stored.bytes());
    ASSERT_TRUE(errors);
    EXPECT_EQ(*errors, make_receiver_errors());
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    tests::expect_same_bytes(loaded->view.transport.code8,
                             tests::make_small_asset().transport.code8);

    // Of a file without them every byte is as it was.
    const auto plain = tests::encode(tests::make_small_asset());
    EXPECT_EQ(encode_with_errors({}), plain);
    AlignedBytes without(plain);
    EXPECT_TRUE(read_errors(without.bytes())->empty());
}

TEST(ReceiverErrorsFile, SummaryIsThatOfTheNumbers) {
    std::vector<float> errors;
    for (int i = 0; i < 100; ++i) {
        errors.push_back(static_cast<float>((37 * i) % 100));
    }
    const ErrorSummary summary = summarize_errors(errors);
    EXPECT_DOUBLE_EQ(summary.mean, 49.5);
    EXPECT_EQ(summary.p95, 94);
    EXPECT_EQ(summary.largest, 99);
    EXPECT_EQ(summarize_errors({}).largest, 0);
    EXPECT_EQ(summarize_errors(std::vector<float>{0.5f}).p95, 0.5);
}

// With the checksum of what is there.
void expect_refused(std::vector<std::byte> bytes, const std::function<void(SectionEntry&)>& forge,
                    const char* fault) {
    AlignedBytes stored(bytes);
    auto table = read_section_table(stored.bytes(), "a.opal");
    ASSERT_TRUE(table);
    ASSERT_EQ(table->back().id, kRerrSection);
    forge(table->back());
    std::memcpy(
        stored.bytes().data() + sizeof(FileHeader) + (table->size() - 1) * sizeof(SectionEntry),
        &table->back(), sizeof(SectionEntry));
    tests::repair_checksums(stored.bytes(), kRerrSection);
    const auto errors = read_errors(stored.bytes());
    ASSERT_FALSE(errors) << fault;
    EXPECT_EQ(errors.error().diagnostics.front().where, "section RERR");
    EXPECT_THAT(errors.error().diagnostics.front().fault, HasSubstr(fault));
}

TEST(ReceiverErrorsFile, WhatCannotBeIsRefusedByName) {
    const auto nothing = [](SectionEntry&) {};
    for (const float bad :
         {-0.5f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        std::vector<float> errors = make_receiver_errors();
        errors[3] = bad;
        expect_refused(encode_with_errors(errors), nothing, "below 0 or not finite");
    }
    const auto sound = encode_with_errors(make_receiver_errors());
    expect_refused(
        sound, [](SectionEntry& e) { e.version = 2; }, "version 2 is unknown");
    expect_refused(
        sound, [](SectionEntry& e) { e.version = 0; }, "version 0 is unknown");
    expect_refused(
        sound, [](SectionEntry& e) { e.size += 16; }, "a number for each receiver");
    expect_refused(
        sound, [](SectionEntry& e) { e.size = std::uint64_t{1} << 40; },
        "a number for each receiver");
    expect_refused(
        sound, [](SectionEntry& e) { e.codec ^= 1; }, "cannot be decoded");
    expect_refused(
        sound, [](SectionEntry& e) { e.stored_size -= 1; }, "cannot be decoded");
}

TEST(ReceiverErrorsFile, DamagedBytesAreFound) {
    AlignedBytes stored(encode_with_errors(make_receiver_errors()));
    const auto table = read_section_table(stored.bytes(), "a.opal");
    ASSERT_TRUE(table);
    const SectionEntry section = tests::section_of(*table, kRerrSection);
    for (std::uint64_t i = 0; i < section.stored_size; ++i) {
        std::byte& byte = stored.bytes()[section.offset + i];
        byte ^= std::byte{0x40};
        // Readers of assets look at all checksums too where they check everything.
        EXPECT_FALSE(read_opal(stored.bytes(), "a.opal", Checks::full));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_TRUE(loaded);
        EXPECT_FALSE(read_receiver_errors(stored.bytes(), *loaded, "a.opal")) << "byte " << i;
        byte ^= std::byte{0x40};
    }
    EXPECT_TRUE(read_errors(stored.bytes()));
}

// Every bit, with its checksum made right: sound numbers, or a refusal; never a fault of memory.
TEST(ReceiverErrorsFile, ForgedBitsGiveSoundNumbersOrNone) {
    const auto whole = encode_with_errors(make_receiver_errors());
    AlignedBytes stored(whole);
    const auto table = read_section_table(stored.bytes(), "a.opal");
    ASSERT_TRUE(table);
    const SectionEntry section = tests::section_of(*table, kRerrSection);
    std::size_t refused = 0;
    for (std::uint64_t bit = 0; bit < 8 * section.stored_size; ++bit) {
        AlignedBytes forged(whole);
        forged.bytes()[section.offset + bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        tests::repair_checksums(forged.bytes(), kRerrSection);
        const auto errors = read_errors(forged.bytes());
        refused += errors ? 0 : 1;
        if (!errors) continue;
        ASSERT_EQ(errors->size(), make_receiver_errors().size());
        for (const float error : *errors) {
            ASSERT_TRUE(std::isfinite(error) && error >= 0);
        }
    }
    EXPECT_GT(refused, 16u * 8);  // the head at least
}

}  // namespace
}  // namespace opaline::formats
