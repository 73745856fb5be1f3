#include "formats/media/read_thickness.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "formats/gltf/resources.h"
#include "formats/image/exr.h"
#include "formats/media/fields.h"
#include "formats/media/limits.h"
#include "formats/scene.h"

namespace opaline::formats::media {
namespace {

// Metres from the file's numbers; false where one is not what a thickness can be.
bool scale_thickness(gltf::Report& report, const std::string& where, ScalarImage& image,
                     double metres) {
    for (std::size_t i = 0; i < image.value.size(); ++i) {
        const auto value = static_cast<double>(image.value[i]);
        const double scaled = metres * value;
        if (!(scaled >= 0 && scaled <= kMaxLayerThickness)) {
            const std::size_t row = i / image.width, column = i % image.width;
            const std::string found = std::isnan(value)    ? "is not a number"
                                      : !(value >= 0)      ? "is negative"
                                      : std::isinf(scaled) ? "is infinite"
                                                           : "is more than 1e5 m";
            report.error(where,
                         "its value in column " + std::to_string(column) + " of row " +
                             std::to_string(row) + " " + found,
                         "give the layer's thickness, in metres unless `thickness` says how many "
                         "metres 1 is");
            return false;
        }
        image.value[i] = static_cast<float>(std::abs(scaled));  // no -0
    }
    return true;
}

// One picture in metres.
std::optional<ScalarImage> read_picture(const std::string& name, const std::string& where,
                                        double metres, gltf::Resources& resources,
                                        gltf::Report& report) {
    const auto bytes = gltf::read_inside(resources, name, where, report);
    if (!bytes) return std::nullopt;
    auto image = decode_exr_channel(*bytes, where, {"Y", "R"}, kMaxFieldSide);
    if (!image) {
        const Diagnostic& fault = image.error().diagnostics.front();
        return report.fail(where, fault.fault, fault.remedy);
    }
    if (std::min(image->width, image->height) < kMinFieldSide) {
        return report.fail(where, "it has only one texel on a side", "give 2 or more");
    }
    if (!scale_thickness(report, where, *image, metres)) return std::nullopt;
    return std::move(*image);
}

std::string size_text(std::uint32_t columns, std::uint32_t rows) {
    return std::to_string(columns) + " x " + std::to_string(rows) + " texels";
}

// True where `image` can follow on the frames that the layer has.
bool fits(gltf::Report& report, const std::string& where, const ScalarImage& image,
          std::size_t frames, const CloudLayer& layer) {
    if (!layer.thickness.empty() && (image.width != layer.columns || image.height != layer.rows)) {
        report.error(where,
                     "it has " + size_text(image.width, image.height) + ", the first one has " +
                         size_text(layer.columns, layer.rows),
                     "give pictures of one size");
        return false;
    }
    if (image.value.size() > kMaxFieldTexels / frames) {
        report.error(where,
                     std::to_string(frames) + " frames of " + size_text(image.width, image.height) +
                         " are more than 67108864 in all",
                     "give fewer or smaller pictures");
        return false;
    }
    return true;
}

void read_frame_times(const Fields& fields, CloudLayer& layer) {
    const auto seconds = number(fields, "frame_seconds", kMinFrameSeconds, kMaxFrameSeconds);
    const auto loops = truth(fields, "loop");
    if (layer.frames > 1) {
        if (!has(fields, "frame_seconds")) {
            fields.report.error(fields.where, "nothing says how long each picture is shown",
                                "give frame_seconds, such as 60");
        }
        layer.frame_seconds = seconds.value_or(0);
        layer.loops = loops.value_or(false);
        return;
    }
    for (const char* const key : {"frame_seconds", "loop"}) {
        if (has(fields, key)) {
            fields.report.error(place(fields.where, key), "there is one picture only",
                                "give a list of pictures as height_field, or leave this out");
        }
    }
}

// Thickness of a cloud layer from the pictures that `height_field` names, with `thickness`,
// `frame_seconds` and `loop`. Errors go to the report: files that cannot be read, values that are
// no thickness, frames of different sizes. Precondition: the key is there.
void read_height_field(const Fields& fields, gltf::Resources& resources, CloudLayer& layer) {
    const auto names = texts(fields, "height_field", kMaxFieldFrames);
    const auto metres = number(fields, "thickness", kMinLayerThickness, kMaxLayerThickness);
    if (!names || (has(fields, "thickness") && !metres)) return;
    const bool is_list = fields.object.at("height_field").is_array();
    for (std::size_t i = 0; i < names->size(); ++i) {
        const std::string key = place(fields.where, "height_field");
        const std::string where = is_list ? place(key, std::to_string(i)) : key;
        const auto image =
            read_picture((*names)[i], where, metres.value_or(1), resources, fields.report);
        if (!image || !fits(fields.report, where, *image, names->size(), layer)) return;
        layer.columns = image->width;
        layer.rows = image->height;
        layer.thickness.reserve(names->size() * image->value.size());
        layer.thickness.insert(layer.thickness.end(), image->value.begin(), image->value.end());
    }
    layer.frames = static_cast<std::uint32_t>(names->size());
    read_frame_times(fields, layer);
}

constexpr double kDefaultThickness = 300;  // of a formula [m]
constexpr std::uint32_t kDefaultSide = 512;
constexpr double kDefaultPeriod = 3600;  // about the life of a cell [s]
constexpr std::uint32_t kDefaultFrames = 16;
// Of an even layer: its border, half a texel wide, should be about as steep as a cloud's.
constexpr std::uint32_t kEvenSide = 128;

// What changes of a formula with time.
void read_evolution(const Fields& fields, HeightFieldShape& shape, CloudLayer& layer) {
    refuse_unknown_keys(fields, {"period", "frames"});
    const double period =
        number(fields, "period", kMinEvolutionPeriod, kMaxEvolutionPeriod).value_or(kDefaultPeriod);
    shape.frames =
        count(fields, "frames", kMinEvolutionFrames, kMaxEvolutionFrames).value_or(kDefaultFrames);
    const std::size_t texels = std::size_t{shape.resolution} * shape.resolution;
    if (texels > kMaxFieldTexels / shape.frames) {
        fields.report.error(place(fields.where, "frames"),
                            std::to_string(shape.frames) + " frames of " + std::to_string(texels) +
                                " texels are more than 67108864 in all",
                            "give fewer frames or a lower resolution");
    }
    layer.frame_seconds = period / shape.frames;
    layer.loops = true;
}

std::optional<HeightFieldShape> read_shape(const Fields& fields, CloudLayer& layer) {
    refuse_unknown_keys(fields, {"type", "scale", "coverage", "seed", "resolution", "evolution"});
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
    if (const auto evolution =
            object_in(fields, "evolution", "give an object such as {\"period\": 3600}")) {
        read_evolution(*evolution, shape, layer);
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
    for (const char* const key : {"frame_seconds", "loop"}) {
        if (has(fields, key)) {
            fields.report.error(place(fields.where, key), "there is no height_field",
                                "give a list of pictures as height_field, or leave this out");
        }
    }
    const auto thickness = number(fields, "thickness", kMinLayerThickness, kMaxLayerThickness);
    if (has(fields, "procedural")) {
        if (const auto formula = object_in(fields, "procedural",
                                           "give an object such as {\"type\": \"cellular\"}")) {
            cloud.shape = read_shape(*formula, cloud.layer);
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
    if (file == fields.object.end()) return "even";
    if (file->is_string()) return place("", file->get<std::string>());
    const std::string first = place("", file->front().get<std::string>());
    return file->size() == 1 ? first : first + " and " + std::to_string(file->size() - 1) + " more";
}

}  // namespace opaline::formats::media
