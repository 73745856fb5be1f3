#include "formats/media/read_material.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/gltf/decode_image8.h"
#include "formats/media/fields.h"
#include "formats/media/limits.h"
#include "formats/media/mean_cosine.h"
#include "formats/media/presets.h"
#include "formats/media/read_marble.h"
#include "formats/media/read_phase.h"
#include "formats/media/read_sheet.h"

namespace opaline::formats::media {

namespace {

using gltf::in_quotes;
using gltf::Report;

std::string preset_list() {
    std::string list;
    for (const std::string_view name : media_preset_names()) {
        list += (list.empty() ? "" : ", ") + std::string(name);
    }
    return list;
}

bool is_black(Rgb c) {
    return c == Rgb{};
}

/// The image that a key names.
std::optional<Image8> read_image(const Fields& fields, const char* key,
                                 gltf::Resources& resources) {
    const auto name = text(fields, key);
    const std::string where = place(fields.where, key);
    const auto bytes =
        name ? gltf::read_inside(resources, *name, where, fields.report) : std::nullopt;
    if (!bytes) {
        return std::nullopt;
    }
    gltf::DecodedImage8 decoded = gltf::decode_image8(*bytes);
    if (!decoded.fault.empty()) {
        fields.report.error(where, decoded.fault, "save the texture again as 8-bit PNG or JPEG");
        return std::nullopt;
    }
    return std::move(decoded.image);
}

/// Each key of `others` beside `key` contradicts it.
void refuse_beside(const Fields& fields, const char* key, std::initializer_list<const char*> others,
                   const char* remedy) {
    if (!has(fields, key)) {
        return;
    }
    for (const char* other : others) {
        if (has(fields, other)) {
            fields.report.error(place(fields.where, other),
                                std::string("it contradicts ") + key + ", which is given too",
                                remedy);
        }
    }
}

/// True where sigma_s holds sigma_s' = (1 - g) sigma_s.
bool read_coefficients(const Fields& fields, Medium& medium) {
    Report& report = fields.report;
    if (const auto name = text(fields, "preset")) {
        if (const auto preset = media_preset(*name)) {
            medium = *preset;
        } else {
            report.error(place(fields.where, "preset"), "there is no preset " + in_quotes(*name),
                         "known are: " + preset_list());
        }
    }
    if (has(fields, "preset")) {
        return true;
    }
    const bool reduced = has(fields, "sigma_s_prime");
    if (!reduced && !has(fields, "sigma_s")) {
        report.error(fields.where, "it has no scattering coefficient",
                     "give preset, or sigma_s or sigma_s_prime with sigma_a, or \"opaque\": true");
    }
    if (!has(fields, "sigma_a")) {
        report.error(fields.where, "sigma_a is missing",
                     "give absorption, [0, 0, 0] where there is none");
    }
    const double per_metre = choice(fields, "unit", {"1/mm", "1/m"}).value_or(0) == 0 ? 1000 : 1;
    const double most = kMaxCoefficientPerM / per_metre;
    medium.sigma_s =
        rgb(fields, reduced ? "sigma_s_prime" : "sigma_s", 0, most, per_metre).value_or(Rgb{});
    medium.sigma_a = rgb(fields, "sigma_a", 0, most, per_metre).value_or(Rgb{});
    if (!report.failed() && is_black(medium.sigma_s) && is_black(medium.sigma_a)) {
        report.error(fields.where, "scattering and absorption are zero in every channel",
                     "give a coefficient above 0, or \"opaque\": true");
    }
    return reduced;
}

std::optional<Medium> read_medium(const Fields& fields, gltf::Resources& resources) {
    Medium medium;
    const bool reduced = read_coefficients(fields, medium);
    if (const auto phase = fields.object.find("phase"); phase != fields.object.end()) {
        const std::string where = place(fields.where, "phase");
        if (phase->is_object()) {
            medium.phase =
                read_phase({*phase, where, fields.report}, resources).value_or(PhaseFunction{});
        } else {
            fields.report.error(where, "it is not an object",
                                "give an object such as {\"type\": \"hg\", \"g\": 0.3}");
        }
    }
    if (reduced) {
        medium.sigma_s = static_cast<float>(1 / (1 - mean_cosine(medium.phase))) * medium.sigma_s;
    }
    medium.eta = static_cast<float>(
        number(fields, "eta", kMinEta, kMaxEta).value_or(static_cast<double>(medium.eta)));
    medium.roughness = static_cast<float>(
        number(fields, "roughness", 0, 1).value_or(static_cast<double>(medium.roughness)));
    medium.thickness =
        static_cast<float>(number(fields, "thickness", kMinThickness, kMaxThickness).value_or(0));
    medium.profile = static_cast<Medium::Profile>(
        choice(fields, "profile", {"auto", "classic", "better", "beams", "normalized"})
            .value_or(0));
    medium.fidelity = static_cast<Medium::Fidelity>(
        choice(fields, "fidelity", {"physical", "paper"}).value_or(0));
    return medium;
}

/// Of a material that has no inside.
void refuse_veins_inside(const Fields& fields, const std::optional<PlacedMarble>& marble) {
    if (marble && marble->is_inside) {
        fields.report.error(place(place(fields.where, "marble"), "inside"),
                            "there is no medium for veins to be inside of",
                            "give a medium, or leave `inside` out");
    }
}

/// What makes a medium differ from point to point, of which there is some.
void vary(const Fields& fields, const std::optional<PlacedMarble>& marble, Medium& medium) {
    const bool is_veined = marble && marble->is_inside;
    if (!is_veined && !has(fields, "scatter_texture") && !has(fields, "density_texture")) {
        return;
    }
    for (const char* key : {"thickness", "profile", "fidelity"}) {
        if (has(fields, key)) {
            fields.report.error(place(fields.where, key),
                                "it contradicts a medium that varies in space",
                                "leave it out, or marble inside, scatter_texture and "
                                "density_texture");
        }
    }
    Variation& variation = medium.variation.emplace();
    if (is_veined) {
        variation.marble = marble->marble;
    }
    variation.g = static_cast<float>(mean_cosine(medium.phase));
}

}  // namespace

MaterialMedium read_material(const std::string& name, const nlohmann::json& entry,
                             const std::string& where, gltf::Resources& resources, Report& report) {
    MaterialMedium material;
    material.name = name;
    if (!entry.is_object()) {
        report.error(where, "it is not an object",
                     "give an object such as {\"preset\": \"marble\"}");
        return material;
    }
    const Fields fields{entry, where, report};
    refuse_unknown_keys(
        fields, {"preset", "sigma_s", "sigma_s_prime", "sigma_a", "unit", "phase", "eta",
                 "roughness", "base_color", "albedo_texture", "marble", "scatter_texture",
                 "density_texture", "profile", "fidelity", "opaque", "thin_walled", "thickness"});
    refuse_beside(fields, "preset", {"sigma_s", "sigma_s_prime", "sigma_a", "unit"},
                  "give the preset or coefficients");
    refuse_beside(fields, "sigma_s", {"sigma_s_prime"}, "give one of them");
    refuse_beside(fields, "thickness", {"profile", "fidelity"}, "sheets have no profile");
    material.base_color = rgb(fields, "base_color", 0, 1);
    material.albedo = read_image(fields, "albedo_texture", resources);
    material.scatter = read_image(fields, "scatter_texture", resources);
    material.density = read_image(fields, "density_texture", resources);
    const std::optional<PlacedMarble> marble = read_marble(fields);
    if (marble && !marble->is_inside) {
        material.marble = marble->marble;
    }
    material.sheet = read_sheet(fields);
    if (has(fields, "thin_walled")) {
        refuse_beside(
            fields, "thin_walled",
            {"preset", "sigma_s", "sigma_s_prime", "sigma_a", "unit", "phase", "eta", "roughness",
             "profile", "fidelity", "opaque", "thickness", "scatter_texture", "density_texture"},
            "give a medium or thin_walled");
        refuse_veins_inside(fields, marble);
    } else if (truth(fields, "opaque").value_or(false)) {
        refuse_beside(
            fields, "opaque",
            {"preset", "sigma_s", "sigma_s_prime", "sigma_a", "unit", "phase", "eta", "roughness",
             "profile", "fidelity", "thickness", "scatter_texture", "density_texture"},
            "give a medium or \"opaque\": true");
        refuse_veins_inside(fields, marble);
    } else {
        material.medium = read_medium(fields, resources);
        vary(fields, marble, *material.medium);
    }
    return material;
}

}  // namespace opaline::formats::media
