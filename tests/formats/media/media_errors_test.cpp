#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Reads {"materials": {"Wax": {ENTRY}}}, which must fail.
std::string refuse(const std::string& entry) {
    const auto media = read_text_as_media(wax(entry));
    EXPECT_FALSE(media.has_value()) << entry;
    EXPECT_TRUE(media || media.error().kind == ErrorKind::bad_input) << entry;
    return faults(media);
}

std::string refuse_file(const std::string& text) {
    const auto media = read_text_as_media(text);
    EXPECT_FALSE(media.has_value()) << text;
    return faults(media);
}

const std::string kGood = R"("sigma_s": [1, 1, 1], "sigma_a": [0, 0, 0])";

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
        EXPECT_THAT(refuse_file(text), HasSubstr("JSON: it cannot be parsed")) << text;
    }
    EXPECT_THAT(refuse_file("[1]"), HasSubstr("not an object"));
}

TEST(MediaErrors, UnknownKeysAreNamedWithThoseKnown) {
    EXPECT_THAT(refuse(kGood + R"(, "sigma_t": 1)"),
                AllOf(HasSubstr("materials > Wax > sigma_t: "), HasSubstr("sigma_s_prime")));
    EXPECT_THAT(refuse_file(R"({"materials": {}, "matter": 1})"), HasSubstr("matter: "));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "hg", "g": 0, "G": 1})"),
                HasSubstr("materials > Wax > phase > G: "));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "rayleigh", "g": 0})"),
                HasSubstr("materials > Wax > phase > g: "));
}

TEST(MediaErrors, ControlCharactersOfNamesDoNotReachTheTerminal) {
    EXPECT_THAT(refuse_file(R"({"materials": {"a\u001b[31mb": {"eta": 9}}})"),
                HasSubstr("materials > a?[31mb > eta"));
}

TEST(MediaErrors, KeysThatStandTwiceAreNamed) {
    EXPECT_THAT(refuse_file(R"({"materials": {"A": {"preset": "skin1"}, "A": {"opaque": true}}})"),
                HasSubstr("'A' stands twice"));
    EXPECT_THAT(refuse(kGood + R"(, "eta": 1.2, "eta": 1.3)"), HasSubstr("'eta' stands twice"));
    // The same key in two objects is no such case.
    const auto media =
        read_text_as_media(R"({"materials": {"A": {"opaque": true}, "B": {"opaque": true}}})");
    EXPECT_TRUE(media.has_value()) << faults(media);
}

TEST(MediaErrors, WrongTypesAreNamedWithWhatIsExpected) {
    for (const char* bad :
         {"null", "\"x\"", "1", "[1, 2]", "[1, 2, 3, 4]", "[1, 2, \"x\"]", "{}"}) {
        EXPECT_THAT(refuse(std::string("\"sigma_a\": [0, 0, 0], \"sigma_s\": ") + bad),
                    AllOf(HasSubstr("materials > Wax > sigma_s: it is "),
                          HasSubstr("three numbers [red, green, blue]")))
            << bad;
    }
    for (const char* key : {"eta", "roughness"}) {
        EXPECT_THAT(refuse(kGood + ", \"" + key + "\": \"1.4\""),
                    AllOf(HasSubstr(std::string("Wax > ") + key), HasSubstr("expected a number")));
    }
    EXPECT_THAT(refuse(R"("opaque": 1)"), HasSubstr("expected true or false"));
    EXPECT_THAT(refuse(R"("preset": 5)"), HasSubstr("expected a text"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": "hg")"), HasSubstr("phase: it is not an object"));
    EXPECT_THAT(refuse_file(R"({"materials": []})"), HasSubstr("materials: it is not an object"));
    EXPECT_THAT(refuse_file(R"({"materials": {"Wax": 5}})"), HasSubstr("Wax: it is not an object"));
    EXPECT_THAT(refuse_file("{}"), HasSubstr("materials: it is missing"));
}

TEST(MediaErrors, NumbersOutOfRangeAreNamedWithTheRange) {
    EXPECT_THAT(refuse(R"("sigma_s": [1, -0.5, 1], "sigma_a": [0, 0, 0])"),
                AllOf(HasSubstr("Wax > sigma_s"), HasSubstr("-0.5"), HasSubstr("from 0.0 to")));
    EXPECT_THAT(refuse(R"("sigma_s": [1, 1, 1], "sigma_a": [0, 0, 1e300])"),
                HasSubstr("Wax > sigma_a"));
    for (const char* eta : {"0.33", "3.01", "-1", "0"}) {
        EXPECT_THAT(refuse(kGood + ", \"eta\": " + eta), HasSubstr("Wax > eta")) << eta;
    }
    for (const char* g : {"0.991", "-0.991", "1", "7"}) {
        EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "hg", "g": )" + g + "}"),
                    AllOf(HasSubstr("Wax > phase > g"), HasSubstr("from -0.99 to 0.99")))
            << g;
    }
    for (const char* angle : {"0", "-0.1", "1.01"}) {
        EXPECT_THAT(
            refuse(kGood + R"(, "phase": {"type": "gaussian", "rms_angle": )" + angle + "}"),
            HasSubstr("Wax > phase > rms_angle"))
            << angle;
    }
    EXPECT_THAT(refuse(kGood + ", \"roughness\": 1.5"), HasSubstr("Wax > roughness"));
    EXPECT_THAT(refuse(kGood + ", \"base_color\": [0, 2, 0]"), HasSubstr("Wax > base_color"));
}

