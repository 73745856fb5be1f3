#include "formats/media/read_sheet.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace opaline::formats::media {

std::optional<Sheet> read_sheet(const Fields& material) {
    const char* const example =
        "give an object such as {\"reflect\": [0.1, 0.2, 0.05], \"transmit\": [0.2, 0.4, 0.05]}";
    const auto found = object_in(material, "thin_walled", example);
    if (!found) {
        return std::nullopt;
    }
    const Fields& fields = *found;
    refuse_unknown_keys(fields, {"reflect", "transmit"});
    if (!has(fields, "reflect") && !has(fields, "transmit")) {
        return material.report.fail(fields.where, "it has neither reflect nor transmit", example);
    }
    const Sheet sheet{rgb(fields, "reflect", 0, 1).value_or(Rgb{}),
                      rgb(fields, "transmit", 0, 1).value_or(Rgb{})};
    constexpr float kRounding = 1e-6f;
    const Rgb sum = sheet.reflect + sheet.transmit;
    if (std::max({sum.r, sum.g, sum.b}) > 1 + kRounding) {
        return material.report.fail(
            fields.where, "reflect and transmit together exceed 1 in a channel",
            "lower one of them: a surface scatters no more light than it receives");
    }
    return sheet;
}

}  // namespace opaline::formats::media
