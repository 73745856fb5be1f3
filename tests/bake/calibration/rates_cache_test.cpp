#include "bake/pipeline/calibration/rates_cache.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

const MachineKey kMachine{"Abacus 3000", 7, "1.2.3"};

// With many decimals.
StageRates odd_rates() {
    return {{{"rows + direct", {1.0 / 3, 7}}, {"self-check", {std::sqrt(2.0), 1}}}};
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RatesCache, GivesBackWhatWasKeptToTheLastBit) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "not" / "there" / "calibration.json";
    EXPECT_FALSE(read_rates(file, kMachine));
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    const auto rates = read_rates(file, kMachine);
    ASSERT_TRUE(rates);
    EXPECT_EQ(rates->kinds, odd_rates().kinds);
    // Nothing else is left behind, and the file can be replaced.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
    ASSERT_TRUE(write_rates(file, kMachine, {}));
    EXPECT_TRUE(read_rates(file, kMachine)->kinds.empty());
}

TEST(RatesCache, HoldsForOneProcessorThreadCountAndVersionOnly) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    EXPECT_TRUE(read_rates(file, kMachine));
    EXPECT_FALSE(read_rates(file, {"Abacus 4000", 7, "1.2.3"}));
    EXPECT_FALSE(read_rates(file, {"Abacus 3000", 8, "1.2.3"}));
    EXPECT_FALSE(read_rates(file, {"Abacus 3000", 7, "1.2.4"}));
}

TEST(RatesCache, ProcessorNamesThatAreNotUtf8AreNames) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    const MachineKey odd{"\xff\xfe", 1, "1"};
    ASSERT_TRUE(write_rates(file, odd, odd_rates()));
    EXPECT_TRUE(read_rates(file, odd));
}

TEST(RatesCache, DamagedFilesAreAsGoodAsNone) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    const std::string whole = read_text(file);
    // Every byte is needed, except the last brace and line break.
    for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
        std::ofstream(file, std::ios::binary) << whole.substr(0, size);
        EXPECT_FALSE(read_rates(file, kMachine)) << size;
    }
    const std::size_t name = whole.find("factor"), number = whole.find(':', name) + 2;
    for (const char* bad : {"-1", "0", "null", "\"fast\"", "[]", "1e999"}) {
        std::string text = whole;
        text.replace(number, text.find(',', number) - number, bad);
        std::ofstream(file, std::ios::binary) << text;
        EXPECT_FALSE(read_rates(file, kMachine)) << bad;
    }
    std::string renamed = whole;
    renamed[name] = 'F';
    std::ofstream(file, std::ios::binary) << renamed;
    EXPECT_FALSE(read_rates(file, kMachine));
    std::ofstream(file, std::ios::binary) << "[]";
    EXPECT_FALSE(read_rates(file, kMachine));
    EXPECT_FALSE(read_rates(folder.path(), kMachine));  // a folder
}

TEST(RatesCache, FolderThatCannotBeMadeIsAnErrorToTheCaller) {
    const tests::TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "in the way";
    const auto status = write_rates(folder.path() / "file" / "calibration.json", kMachine, {});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().kind, formats::ErrorKind::resource);
}

TEST(RatesCache, StandsInTheUsersCacheFolder) {
    ::setenv("HOME", "/home/somebody", 1);
    ::setenv("XDG_CACHE_HOME", "/fast/cache", 1);
    EXPECT_EQ(rates_path(), "/fast/cache/opaline/calibration.json");
    // Relative ones are to be ignored, says the XDG specification.
    for (const char* unfit : {"", "cache"}) {
        ::setenv("XDG_CACHE_HOME", unfit, 1);
        EXPECT_EQ(rates_path(), "/home/somebody/.cache/opaline/calibration.json");
    }
    ::unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(rates_path(), "/home/somebody/.cache/opaline/calibration.json");
    ::unsetenv("HOME");
    EXPECT_TRUE(rates_path().empty());
}

}  // namespace
}  // namespace opaline::bake
