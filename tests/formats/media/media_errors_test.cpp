#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/formats/media/cloud_text.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::HasSubstr;

/// What {"materials": {"Wax": {ENTRY}}}, which must fail, is refused with: all of these.
struct Refused {
    std::string entry;
    std::vector<std::string> said;
};

void expect_file_refused(const std::vector<Refused>& files) {
    for (const auto& [text, said] : files) {
        const auto media = read_text_as_media(text);
        ASSERT_FALSE(media.has_value()) << text;
        EXPECT_EQ(media.error().kind, ErrorKind::bad_input) << text;
        for (const std::string& part : said) {
            EXPECT_THAT(faults(media), HasSubstr(part)) << text;
        }
    }
}

void expect_refused(const std::vector<Refused>& entries) {
    for (const auto& [entry, said] : entries) {
        expect_file_refused({{wax(entry), said}});
    }
}

const std::string kGood = R"("sigma_s": [1, 1, 1], "sigma_a": [0, 0, 0])";
const std::string kAnd = kGood + ", ";

TEST(MediaErrors, MissingFileAndFolderAreNamed) {
    const TemporaryFolder folder;
    for (const auto& path : {folder / "nowhere.json", folder.path()}) {
        const auto media = formats::read_media(path);
        ASSERT_FALSE(media.has_value());
        EXPECT_EQ(media.error().kind, ErrorKind::bad_input);
        EXPECT_EQ(media.error().diagnostics.at(0).file, path.string());
    }
}

TEST(MediaErrors, TextThatIsNoJsonIsRefused) {
    for (const char* text : {"", "hello", "{", "{\"materials\": {}", "{\"materials\": {}} x",
                             "{\"materials\": {\"A\": {\"eta\": NaN}}}",
                             "{\"materials\": {\"A\": {\"eta\": Infinity}}}",
                             "{\"materials\": {\"A\": {\"eta\": 1e999}}}", "{\"\xff\": 1}"}) {
        expect_file_refused({{text, {"JSON: it cannot be parsed"}}});
    }
    expect_file_refused({{"[1]", {"not an object"}}});
}

TEST(MediaErrors, UnknownKeysAreNamedWithThoseKnownAndKeysThatStandTwiceToo) {
    expect_refused(
        {{kAnd + R"("sigma_t": 1)", {"materials > Wax > sigma_t: ", "sigma_s_prime"}},
         {kAnd + R"("phase": {"type": "hg", "g": 0, "G": 1})", {"materials > Wax > phase > G: "}},
         {kAnd + R"("phase": {"type": "rayleigh", "g": 0})", {"materials > Wax > phase > g: "}},
         {kAnd + R"("eta": 1.2, "eta": 1.3)", {"'eta' stands twice"}}});
    expect_file_refused(
        {{R"({"materials": {}, "matter": 1})", {"matter: "}},
         {R"({"materials": {"A": {"preset": "skin1"}, "A": {"opaque": true}}})",
          {"'A' stands twice"}},
         // Control characters of names do not reach the terminal.
         {R"({"materials": {"a\u001b[31mb": {"eta": 9}}})", {"materials > a?[31mb > eta"}}});
    // The same key in two objects is no such case.
    const auto media =
        read_text_as_media(R"({"materials": {"A": {"opaque": true}, "B": {"opaque": true}}})");
    EXPECT_TRUE(media.has_value()) << faults(media);
}

TEST(MediaErrors, WrongTypesAreNamedWithWhatIsExpected) {
    for (const char* bad :
         {"null", "\"x\"", "1", "[1, 2]", "[1, 2, 3, 4]", "[1, 2, \"x\"]", "{}"}) {
        expect_refused(
            {{std::string("\"sigma_a\": [0, 0, 0], \"sigma_s\": ") + bad,
              {"materials > Wax > sigma_s: it is ", "three numbers [red, green, blue]"}}});
    }
    expect_refused({{kAnd + R"("eta": "1.4")", {"Wax > eta", "expected a number"}},
                    {kAnd + R"("roughness": "1.4")", {"Wax > roughness", "expected a number"}},
                    {R"("opaque": 1)", {"expected true or false"}},
                    {R"("preset": 5)", {"expected a text"}},
                    {kAnd + R"("phase": "hg")", {"phase: it is not an object"}}});
    expect_file_refused({{R"({"materials": []})", {"materials: it is not an object"}},
                         {R"({"materials": {"Wax": 5}})", {"Wax: it is not an object"}},
                         {"{}", {"materials: it is missing"}}});
}

TEST(MediaErrors, NumbersOutOfRangeAreNamedWithTheRange) {
    expect_refused({{R"("sigma_s": [1, -0.5, 1], "sigma_a": [0, 0, 0])",
                     {"Wax > sigma_s", "-0.5", "from 0.0 to"}},
                    {R"("sigma_s": [1, 1, 1], "sigma_a": [0, 0, 1e300])", {"Wax > sigma_a"}},
                    {kAnd + "\"roughness\": 1.5", {"Wax > roughness"}},
                    {kAnd + "\"base_color\": [0, 2, 0]", {"Wax > base_color"}}});
    for (const char* eta : {"0.33", "3.01", "-1", "0"}) {
        expect_refused({{kAnd + "\"eta\": " + eta, {"Wax > eta"}}});
    }
    for (const char* g : {"0.991", "-0.991", "1", "7"}) {
        expect_refused({{kAnd + R"("phase": {"type": "hg", "g": )" + g + "}",
                         {"Wax > phase > g", "from -0.99 to 0.99"}}});
    }
    for (const char* angle : {"0", "-0.1", "1.01"}) {
        expect_refused({{kAnd + R"("phase": {"type": "gaussian", "rms_angle": )" + angle + "}",
                         {"Wax > phase > rms_angle"}}});
    }
}

TEST(MediaErrors, UnknownNamesListTheKnownOnes) {
    expect_refused({{R"("preset": "Marble")", {"'Marble'", "marble", "whole-milk"}},
                    {kAnd + R"("unit": "1/cm")", {"1/mm, 1/m"}},
                    {kAnd + R"("profile": "best")", {"beams"}},
                    {kAnd + R"("fidelity": "high")", {"physical, paper"}},
                    {kAnd + R"("phase": {"type": "mie"})", {"gaussian"}}});
}

TEST(MediaErrors, MissingKeysAreNamed) {
    expect_refused({{"", {"Wax: it has no scattering coefficient"}},
                    {R"("sigma_s": [1, 1, 1])", {"sigma_a is missing"}},
                    {R"("sigma_a": [1, 1, 1])", {"no scattering coefficient"}},
                    {kAnd + R"("phase": {"type": "hg"})", {"g is missing"}},
                    {kAnd + R"("phase": {"type": "gaussian"})", {"rms_angle is missing"}},
                    {kAnd + R"("phase": {"type": "table"})", {"file is missing"}},
                    {kAnd + R"("phase": {})", {"type is missing"}}});
}

TEST(MediaErrors, ContradictingKeysAreNamed) {
    for (const std::string key : {"sigma_s", "sigma_s_prime", "sigma_a"}) {
        expect_refused({{R"("preset": "skin1", ")" + key + "\": [1, 1, 1]",
                         {"Wax > " + key, "contradicts preset"}}});
    }
    const std::string thin = R"("thin_walled": {"reflect": [1, 0, 0]}, )";
    expect_refused(
        {{R"("preset": "skin1", "unit": "1/m")", {"contradicts preset"}},
         {kAnd + R"("sigma_s_prime": [1, 1, 1])", {"Wax > sigma_s_prime: it contradicts sigma_s"}},
         {R"("opaque": true, "preset": "skin1")", {"contradicts opaque"}},
         {thin + R"("preset": "skin1")", {"contradicts thin_walled"}},
         {thin + R"("opaque": true)", {"opaque: it contradicts thin_walled"}},
         {R"("thin_walled": {}, "opaque": true)", {"neither reflect"}},
         {R"("preset": "skin1", "thickness": 0)", {"thickness"}},
         {R"("opaque": true, "thickness": 1)", {"contradicts opaque"}},
         {R"("thin_walled": 1)", {"not an object"}},
         {R"("thin_walled": {"transmit": [0.5, 2, 0]})", {"transmit"}},
         {R"("thin_walled": {"reflect": [0.6, 0, 0], "transmit": [0.5, 0, 0]})", {"exceed 1"}},
         {R"("thin_walled": {"reflected": [0.6, 0, 0]})", {"reflected"}}});
}

