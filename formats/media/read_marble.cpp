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
    const auto found = object_in(material, "marble", "give an object such as {\"scale\": 0.04}");
    if (!found) {
        return std::nullopt;
    }
    const Fields& fields = *found;
    refuse_unknown_keys(fields, {"scale", "colors", "inside"});
    PlacedMarble placed;
    Marble& marble = placed.marble;
    number(fields, "scale", kMinMarbleScale, kMaxMarbleScale, marble.scale);
    marble.colors =
        rgb_list(fields, "colors", 2, kMaxMarbleColors, 0, 1).value_or(default_colors());
    placed.is_inside = truth(fields, "inside").value_or(false);
    return placed;
}

}  // namespace opaline::formats::media