TEST(MediaErrors, UnknownNamesListTheKnownOnes) {
    EXPECT_THAT(refuse(R"("preset": "Marble")"),
                AllOf(HasSubstr("'Marble'"), HasSubstr("marble"), HasSubstr("whole-milk")));
    EXPECT_THAT(refuse(kGood + R"(, "unit": "1/cm")"), HasSubstr("1/mm, 1/m"));
    EXPECT_THAT(refuse(kGood + R"(, "profile": "best")"), HasSubstr("beams"));
    EXPECT_THAT(refuse(kGood + R"(, "fidelity": "high")"), HasSubstr("physical, paper"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "mie"})"), HasSubstr("gaussian"));
}

TEST(MediaErrors, MissingKeysAreNamed) {
    EXPECT_THAT(refuse(""), HasSubstr("Wax: it has no scattering coefficient"));
    EXPECT_THAT(refuse(R"("sigma_s": [1, 1, 1])"), HasSubstr("sigma_a is missing"));
    EXPECT_THAT(refuse(R"("sigma_a": [1, 1, 1])"), HasSubstr("no scattering coefficient"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "hg"})"), HasSubstr("g is missing"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "gaussian"})"),
                HasSubstr("rms_angle is missing"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {"type": "table"})"), HasSubstr("file is missing"));
    EXPECT_THAT(refuse(kGood + R"(, "phase": {})"), HasSubstr("type is missing"));
}

TEST(MediaErrors, ContradictingKeysAreNamed) {
    for (const char* key : {"sigma_s", "sigma_s_prime", "sigma_a"}) {
        EXPECT_THAT(refuse(std::string(R"("preset": "skin1", ")") + key + "\": [1, 1, 1]"),
                    AllOf(HasSubstr(std::string("Wax > ") + key), HasSubstr("contradicts preset")));
    }
    EXPECT_THAT(refuse(R"("preset": "skin1", "unit": "1/m")"), HasSubstr("contradicts preset"));
    EXPECT_THAT(refuse(kGood + R"(, "sigma_s_prime": [1, 1, 1])"),
                HasSubstr("Wax > sigma_s_prime: it contradicts sigma_s"));
    EXPECT_THAT(refuse(R"("opaque": true, "preset": "skin1")"), HasSubstr("contradicts opaque"));
    EXPECT_THAT(refuse(R"("thin_walled": {"reflect": [1, 0, 0]}, "preset": "skin1")"),
                HasSubstr("contradicts thin_walled"));
    EXPECT_THAT(refuse(R"("thin_walled": {}, "opaque": true)"), HasSubstr("neither reflect"));
    EXPECT_THAT(refuse(R"("preset": "skin1", "thickness": 0)"), HasSubstr("thickness"));
    EXPECT_THAT(refuse(R"("opaque": true, "thickness": 1)"), HasSubstr("contradicts opaque"));
    EXPECT_THAT(refuse(R"("thin_walled": 1)"), HasSubstr("not an object"));
    EXPECT_THAT(refuse(R"("thin_walled": {"transmit": [0.5, 2, 0]})"), HasSubstr("transmit"));
    EXPECT_THAT(refuse(R"("thin_walled": {"reflect": [0.6, 0, 0], "transmit": [0.5, 0, 0]})"),
                HasSubstr("exceed 1"));
    EXPECT_THAT(refuse(R"("thin_walled": {"reflected": [0.6, 0, 0]})"), HasSubstr("reflected"));
}

