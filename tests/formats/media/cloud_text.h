#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/media/media_file.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {

/// {"clouds": [{ENTRY}]}
inline std::string cloud_text(const std::string& entry) {
    return R"({"clouds": [{)" + entry + "}]}";
}

/// Reads that text as a file beside those of the folder.
inline formats::Result<formats::MediaFile> read_cloud_in(const TemporaryFolder& folder,
                                                         const std::string& entry) {
    write_text(folder / "media.json", cloud_text(entry));
    return formats::read_media(folder / "media.json");
}

/// The only layer; expects success.
inline formats::CloudEntry cloud_of(const formats::Result<formats::MediaFile>& media) {
    EXPECT_TRUE(media.has_value()) << faults(media);
    if (!media || media->clouds.size() != 1) {
        ADD_FAILURE() << "no layer";
        return {};
    }
    return media->clouds[0];
}

/// An entry that is refused, the place that is named, and part of the fault or remedy.
struct CloudFault {
    std::string entry;
    const char *place, *fault;
};
/// `start` stands before each entry.
inline void expect_cloud_faults(const TemporaryFolder& folder, const std::string& start,
                                const std::vector<CloudFault>& cases) {
    for (const auto& [entry, place, fault] : cases) {
        EXPECT_THAT(faults(read_cloud_in(folder, start + entry)),
                    testing::AllOf(testing::HasSubstr(place), testing::HasSubstr(fault)))
            << entry;
    }
}

/// What formats/scene.h promises of every layer.
inline bool is_sound(const formats::CloudEntry& cloud) {
    const formats::CloudLayer& layer = cloud.layer;
    const auto within = [](double value, double least, double most) {
        return value >= least && value <= most;
    };
    const bool has_thickness =
        cloud.shape ? layer.thickness.empty() && within(cloud.shape->coverage, 0, 1) &&
                          within(cloud.shape->scale, 1, 1e7) && cloud.shape->resolution >= 16 &&
                          within(cloud.shape->frames, 1, 256)
                    : layer.columns >= 2 && layer.rows >= 2 &&
                          layer.thickness.size() ==
                              std::size_t{layer.columns} * layer.rows * layer.frames &&
                          std::all_of(layer.thickness.begin(), layer.thickness.end(),
                                      [](float t) { return t >= 0 && t <= 1e5f; });
    const std::uint32_t frames = cloud.shape ? cloud.shape->frames : layer.frames;
    const bool has_times = frames > 1 ? within(layer.frame_seconds, 1e-3, 1e9)
                                      : layer.frame_seconds == 0 && !layer.loops;
    return has_thickness && has_times &&
           static_cast<float>(layer.ground) < static_cast<float>(layer.base) &&
           std::abs(layer.base) <= 1e6 && within(layer.size.x, 1, 1e7) &&
           within(layer.size.y, 1, 1e7) && std::abs(layer.center.x) <= 1e7 &&
           std::abs(layer.center.y) <= 1e7 && std::abs(layer.wind.x) <= 1e4 &&
           std::abs(layer.wind.y) <= 1e4 && within(layer.visibility, 0, 1e7) &&
           within(layer.droplets, 1e3, 1e13) && within(layer.effective_radius, 1e-7, 1e-4) &&
           within(layer.gamma, 0.1, 1e4) && within(layer.peak_angle.value_or(0), 0, 1.5) &&
           layer.ground_albedo.size() == std::size_t{layer.ground_columns} * layer.ground_rows &&
           !layer.ground_albedo.empty();
}

}  // namespace opaline::tests
