#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <string>

#include "formats/media/read_media.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// Writes the text as media.json into a fresh folder and reads it.
inline formats::Result<formats::MediaFile> read_text_as_media(const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / "media.json", text);
    return formats::read_media(folder / "media.json");
}

/// Something of everything.
inline const std::string kRichMedia = R"({"materials": {
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

/// {"materials": {"Wax": {ENTRY}}}
inline std::string wax(const std::string& entry) {
    return R"({"materials": {"Wax": {)" + entry + "}}}";
}

/// "where: fault (remedy)" in lines; empty on success.
inline std::string faults(const formats::Result<formats::MediaFile>& result) {
    std::string lines;
    if (!result) {
        for (const auto& one : result.error().diagnostics) {
            lines += one.where + ": " + one.fault + " (" + one.remedy + ")\n";
        }
    }
    return lines;
}

/// The medium of the only entry; expects success.
inline formats::Medium medium_of(const std::string& entry) {
    const auto media = read_text_as_media(wax(entry));
    EXPECT_TRUE(media.has_value()) << entry << "\n" << faults(media);
    if (!media || media->materials.size() != 1 || !media->materials[0].medium) {
        ADD_FAILURE() << "no medium: " << entry;
        return {};
    }
    return *media->materials[0].medium;
}

/// What formats/scene.h promises of every medium.
inline bool is_sound(const formats::Medium& medium) {
    float sum = 0;
    for (const formats::Rgb sigma : {medium.sigma_s, medium.sigma_a}) {
        for (const float band : {sigma.r, sigma.g, sigma.b}) {
            if (!(std::isfinite(band) && band >= 0)) return false;
            sum += band;
        }
    }
    const auto& phase = medium.phase;
    using Type = formats::PhaseFunction::Type;
    return sum > 0 && medium.eta >= 0.333f && medium.eta <= 3 && medium.roughness >= 0 &&
           medium.roughness <= 1 && std::abs(phase.g) <= 0.99f &&
           (phase.type != Type::gaussian || (phase.rms_angle > 0 && phase.rms_angle <= 1)) &&
           phase.cosine.size() == phase.value.size() &&
           (phase.type != Type::tabulated || phase.cosine.size() >= 2);
}

}  // namespace opaline::tests
