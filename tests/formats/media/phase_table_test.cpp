#include <numbers>

#include "formats/media/mean_cosine.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::PhaseFunction;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

formats::Result<formats::MediaFile> read_table(const std::string& table) {
    const TemporaryFolder folder;
    write_text(folder / "media.json", wax(R"("sigma_s_prime": [1, 1, 1], "sigma_a": [0, 0, 0],
        "unit": "1/m", "phase": {"type": "table", "file": "table.csv"})"));
    write_text(folder / "table.csv", table);
    return formats::read_media(folder / "media.json");
}

formats::Medium must_read(const std::string& table) {
    const auto media = read_table(table);
    EXPECT_TRUE(media.has_value()) << table << "\n" << faults(media);
    return media ? *media->materials.at(0).medium : formats::Medium{};
}

TEST(PhaseTable, IntegratesToOneOverTheSphereWhateverItsScale) {
    const PhaseFunction phase = must_read("-1, 10\n-0.25, 30\n1, 5\n").phase;
    ASSERT_EQ(phase.type, PhaseFunction::Type::tabulated);
    double sum = 0;
    for (std::size_t i = 1; i < phase.cosine.size(); ++i) {
        sum +=
            0.5 * (phase.value[i - 1] + phase.value[i]) * (phase.cosine[i] - phase.cosine[i - 1]);
    }
    EXPECT_NEAR(2 * std::numbers::pi * sum, 1, 1e-6);  // single precision
    EXPECT_FLOAT_EQ(phase.value[1], 3 * phase.value[0]);
}

TEST(PhaseTable, ColumnsHeadingsAndCommentsOfEverySortAreRead) {
    for (const char* table :
         {"-1 1\n0 1\n1 1", "-1,1\r\n0,1\r\n1,1\r\n", "cosine;value\n-1;1\n0;1\n1;1\n",
          "# measured\n\n  -1\t1 # back\n0 1\n1 1\n\n", "-1 2e3\n0.0 2e3\n1e0 2e3"}) {
        EXPECT_THAT(must_read(table).phase.cosine, ElementsAre(-1, 0, 1)) << table;
    }
}

TEST(PhaseTable, ReducedScatteringUsesItsMeanCosine) {
    // p = (1 + mu) / 4 pi has mean cosine 1/3, so that sigma_s = sigma_s' / (1 - 1/3).
    const formats::Medium medium = must_read("-1 0\n1 2\n");
    EXPECT_NEAR(formats::mean_cosine(medium.phase), 1.0 / 3, 1e-6);
    EXPECT_NEAR(medium.sigma_s.g, 1.5f, 1e-5f);
}

TEST(PhaseTable, FaultyRowsAreNamedByTheirLine) {
    for (const char* row : {"0 -1", "0 nan", "0 inf", "0", "0 1 2", "x 1", "0 1e31", "0 1x"}) {
        EXPECT_THAT(faults(read_table(std::string("-1 1\n") + row + "\n1 1\n")),
                    AllOf(HasSubstr("phase > file > line 2"), HasSubstr("a value >= 0")))
            << row;
    }
    for (const char* cosine : {"-1", "-2"}) {
        EXPECT_THAT(faults(read_table(std::string("-1 1\n") + cosine + " 1\n1 1\n")),
                    AllOf(HasSubstr("line 2"), HasSubstr("does not ascend")));
    }
}

TEST(PhaseTable, MustReachFromBackToFront) {
    for (const char* table : {"", "# nothing\n", "-1 1\n", "-1 1\n0.9 1\n", "-0.9 1\n1 1\n",
                              "-1 1\n1.1 1\n", "cosine value\ncosine value\n"}) {
        EXPECT_FALSE(read_table(table).has_value()) << table;
    }
    EXPECT_THAT(faults(read_table("-1 1\n0 1\n")), HasSubstr("do not reach from -1 to 1"));
}

TEST(PhaseTable, BlackAndNearlyDeltaTablesAreRefused) {
    EXPECT_THAT(faults(read_table("-1 0\n1 0\n")), HasSubstr("all zero"));
    EXPECT_THAT(faults(read_table("-1 0\n0.9999 0\n1 1\n")), HasSubstr("mean cosine"));
}

// Absolute, by "..", through a link in the file's own folder, and by a scheme.
TEST(PhaseTable, IsReadFromItsFolderAndFromThoseThatAreAllowed) {
    const TemporaryFolder folder, library, other;
    write_text(library / "table.csv", "-1 1\n1 1\n");
    std::filesystem::create_symlink(library / "table.csv", folder / "link.csv");
    const std::vector<std::filesystem::path> right{library.path()}, wrong{other.path()};
    const auto read = [&](const std::string& name, std::span<const std::filesystem::path> allowed) {
        write_text(
            folder / "media.json",
            wax(R"("preset": "skin1", "phase": {"type": "table", "file": ")" + name + "\"}"));
        return formats::read_media(folder / "media.json", allowed);
    };
    for (const std::string& name :
         {"../" + library.path().filename().string() + "/table.csv",
          (library / "table.csv").string(), std::string("link.csv"), std::string("file:///x")}) {
        EXPECT_EQ(read(name, right).has_value(), name != "file:///x") << name;
        for (const auto& allowed : std::vector<std::vector<std::filesystem::path>>{wrong, {}}) {
            EXPECT_THAT(faults(read(name, allowed)),
                        AllOf(HasSubstr("Wax > phase > file"),
                              HasSubstr("leaves the asset's folder"), HasSubstr("--allow-path")))
                << name;
        }
    }
    EXPECT_THAT(faults(read("none.csv", {})), HasSubstr("cannot be found"));
}

}  // namespace
}  // namespace opaline::tests