TEST(MediaErrors, MediumWithoutAnyCoefficientIsRefused) {
    EXPECT_THAT(refuse(R"("sigma_s": [0, 0, 0], "sigma_a": [0, 0, 0])"),
                HasSubstr("zero in every channel"));
    // So small that single precision has nothing left of it.
    EXPECT_THAT(refuse(R"("sigma_s": [1e-300, 0, 0], "sigma_a": [0, 0, 0])"),
                HasSubstr("zero in every channel"));
}

TEST(MediaErrors, MarbleNeedsPositiveScaleAndColoursThatReflectNoMoreThanAll) {
    for (const char* bad :
         {"1", "{\"scale\": 0}", "{\"scale\": -1}", "{\"scale\": 1e7}", "{\"size\": 1}",
          "{\"colors\": [[1, 1, 1]]}", "{\"colors\": [[1, 1, 1], [1, 1]]}",
          "{\"colors\": [[1, 1, 1], [1, 1, 1.5]]}", "{\"colors\": 1}"}) {
        EXPECT_THAT(refuse(kGood + ", \"marble\": " + bad), HasSubstr("Wax > marble")) << bad;
    }
}

TEST(MediaErrors, AlbedoTextureMustBeAnImageInTheSameFolder) {
    EXPECT_THAT(refuse(kGood + R"(, "albedo_texture": "nowhere.png")"),
                HasSubstr("Wax > albedo_texture"));
    EXPECT_THAT(refuse(kGood + R"(, "albedo_texture": "../a.png")"),
                HasSubstr("Wax > albedo_texture"));
    // A file that is there, but no image.
    EXPECT_THAT(refuse(kGood + R"(, "albedo_texture": "media.json")"),
                AllOf(HasSubstr("Wax > albedo_texture"), HasSubstr("PNG or JPEG")));
    EXPECT_THAT(refuse(kGood + R"(, "albedo_texture": 3)"), HasSubstr("a text"));
}

TEST(MediaErrors, TexturesInsideMustBeImagesInTheSameFolder) {
    for (const std::string key : {"scatter_texture", "density_texture"}) {
        for (const std::string bad : {"\"nowhere.png\"", "\"../a.png\"", "\"media.json\"", "3"}) {
            EXPECT_THAT(refuse(kGood + ", \"" + key + "\": " + bad), HasSubstr("Wax > " + key))
                << bad;
        }
    }
}

TEST(MediaErrors, WhatVariesInsideNeedsAMediumWithoutThicknessProfileOrFidelity) {
    const std::string inside = R"("marble": {"inside": true})";
    EXPECT_THAT(refuse(kGood + R"(, "marble": {"inside": 1})"), HasSubstr("Wax > marble > inside"));
    EXPECT_THAT(refuse(R"("opaque": true, )" + inside), HasSubstr("Wax > marble > inside"));
    EXPECT_THAT(refuse(R"("thin_walled": {"reflect": [1, 1, 1]}, )" + inside),
                HasSubstr("Wax > marble > inside"));
    for (const std::string key : {"scatter_texture", "density_texture"}) {
        EXPECT_THAT(refuse(R"("opaque": true, ")" + key + R"(": "a.png")"),
                    HasSubstr(key + ": it contradicts opaque"));
        EXPECT_THAT(refuse(R"("thin_walled": {"reflect": [1, 1, 1]}, ")" + key + R"(": "a.png")"),
                    HasSubstr(key + ": it contradicts thin_walled"));
    }
    for (const std::string other :
         {R"("thickness": 0.001)", R"("profile": "beams")", R"("fidelity": "paper")"}) {
        EXPECT_THAT(refuse(kGood + ", " + inside + ", " + other),
                    HasSubstr("contradicts a medium that varies"))
            << other;
    }
}

TEST(MediaErrors, EveryFaultIsListedAtOnce) {
    const std::string all =
        refuse(R"("sigma_s": [1, 1, -1], "sigma_a": 0, "eta": 9, "phase": {"type": "hg", "g": 2})");
    for (const char* where : {"sigma_s", "sigma_a", "eta", "phase > g"}) {
        EXPECT_THAT(all, HasSubstr(std::string("materials > Wax > ") + where));
    }
}

}  // namespace
}  // namespace opaline::tests
