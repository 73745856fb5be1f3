#include "bake/lab/sweep/report_page.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/image/png.h"
#include "runtime/picture/tone_map.h"
#include "runtime/web/data_script.h"

namespace opaline::bake {
namespace {

using runtime::Picture;

using Json = nlohmann::ordered_json;

formats::Result<std::string> data_uri(const formats::Image8& image) {
    const auto png = formats::encode_png(image, "report.html");
    if (!png) return png.error();
    return "data:image/png;base64," +
           runtime::base64_of(std::as_bytes(std::span<const char>(*png)));
}

formats::Result<std::string> photograph(const Picture& picture) {
    runtime::DisplayPicture display = runtime::tone_map(picture, 0.0f);
    return data_uri({display.width, display.height, std::move(display.rgba)});
}

// The pictures of a pair with their difference images.
formats::Result<Json> pair_pictures(const SweepResult& result, const CostPair& pair) {
    const Picture& truth = result.points[result.truth].picture;
    const Picture* const shown[] = {&result.points[pair.better].picture,
                                    &result.points[pair.other].picture};
    Json json;
    json["scale"] = difference_scale(shown, truth);
    json["pictures"] = Json::array();
    json["differences"] = Json::array();
    for (const Picture* picture : shown) {
        auto own = photograph(*picture);
        auto difference = data_uri(draw_difference(*picture, truth, json["scale"].get<double>()));
        if (!own || !difference) return own ? difference.error() : own.error();
        json["pictures"].push_back(std::move(*own));
        json["differences"].push_back(std::move(*difference));
    }
    return json;
}

void replace_mark(std::string& page, std::string_view mark, std::string_view text) {
    if (const std::size_t at = page.find(mark); at != std::string::npos) {
        page.replace(at, mark.size(), text);
    }
}

double difference_at(const Picture& picture, const Picture& truth, std::size_t i) {
    return static_cast<double>(formats::luminance(picture.pixel[i])) -
           static_cast<double>(formats::luminance(truth.pixel[i]));
}

double round_up(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (value <= step * decade * (1 + 1e-9)) return step * decade;
    }
    return 10 * decade;
}

}  // namespace

std::string json_for_html(const Json& json) {
    const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    // Tags, comments and character references begin with these; in JSON they stand in strings only.
    for (const char c : text) {
        safe += c == '<'   ? "\\u003c"
                : c == '>' ? "\\u003e"
                : c == '&' ? "\\u0026"
                           : std::string(1, c);
    }
    return safe;
}

formats::Result<std::string> make_report_page(const SweepResult& result,
                                              const SweepAnalysis& analysis, const Json& json) {
    Json pictures;
    auto truth = photograph(result.points[result.truth].picture);
    if (!truth) return truth.error();
    pictures["truth"] = std::move(*truth);
    for (const auto& [name, pair] : {std::pair{"equal_time", &analysis.equal_time},
                                     std::pair{"equal_error", &analysis.equal_error}}) {
        if (*pair) {
            auto own = pair_pictures(result, **pair);
            if (!own) return own.error();
            pictures[name] = std::move(*own);
        }
    }
    // Insert the data last, so that nothing in it is taken for a placeholder.
    std::string page(kPageTemplate);
    replace_mark(page, "/*STYLE*/", kPageStyle);
    replace_mark(page, "/*LIBRARY*/", kChartLibrary);
    replace_mark(page, "/*POINTS*/", kPointsScript);
    replace_mark(page, "/*CHARTS*/", kChartsScript);
    replace_mark(page, "/*PAGE*/", kPageScript);
    replace_mark(page, "/*PICTURES*/", json_for_html(pictures));
    replace_mark(page, "/*DATA*/", json_for_html(json));
    return page;
}

double difference_scale(std::span<const Picture* const> pictures, const Picture& truth) {
    constexpr double kShown = 0.98;
    std::vector<double> differences;
    for (const Picture* picture : pictures) {
        for (std::size_t i = 0; i < truth.pixel.size(); ++i) {
            if (const double d = std::abs(difference_at(*picture, truth, i)); d > 0) {
                differences.push_back(d);
            }
        }
    }
    if (differences.empty()) return 1.0;
    const auto place =
        differences.begin() +
        static_cast<std::ptrdiff_t>(kShown * static_cast<double>(differences.size() - 1));
    std::nth_element(differences.begin(), place, differences.end());
    return round_up(*place);
}

formats::Image8 draw_difference(const Picture& picture, const Picture& truth, double scale) {
    constexpr std::array<double, 3> kDarker{0, 114, 178}, kBrighter{213, 94, 0};
    formats::Image8 image{truth.width, truth.height, {}};
    image.rgba.reserve(4 * truth.pixel.size());
    for (std::size_t i = 0; i < truth.pixel.size(); ++i) {
        const double d = std::clamp(difference_at(picture, truth, i) / scale, -1.0, 1.0);
        const std::array<double, 3>& full = d < 0 ? kDarker : kBrighter;
        for (const double band : full) {
            image.rgba.push_back(
                static_cast<std::uint8_t>(std::lround(255 + std::abs(d) * (band - 255))));
        }
        image.rgba.push_back(255);
    }
    return image;
}

}  // namespace opaline::bake
