#include "formats/media/read_thickness.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/image/exr.h"
#include "formats/media/limits.h"

namespace opaline::formats::media {
namespace {

constexpr double kDefaultThickness = 300;  // of a formula [m]
constexpr std::uint32_t kDefaultSide = 512;
// Of an even layer: its border, half a texel wide, should be about as steep as a cloud's.
constexpr std::uint32_t kEvenSide = 128;

// Metres from the file's numbers; empty where one is not what a thickness can be.
void scale_thickness(const Fields& fields, ScalarImage& image, double metres) {
    for (std::size_t i = 0; i < image.value.size(); ++i) {
        const auto value = static_cast<double>(image.value[i]);
        const double scaled = metres * value;
        if (!(scaled >= 0 && scaled <= kMaxLayerThickness)) {
            const std::size_t row = i / image.width, column = i % image.width;
            const std::string found = std::isnan(value)    ? "is not a number"
                                      : !(value >= 0)      ? "is negative"
                                      : std::isinf(scaled) ? "is infinite"
                                                           : "is more than 1e5 m";
            fields.report.error(place(fields.where, "height_field"),
                                "its value in column " + std::to_string(column) + " of row " +
                                    std::to_string(row) + " " + found,
                                "give the layer's thickness, in metres unless `thickness` says "
                                "how many metres 1 is");
            image.value.clear();
            return;
        }
        image.value[i] = static_cast<float>(std::abs(scaled));  // no -0
    }
}

void read_height_field(const Fields& fields, gltf::Resources& resources, CloudLayer& layer) {
    const auto bytes = read_named_file(fields, "height_field", resources);
    const auto metres = number(fields, "thickness", kMinLayerThickness, kMaxLayerThickness);
    if (!bytes || (has(fields, "thickness") && !metres)) {
        return;
    }
    const std::string where = place(fields.where, "height_field");
    auto image = decode_exr_channel(*bytes, where, {"Y", "R"}, kMaxFieldSide);
    if (!image) {
        const Diagnostic& fault = image.error().diagnostics.front();
        fields.report.error(where, fault.fault, fault.remedy);
        return;
    }
    if (std::min(image->width, image->height) < kMinFieldSide) {
        fields.report.error(where, "it has only one texel on a side", "give 2 or more");
        return;
    }
    scale_thickness(fields, *image, metres.value_or(1));
    layer.columns = image->width;
    layer.rows = image->height;
    layer.thickness = std::move(image->value);
}

std::optional<HeightFieldShape> read_shape(const Fields& fields, const CloudLayer& layer) {
    refuse_unknown_keys(fields, {"type", "scale", "coverage", "seed", "resolution"});
    HeightFieldShape shape;
    if (!has(fields, "type")) {
        fields.report.error(fields.where, "its type is missing", "give cellular or waves");
    }
    const auto type = choice(fields, "type", {"cellular", "waves"});
    shape.type = static_cast<HeightFieldShape::Type>(type.value_or(0));
    shape.scale = number(fields, "scale", kMinLayerSize, kMaxLayerSize).value_or(shape.scale);
    shape.coverage = number(fields, "coverage", 0, 1).value_or(shape.coverage);
    shape.seed = count(fields, "seed", 0, 0x7fffffffu).value_or(shape.seed);
    shape.resolution =
        count(fields, "resolution", kMinFormulaSide, kMaxFormulaSide).value_or(kDefaultSide);
    const double longest = std::max(layer.size.x, layer.size.y);
    const double least = kMinCellTexels * longest / shape.resolution;
    if (shape.scale < least) {
        fields.report.error(
            place(fields.where, "scale"),
            "it is less than four texels of the layer, " + std::to_string(least) + " m",
            "give a larger scale, a higher resolution, or a smaller size with "
            "\"repeat\": true");
    }
    return shape;
}

}  // namespace

void read_thickness(const Fields& fields, gltf::Resources& resources, CloudEntry& cloud) {
    refuse_both(fields, "procedural", "height_field");
    if (has(fields, "height_field")) {
        read_height_field(fields, resources, cloud.layer);
        return;
    }
    const auto thickness = number(fields, "thickness", kMinLayerThickness, kMaxLayerThickness);
    const auto formula = fields.object.find("procedural");
    if (formula != fields.object.end()) {
        const std::string where = place(fields.where, "procedural");
        if (formula->is_object()) {
            cloud.shape = read_shape({*formula, where, fields.report}, cloud.layer);
        } else {
            fields.report.error(where, "it is not an object",
                                "give an object such as {\"type\": \"cellular\"}");
        }
        cloud.thickness = thickness.value_or(kDefaultThickness);
        return;
    }
    if (!has(fields, "thickness")) {
        fields.report.error(fields.where, "nothing says how thick it is",
                            "give height_field, procedural or thickness");
    }
    cloud.layer.columns = cloud.layer.rows = kEvenSide;
    cloud.layer.thickness.assign(std::size_t{kEvenSide} * kEvenSide,
                                 static_cast<float>(thickness.value_or(0)));
}

std::string describe_thickness(const Fields& fields) {
    if (const auto formula = fields.object.find("procedural"); formula != fields.object.end()) {
        return formula->at("type").get<std::string>();
    }
    const auto file = fields.object.find("height_field");
    return file == fields.object.end() ? "even" : place("", file->get<std::string>());
}

}  // namespace opaline::formats::media
