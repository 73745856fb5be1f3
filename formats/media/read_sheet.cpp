#include "formats/media/read_sheet.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace opaline::formats::media {

std::optional<Sheet> read_sheet(const Fields& material) {
    const auto found = material.object.find("thin_walled");
    if (found == material.object.end()) {
        return std::nullopt;
    }
    const std::string where = place(material.where, "thin_walled");
    const char* const example =
        "give an object such as {\"reflect\": [0.1, 0.2, 0.05], \"transmit\": [0.2, 0.4, 0.05]}";
    if (!found->is_object()) {
        material.report.error(where, "it is not an object", example);
        return std::nullopt;
    }
    const Fields fields{*found, where, material.report};
    refuse_unknown_keys(fields, {"reflect", "transmit"});
    if (!has(fields, "reflect") && !has(fields, "transmit")) {
        material.report.error(where, "it has neither reflect nor transmit", example);
        return std::nullopt;
    }
    const Sheet sheet{rgb(fields, "reflect", 0, 1).value_or(Rgb{}),
                      rgb(fields, "transmit", 0, 1).value_or(Rgb{})};
    constexpr float kRounding = 1e-6f;
    const Rgb sum = sheet.reflect + sheet.transmit;
    if (std::max({sum.r, sum.g, sum.b}) > 1 + kRounding) {
        material.report.error(
            where, "reflect and transmit together exceed 1 in a channel",
            "lower one of them: a surface scatters no more light than it receives");
        return std::nullopt;
    }
    return sheet;
}

}  // namespace opaline::formats::media
