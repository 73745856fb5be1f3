#include <nlohmann/json.hpp>

#include "tests/formats/media/cloud_text.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using Json = nlohmann::json;

/// Something of everything.
const std::string kRich = R"({"materials": {
    "Body": {"preset": "marble", "phase": {"type": "gaussian", "rms_angle": 0.3},
             "marble": {"scale": 0.1, "inside": true}},
    "Wax": {"sigma_s_prime": [1, 2, 3], "sigma_a": [0.1, 0, 4e-2], "unit": "1/mm", "eta": 1.44,
            "phase": {"type": "hg", "g": 0.3}, "roughness": 0.2, "base_color": [1, 0.5, 0],
            "profile": "better", "fidelity": "paper"},
    "Ear": {"preset": "skin1", "thickness": 1e-3},
    "Leaf": {"thin_walled": {"reflect": [0.1, 0.2, 0.3], "transmit": [0.4, 0.5, 0.6]}},
    "*": {"opaque": true}},
    "clouds": [{"procedural": {"type": "waves", "scale": 900, "coverage": 0.5, "seed": 3,
                               "resolution": 256,
                               "evolution": {"period": 900, "frames": 8}}, "thickness": 120, "N0": 3e8, "r_e": 7e-6,
                "gamma": 2, "substance": "ice", "base": 1000, "ground_height": 10,
                "size": [9e3, 8000], "center": [1, 2], "wind": [3, 4], "repeat": true,
                "visibility": 3e4, "forward_angle": 5, "ground_albedo": [0.1, 0.2, 0.3]}]})";

void expect_sound_or_refused(const formats::Result<formats::MediaFile>& media) {
    if (!media) {
        ASSERT_FALSE(media.error().diagnostics.empty());
        return;
    }
    for (const auto& material : media->materials) {
        ASSERT_TRUE(!material.medium || is_sound(*material.medium)) << material.name;
    }
    for (const auto& cloud : media->clouds) {
        ASSERT_TRUE(is_sound(cloud)) << cloud.layer.name;
    }
}

TEST(HostileMedia, EveryTruncatedPrefixIsRefused) {
    ASSERT_TRUE(read_text_as_media(kRich).has_value()) << faults(read_text_as_media(kRich));
    for (std::size_t size = 0; size < kRich.size(); ++size) {
        const auto media = read_text_as_media(kRich.substr(0, size));
        ASSERT_FALSE(media.has_value()) << size;
        ASSERT_EQ(media.error().kind, ErrorKind::bad_input) << size;
    }
}

TEST(HostileMedia, SingleFlippedBitsGiveSoundMediaOrAMessage) {
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < kRich.size() * 8; bit += 13) {
        std::string damaged = kRich;
        damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
        const auto media = read_text_as_media(damaged);
        expect_sound_or_refused(media);
        refused += media ? 0 : 1;
        ASSERT_FALSE(HasFatalFailure()) << bit;
    }
    EXPECT_GT(refused, 5 * kRich.size() / 13);  // keys are strict: most bits matter
}

TEST(HostileMedia, ReplacedValuesGiveSoundMediaOrAMessage) {
    const Json values = {0,       1,    -1,   0.5,           -0.99,          1e-300, 1e300, nullptr,
                         "table", true, "hg", Json::array(), Json::object(), 3.0,    1e9,   0.99};
    const Json whole = Json::parse(kRich);
    const Json flat = whole.flatten();
    for (const auto& [path, old] : flat.items()) {
        for (const Json& value : values) {
            Json damaged = whole;
            damaged[Json::json_pointer(path)] = value;
            expect_sound_or_refused(read_text_as_media(damaged.dump()));
            ASSERT_FALSE(HasFatalFailure()) << path << " = " << value;
        }
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
