#include "formats/media/read_volume.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "formats/media/fields.h"
#include "formats/media/limits.h"
#include "formats/media/read_phase.h"

namespace opaline::formats::media {
namespace {

using Json = nlohmann::json;

/// Sixteen numbers, column by column as in glTF, that keep volumes volumes.
std::optional<glm::dmat4> read_transform(const Fields& fields) {
    const auto found = fields.object.find("transform");
    if (found == fields.object.end()) return glm::dmat4(1);
    const std::string where = place(fields.where, "transform");
    const char* const example =
        "give 16 numbers, column by column, of an affine transform as glTF's `matrix` has them";
    glm::dmat4 matrix(0);
    bool is_right = found->is_array() && found->size() == 16;
    for (int i = 0; is_right && i < 16; ++i) {
        const Json& number = (*found)[static_cast<std::size_t>(i)];
        is_right = number.is_number() && std::abs(number.get<double>()) <= kMaxVolumeCoordinate;
        matrix[i / 4][i % 4] = is_right ? number.get<double>() : 0;
    }
    if (!is_right) {
        return fields.report.fail(where, "it is not 16 numbers, each at most 1e9", example);
    }
    // Relative to its columns, so that neither a tiny nor a huge volume counts as flat.
    const double size = glm::length(matrix[0]) * glm::length(matrix[1]) * glm::length(matrix[2]);
    const bool is_affine =
        matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
    if (!is_affine || !(std::abs(glm::determinant(glm::dmat3(matrix))) > 1e-9 * size)) {
        return fields.report.fail(
            where, is_affine ? "it makes the volume flat" : "its last row is not 0 0 0 1", example);
    }
    return matrix;
}

// Light of its own.
void read_emission(const Fields& fields, VolumeEntry& volume) {
    refuse_both(fields, "emission", "temperature");
    volume.emission = text(fields, "emission").value_or("");
    volume.temperature = text(fields, "temperature").value_or("");
    for (const char* const key : {"emission_scale", "temperature_scale"}) {
        const bool is_of_heat = key == std::string_view("temperature_scale");
        if (has(fields, key) && !has(fields, "temperature") &&
            (is_of_heat || !has(fields, "emission"))) {
            fields.report.error(place(fields.where, key), "there is no grid for it",
                                is_of_heat ? "give temperature, the name of a grid"
                                           : "give emission or temperature, the name of a grid");
        }
    }
    volume.emission_scale =
        number(fields, "emission_scale", kMinEmissionScale, kMaxEmissionScale).value_or(1);
    volume.temperature_scale =
        number(fields, "temperature_scale", kMinTemperatureScale, kMaxTemperatureScale).value_or(1);
}

// The inside of closed meshes.
std::optional<VolumeEntry> read_body(const Fields& fields) {
    refuse_unknown_keys(fields, {"material", "voxels", "fidelity"});
    VolumeEntry volume;
    volume.where = fields.where;
    volume.material = text(fields, "material").value_or("");
    if (fields.object.at("material") == "") {
        fields.report.error(place(fields.where, "material"), "it is empty",
                            "name the material of a closed mesh");
    }
    volume.voxels = count(fields, "voxels", kMinBodyVoxels, kMaxBodyVoxels).value_or(volume.voxels);
    volume.paper = is_paper(fields);
    return volume;
}

}  // namespace

std::optional<VolumeEntry> read_volume(const Json& entry, const std::string& where,
                                       gltf::Resources& resources, gltf::Report& report) {
    if (!entry.is_object()) {
        return report.fail(
            where, "it is not an object",
            "give an object such as {\"file\": \"smoke.vdb\", \"sigma_t\": [2, 2, 2], "
            "\"unit\": \"1/m\"}");
    }
    const Fields fields{entry, where, report};
    if (has(fields, "material")) return read_body(fields);
    refuse_unknown_keys(
        fields, {"file", "density", "sigma_t", "albedo", "unit", "scale", "phase", "transform",
                 "emission", "temperature", "emission_scale", "temperature_scale", "fidelity"});
    VolumeEntry volume;
    volume.where = where;
    if (has(fields, "file")) {
        const auto name = text(fields, "file");
        if (!name || !gltf::read_inside(resources, *name, place(where, "file"), report)) {
            return std::nullopt;
        }
        volume.file = resources.folder / *name;
    }
    volume.density = text(fields, "density").value_or("");
    const double scale = per_metre(fields);
    if (has(fields, "unit") && !has(fields, "sigma_t")) {
        report.error(place(where, "unit"), "there is no sigma_t for it",
                     "give sigma_t, or leave unit out");
    }
    volume.sigma_t =
        rgb(fields, "sigma_t", 0, kMaxCoefficientPerM / scale, scale).value_or(volume.sigma_t);
    if (const auto albedo = entry.find("albedo");
        albedo != entry.end() && albedo->is_string() && *albedo != "") {
        volume.albedo_grid = text(fields, "albedo").value_or("");
    } else {
        volume.albedo = rgb(fields, "albedo", 0, 1).value_or(volume.albedo);
    }
    volume.paper = is_paper(fields);
    if (volume.paper && !volume.albedo_grid.empty()) {
        fields.report.error(place(where, "fidelity"),
                            "the paper's formulas need an albedo that is alike everywhere",
                            "give one albedo instead of a grid, or leave fidelity out");
    }
    volume.scale = number(fields, "scale", kMinDensityScale, kMaxDensityScale).value_or(1);
    read_emission(fields, volume);
    if (const auto phase =
            object_in(fields, "phase", "give an object such as {\"type\": \"hg\", \"g\": 0.6}")) {
        volume.phase = read_phase(*phase, resources).value_or(PhaseFunction{});
    }
    volume.transform = read_transform(fields).value_or(glm::dmat4(1));
    return volume;
}

}  // namespace opaline::formats::media