TEST(MediaErrors, MediumWithoutAnyCoefficientIsRefused) {
    expect_refused(
        {{R"("sigma_s": [0, 0, 0], "sigma_a": [0, 0, 0])", {"zero in every channel"}},
         // So small that single precision has nothing left of it.
         {R"("sigma_s": [1e-300, 0, 0], "sigma_a": [0, 0, 0])", {"zero in every channel"}}});
}

TEST(MediaErrors, MarbleNeedsPositiveScaleAndColoursThatReflectNoMoreThanAll) {
    for (const char* bad :
         {"1", "{\"scale\": 0}", "{\"scale\": -1}", "{\"scale\": 1e7}", "{\"size\": 1}",
          "{\"colors\": [[1, 1, 1]]}", "{\"colors\": [[1, 1, 1], [1, 1]]}",
          "{\"colors\": [[1, 1, 1], [1, 1, 1.5]]}", "{\"colors\": 1}"}) {
        expect_refused({{kAnd + "\"marble\": " + bad, {"Wax > marble"}}});
    }
}

TEST(MediaErrors, TexturesMustBeImagesInTheSameFolder) {
    for (const std::string key : {"albedo_texture", "scatter_texture", "density_texture"}) {
        const std::string place = "Wax > " + key, start = kAnd + "\"" + key + "\": ";
        expect_refused({{start + "\"nowhere.png\"", {place}},
                        {start + "\"../a.png\"", {place}},
                        {start + "\"media.json\"", {place, "PNG or JPEG"}},
                        {start + "3", {place, "a text"}}});
    }
}

TEST(MediaErrors, WhatVariesInsideNeedsAMediumWithoutThicknessProfileOrFidelity) {
    const std::string inside = R"("marble": {"inside": true})", place = "Wax > marble > inside";
    const std::string thin = R"("thin_walled": {"reflect": [1, 1, 1]}, )";
    expect_refused({{kAnd + R"("marble": {"inside": 1})", {place}},
                    {R"("opaque": true, )" + inside, {place}},
                    {thin + inside, {place}}});
    for (const std::string key : {"scatter_texture", "density_texture"}) {
        const std::string picture = "\"" + key + R"(": "a.png")";
        expect_refused({{R"("opaque": true, )" + picture, {key + ": it contradicts opaque"}},
                        {thin + picture, {key + ": it contradicts thin_walled"}}});
    }
    for (const std::string other :
         {R"("thickness": 0.001)", R"("profile": "beams")", R"("fidelity": "paper")"}) {
        expect_refused({{kAnd + inside + ", " + other, {"contradicts a medium that varies"}}});
    }
}

TEST(MediaErrors, EveryFaultIsListedAtOnce) {
    expect_refused(
        {{R"("sigma_s": [1, 1, -1], "sigma_a": 0, "eta": 9, "phase": {"type": "hg", "g": 2})",
          {"materials > Wax > sigma_s", "materials > Wax > sigma_a", "materials > Wax > eta",
           "materials > Wax > phase > g"}}});
}

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
