#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using formats::VolumeEntry;
using ::testing::AllOf;
using ::testing::HasSubstr;

formats::Result<formats::MediaFile> read_entry(const std::string& entry) {
    const TemporaryFolder folder;
    write_text(folder / "smoke.vdb", "whatever: not looked into");
    write_text(folder / "media.json", R"({"volumes": [)" + entry + "]}");
    return formats::read_media(folder / "media.json");
}

TEST(ReadVolume, EveryKeyArrives) {
    const auto media = read_entry(R"({"file": "smoke.vdb", "density": "soot", "scale": 2.5,
        "sigma_t": [1, 2, 3], "unit": "1/m", "albedo": [0.5, 0.6, 0.7],
        "phase": {"type": "hg", "g": 0.6},
        "transform": [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 4, 5, 6, 1]})");
    ASSERT_TRUE(media) << faults(media);
    ASSERT_EQ(media->volumes.size(), 1u);
    const VolumeEntry& v = media->volumes[0];
    EXPECT_EQ(v.where, "volumes > 0");
    EXPECT_EQ(v.file.filename(), "smoke.vdb");
    EXPECT_EQ(v.density, "soot");
    EXPECT_EQ(v.scale, 2.5);
    EXPECT_EQ(v.sigma_t, (Rgb{1, 2, 3}));
    EXPECT_EQ(v.albedo, (Rgb{0.5f, 0.6f, 0.7f}));
    EXPECT_EQ(v.phase.g, 0.6f);
    EXPECT_EQ(v.transform * glm::dvec4(1, 1, 1, 1), glm::dvec4(5, 7, 9, 1));
    EXPECT_EQ(media->inputs.size(), 2u) << "the volume's file is an input";
}

TEST(ReadVolume, LightOfItsOwnIsOneGridAndItsScales) {
    const auto media = read_entry(R"({"temperature": "heat", "temperature_scale": 3000,
                                      "emission_scale": 1e-5})");
    ASSERT_TRUE(media) << faults(media);
    EXPECT_EQ(media->volumes[0].temperature, "heat");
    EXPECT_EQ(media->volumes[0].temperature_scale, 3000);
    EXPECT_EQ(media->volumes[0].emission_scale, 1e-5);
    EXPECT_TRUE(media->volumes[0].emission.empty());
    EXPECT_EQ(read_entry(R"({"emission": "flame"})")->volumes[0].emission, "flame");
    for (const char* entry :
         {R"({"emission": "a", "temperature": "b"})", R"({"emission_scale": 2})",
          R"({"temperature_scale": 2})", R"({"emission": "a", "temperature_scale": 2})",
          R"({"emission": "a", "emission_scale": 0})", R"({"emission": 3})",
          R"({"temperature": "a", "temperature_scale": -1})"}) {
        EXPECT_FALSE(read_entry(entry)) << entry;
    }
}

TEST(ReadVolume, FormulasArePhysicalUnlessThePapersAreAskedFor) {
    for (const std::string entry : {R"({"file": "smoke.vdb")", R"({"material": "Milk")"}) {
        EXPECT_FALSE(read_entry(entry + "}")->volumes[0].paper) << entry;
        EXPECT_FALSE(read_entry(entry + R"(, "fidelity": "physical"})")->volumes[0].paper) << entry;
        EXPECT_TRUE(read_entry(entry + R"(, "fidelity": "paper"})")->volumes[0].paper) << entry;
    }
}

TEST(ReadVolume, ExtinctionIsPerMillimetreUnlessItSaysPerMetre) {
    const auto media = read_entry(R"({"sigma_t": [1, 2, 3]})");
    ASSERT_TRUE(media) << faults(media);
    EXPECT_EQ(media->volumes[0].sigma_t, (Rgb{1000, 2000, 3000}));
}

TEST(ReadVolume, MaterialsMayBeMissingBesideVolumes) {
    EXPECT_TRUE(read_text_as_media(R"({"volumes": []})"));
    EXPECT_FALSE(read_text_as_media(R"({})"));
}

TEST(ReadVolume, FaultsAreNamedWithTheirPlace) {
    const struct {
        const char *entry, *place, *fault;
    } cases[] = {
        {"1", "volumes > 0", "not an object"},
        {R"({"file": "nowhere.vdb"})", "volumes > 0 > file", ""},
        {R"({"file": "../smoke.vdb"})", "volumes > 0 > file", "leaves"},
        {R"({"file": 1})", "volumes > 0 > file", ""},
        {R"({"densty": "density"})", "volumes > 0 > densty", ""},
        {R"({"sigma_t": [-1, 0, 0]})", "volumes > 0 > sigma_t", ""},
        {R"({"sigma_t": [1, 1]})", "volumes > 0 > sigma_t", ""},
        {R"({"albedo": [1, 1, 1.1]})", "volumes > 0 > albedo", ""},
        {R"({"albedo": ""})", "volumes > 0 > albedo", ""},
        {R"({"unit": "1/m"})", "volumes > 0 > unit", "no sigma_t"},
        {R"({"scale": 0})", "volumes > 0 > scale", ""},
        {R"({"phase": {"type": "hg", "g": 1}})", "volumes > 0 > phase", ""},
        {R"({"fidelity": "exact"})", "volumes > 0 > fidelity", ""},
        {R"({"fidelity": "paper", "albedo": "colour"})", "volumes > 0 > fidelity", "alike"},
        {R"({"material": "Milk", "fidelity": 1})", "volumes > 0 > fidelity", ""},
        {R"({"phase": 3})", "volumes > 0 > phase", "not an object"},
        {R"({"transform": [1, 0, 0]})", "volumes > 0 > transform", "16 numbers"},
        {R"({"transform": [1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1]})", "transform", "flat"},
        {R"({"transform": [1,0,0,0, 1,1e-12,0,0, 0,0,1,0, 0,0,0,1]})", "transform", "flat"},
        {R"({"transform": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]})", "transform", "last row"},
        {R"({"transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1e10,0,0,1]})", "transform", "1e9"},
    };
    for (const auto& c : cases) {
        EXPECT_THAT(faults(read_entry(c.entry)), AllOf(HasSubstr(c.place), HasSubstr(c.fault)))
            << c.entry;
    }
    EXPECT_THAT(faults(read_text_as_media(R"({"volumes": {}})")), HasSubstr("not an array"));
    std::string many = "{}";
    for (int i = 0; i < 16; ++i)
        many += ",{}";
    EXPECT_THAT(faults(read_entry(many)), HasSubstr("more than 16"));
}

TEST(ReadVolume, ATinyOrHugeVolumeIsNotFlat) {
    for (const char* s : {"1e-8", "1e8"}) {
        std::string matrix = "[S,0,0,0, 0,S,0,0, 0,0,S,0, 0,0,0,1]";
        for (auto at = matrix.find('S'); at != std::string::npos; at = matrix.find('S')) {
            matrix.replace(at, 1, s);
        }
        EXPECT_TRUE(read_entry(R"({"transform": )" + matrix + "}")) << matrix;
    }
}

}  // namespace
}  // namespace opaline::tests
