#include "formats/media/read_marble.h"

#include <nlohmann/json.hpp>

#include "formats/media/limits.h"

namespace opaline::formats::media {

namespace {

/// Most of the stone is white: only near a vein does the colour change.
const std::vector<Rgb>& default_colors() {
    static const std::vector<Rgb> kColors = {
        {0.30f, 0.30f, 0.32f}, {0.66f, 0.65f, 0.64f}, {0.9f, 0.89f, 0.87f}, {1, 1, 1}, {1, 1, 1}};
    return kColors;
}

}  // namespace

std::optional<PlacedMarble> read_marble(const Fields& material) {
    const auto found = material.object.find("marble");
    if (found == material.object.end()) {
        return std::nullopt;
    }
    const std::string where = place(material.where, "marble");
    if (!found->is_object()) {
        material.report.error(where, "it is not an object",
                              "give an object such as {\"scale\": 0.04}");
        return std::nullopt;
    }
    const Fields fields{*found, where, material.report};
    refuse_unknown_keys(fields, {"scale", "colors", "inside"});
    PlacedMarble placed;
    Marble& marble = placed.marble;
    marble.scale = static_cast<float>(number(fields, "scale", kMinMarbleScale, kMaxMarbleScale)
                                          .value_or(static_cast<double>(marble.scale)));
    marble.colors =
        rgb_list(fields, "colors", 2, kMaxMarbleColors, 0, 1).value_or(default_colors());
    placed.is_inside = truth(fields, "inside").value_or(false);
    return placed;
}

}  // namespace opaline::formats::media
