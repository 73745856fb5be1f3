#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "formats/image/srgb.h"
#include "formats/media/height_fields.h"

namespace opaline::bake {
namespace {

constexpr double kSize = 24000;  // [m]
constexpr std::uint32_t kSide = 512;

std::vector<float> cells(double scale, std::uint32_t seed) {
    return formats::make_height_field(
        {.scale = scale, .coverage = 1, .seed = seed, .resolution = kSide}, {kSize, kSize});
}

float blend(float from, float to, float share) {
    return from + (to - from) * std::clamp(share, 0.0f, 1.0f);
}

}  // namespace

formats::Image8 make_icy_sea() {
    constexpr formats::Rgb kSea{0.045f, 0.06f, 0.075f}, kIce{0.78f, 0.8f, 0.83f};
    const std::vector<float> sheets = cells(12000, 5), floes = cells(1300, 9);
    formats::Image picture{kSide, kSide, {}};
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        // From 0 at sea to 1 well inside a sheet: ever more of the floes hang together.
        const float inside = std::clamp((sheets[i] - 0.74f) / 0.18f, 0.0f, 1.0f);
        const float water_between = blend(1.05f, 0.62f, std::sqrt(inside));
        constexpr float kEdge = 0.02f;
        const float ice = (floes[i] - water_between) / kEdge;
        const float snow = blend(0.85f, 1, 4 * (floes[i] - water_between));
        picture.pixel.push_back({blend(kSea.r, snow * kIce.r, ice),
                                 blend(kSea.g, snow * kIce.g, ice),
                                 blend(kSea.b, snow * kIce.b, ice)});
    }
    return formats::to_srgb(picture);
}

std::string describe_stratus(const std::string& ground) {
    using Json = nlohmann::ordered_json;
    const Json formula = {{"type", "cellular"}, {"scale", 1500}, {"coverage", 0.88}, {"seed", 3}};
    const Json layer = {{"procedural", formula},
                        {"thickness", 240},
                        {"N0", 3e8},
                        {"r_e", 7e-6},
                        {"gamma", 2},
                        {"base", 800},
                        {"size", {kSize, kSize}},
                        {"repeat", true},
                        {"wind", {8, 3}},
                        {"visibility", 40000},
                        {"ground", ground}};
    return Json{{"clouds", Json::array({layer})}}.dump(2) + "\n";
}

}  // namespace opaline::bake
