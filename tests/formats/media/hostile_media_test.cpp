#include "tests/formats/media/cloud_text.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;

TEST(HostileMedia, EveryTruncatedPrefixIsRefused) {
    ASSERT_TRUE(read_text_as_media(kRichMedia).has_value())
        << faults(read_text_as_media(kRichMedia));
    for (std::size_t size = 0; size < kRichMedia.size(); ++size) {
        const auto media = read_text_as_media(kRichMedia.substr(0, size));
        ASSERT_FALSE(media.has_value()) << size;
        ASSERT_EQ(media.error().kind, ErrorKind::bad_input) << size;
    }
}

TEST(HostileMedia, DeepNestingIsRefusedBeforeAnyParser) {
    std::string text = R"({"materials": )";
    for (int i = 0; i < 20000; ++i) {
        text += "[";
    }
    EXPECT_THAT(faults(read_text_as_media(text)), ::testing::HasSubstr("nests deeper"));
}

TEST(HostileMedia, TooManyRowsOfATableAreRefused) {
    const TemporaryFolder folder;
    std::string table;
    for (int i = 0; i <= 70000; ++i) {
        table += std::to_string(-1 + i * 2.0 / 70000) + " 1\n";
    }
    write_text(folder / "t", table);
    write_text(folder / "media.json",
               wax(R"("preset": "skin1", "phase": {"type": "table", "file": "t"})"));
    EXPECT_THAT(faults(formats::read_media(folder / "media.json")),
                ::testing::HasSubstr("more than 65536 rows"));
}

}  // namespace
}  // namespace opaline::tests
