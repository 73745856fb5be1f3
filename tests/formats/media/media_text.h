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
