#include "formats/media/read_thickness.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/media/limits.h"
#include "formats/media/read_height_field.h"

namespace opaline::formats::media {
namespace {

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
    if (file == fields.object.end()) {
        return "even";
    }
    if (file->is_string()) {
        return place("", file->get<std::string>());
    }
    const std::string first = place("", file->front().get<std::string>());
    return file->size() == 1 ? first : first + " and " + std::to_string(file->size() - 1) + " more";
}

}  // namespace opaline::formats::media
