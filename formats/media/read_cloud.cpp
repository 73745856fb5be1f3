#include "formats/media/read_cloud.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "formats/gltf/decode_image8.h"
#include "formats/image/srgb.h"
#include "formats/media/fields.h"
#include "formats/media/limits.h"
#include "formats/media/read_thickness.h"

namespace opaline::formats::media {
namespace {

constexpr float kDefaultAlbedo = 0.2f;

void read_droplets(const Fields& fields, CloudLayer& layer) {
    layer.droplets = number(fields, "N0", kMinDroplets, kMaxDroplets).value_or(layer.droplets);
    layer.effective_radius = number(fields, "r_e", kMinDropletRadius, kMaxDropletRadius)
                                 .value_or(layer.effective_radius);
    layer.gamma = number(fields, "gamma", kMinDropletGamma, kMaxDropletGamma).value_or(layer.gamma);
    layer.ice = choice(fields, "substance", {"water", "ice"}).value_or(0) == 1;
    layer.paper = is_paper(fields);
    // <r^3> = r_e <r^2>, <r^2> = gamma (gamma + 1) r_n^2, r_n = r_e / (gamma + 2).
    const double cube = std::pow(layer.effective_radius, 3) * layer.gamma * (layer.gamma + 1) /
                        ((layer.gamma + 2) * (layer.gamma + 2));
    if (layer.droplets * 4 / 3 * std::numbers::pi * cube > kMaxDropletShare) {
        fields.report.error(fields.where, "its droplets fill more than a hundredth of the space",
                            "lower N0 or r_e: 3e8 per cubic metre and 7e-6 m are usual");
    }
}

void read_place(const Fields& fields, CloudLayer& layer) {
    const auto along = [&](const char* key, double least, double most, glm::dvec2& to) {
        if (const auto two = pair(fields, key, least, most)) {
            to = {(*two)[0], (*two)[1]};
        }
    };
    layer.base = number(fields, "base", -kMaxLayerHeight, kMaxLayerHeight).value_or(layer.base);
    layer.ground =
        number(fields, "ground_height", -kMaxLayerHeight, kMaxLayerHeight).value_or(layer.ground);
    if (!(layer.base - layer.ground >= kMinLayerGap)) {
        fields.report.error(place(fields.where, has(fields, "base") ? "base" : "ground_height"),
                            "the base of the layer is not above the ground",
                            "give a base at least 0.1 m above ground_height");
    }
    along("size", kMinLayerSize, kMaxLayerSize, layer.size);
    along("center", -kMaxLayerCoordinate, kMaxLayerCoordinate, layer.center);
    along("wind", -kMaxWind, kMaxWind, layer.wind);
    layer.repeats = truth(fields, "repeat").value_or(false);
    layer.visibility = number(fields, "visibility", kMinVisibility, kMaxVisibility).value_or(0);
    if (const auto angle = number(fields, "forward_angle", 0, kMaxPeakAngle)) {
        layer.peak_angle = *angle * std::numbers::pi / 180;
    }
}

std::uint8_t code_of(float linear) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(linear)));
}

void read_ground(const Fields& fields, gltf::Resources& resources, CloudLayer& layer) {
    refuse_both(fields, "ground_albedo", "ground");
    const Rgb albedo = rgb(fields, "ground_albedo", 0, 1)
                           .value_or(Rgb{kDefaultAlbedo, kDefaultAlbedo, kDefaultAlbedo});
    layer.ground_albedo = {{code_of(albedo.r), code_of(albedo.g), code_of(albedo.b), 255}};
    if (!has(fields, "ground")) return;
    const auto bytes = read_named_file(fields, "ground", resources);
    if (!bytes) return;
    const gltf::DecodedImage8 decoded = gltf::decode_image8(*bytes);
    const Image8& image = decoded.image;
    const bool is_large = std::max(image.width, image.height) > kMaxFieldSide;
    if (!decoded.fault.empty() || is_large) {
        fields.report.error(place(fields.where, "ground"),
                            is_large ? "it has more than 4096 texels on a side" : decoded.fault,
                            "give a PNG or JPEG of at most 4096 texels on a side");
        return;
    }
    layer.ground_columns = image.width;
    layer.ground_rows = image.height;
    layer.ground_albedo.resize(std::size_t{image.width} * image.height);
    for (std::size_t i = 0; i < layer.ground_albedo.size(); ++i) {
        const std::uint8_t* const texel = &image.rgba[4 * i];
        layer.ground_albedo[i] = {texel[0], texel[1], texel[2], 255};
    }
}

}  // namespace

std::optional<CloudEntry> read_cloud(const nlohmann::json& entry, std::size_t index,
                                     const std::string& where, gltf::Resources& resources,
                                     gltf::Report& report) {
    if (!entry.is_object()) {
        return report.fail(
            where, "it is not an object",
            "give an object such as {\"procedural\": {\"type\": \"cellular\"}, \"base\": "
            "1000}");
    }
    const Fields fields{entry, where, report};
    refuse_unknown_keys(
        fields, {"height_field", "frame_seconds", "loop",          "procedural", "thickness",
                 "N0",           "r_e",           "gamma",         "substance",  "fidelity",
                 "base",         "ground_height", "size",          "center",     "wind",
                 "repeat",       "visibility",    "forward_angle", "ground",     "ground_albedo"});
    CloudEntry cloud;
    cloud.where = where;
    read_droplets(fields, cloud.layer);
    read_place(fields, cloud.layer);
    read_thickness(fields, resources, cloud);
    read_ground(fields, resources, cloud.layer);
    if (report.failed()) return std::nullopt;
    cloud.layer.name =
        "layer " + std::to_string(index + 1) + " (" + describe_thickness(fields) + ")";
    return cloud;
}

}  // namespace opaline::formats::media
