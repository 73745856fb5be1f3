#include "formats/media/read_material.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <utility>

#include "formats/gltf/decode_image8.h"
#include "formats/media/fields.h"
#include "formats/media/limits.h"
#include "formats/media/mean_cosine.h"
#include "formats/media/presets.h"
#include "formats/media/read_phase.h"
#include "formats/scene.h"

namespace opaline::formats::media {
namespace {

using gltf::in_quotes;
using gltf::Report;

// The member `thin_walled` of a material, an object with `reflect` and `transmit`, at least one of
// them, whose sum is at most 1 in each channel. Nothing if it is absent or faulty; then the report
// has the fault.
std::optional<Sheet> read_sheet(const Fields& material) {
    const char* const example =
        "give an object such as {\"reflect\": [0.1, 0.2, 0.05], \"transmit\": [0.2, 0.4, 0.05]}";
    const auto found = object_in(material, "thin_walled", example);
    if (!found) return std::nullopt;
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

// Veins, and whether they act inside the medium or on the light that leaves.
struct PlacedMarble {
    Marble marble;
    bool is_inside = false;
};

/// Most of the stone is white: only near a vein does the colour change.
const std::vector<Rgb>& default_colors() {
    static const std::vector<Rgb> kColors = {
        {0.30f, 0.30f, 0.32f}, {0.66f, 0.65f, 0.64f}, {0.9f, 0.89f, 0.87f}, {1, 1, 1}, {1, 1, 1}};
    return kColors;
}

// The member `marble` of a material, an object with `scale` [m], `colors` and `inside`, all of
// which have defaults: grey veins in white stone, 40 mm apart, on the light that leaves. Nothing
// if it is absent or faulty; then the report has the fault.
std::optional<PlacedMarble> read_marble(const Fields& material) {
    const auto found = object_in(material, "marble", "give an object such as {\"scale\": 0.04}");
    if (!found) return std::nullopt;
    const Fields& fields = *found;
    refuse_unknown_keys(fields, {"scale", "colors", "inside"});
    PlacedMarble placed;
    Marble& marble = placed.marble;
    number(fields, "scale", kMinMarbleScale, kMaxMarbleScale, marble.scale);
    marble.colors =
        rgb_list(fields, "colors", 2, kMaxMarbleColors, 0, 1).value_or(default_colors());
    placed.is_inside = truth(fields, "inside").value_or(false);
    return placed;
}

bool is_black(Rgb c) {
    return c == Rgb{};
}

/// The image that a key names.
std::optional<Image8> read_image(const Fields& fields, const char* key,
                                 gltf::Resources& resources) {
    const auto bytes = read_named_file(fields, key, resources);
    if (!bytes) return std::nullopt;
    gltf::DecodedImage8 decoded = gltf::decode_image8(*bytes);
    if (!decoded.fault.empty()) {
        return fields.report.fail(place(fields.where, key), decoded.fault,
                                  "save the texture again as 8-bit PNG or JPEG");
    }
    return std::move(decoded.image);
}

/// Each key of `others` beside `key` contradicts it.
void refuse_beside(const Fields& fields, const char* key, std::initializer_list<const char*> others,
                   const char* remedy) {
    if (!has(fields, key)) return;
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
                         "known are: " + listed(media_preset_names()));
        }
    }
    if (has(fields, "preset")) return true;
    const bool reduced = has(fields, "sigma_s_prime");
    if (!reduced && !has(fields, "sigma_s")) {
        report.error(fields.where, "it has no scattering coefficient",
                     "give preset, or sigma_s or sigma_s_prime with sigma_a, or \"opaque\": true");
    }
    if (!has(fields, "sigma_a")) {
        report.error(fields.where, "sigma_a is missing",
                     "give absorption, [0, 0, 0] where there is none");
    }
    const double scale = per_metre(fields), most = kMaxCoefficientPerM / scale;
    medium.sigma_s =
        rgb(fields, reduced ? "sigma_s_prime" : "sigma_s", 0, most, scale).value_or(Rgb{});
    medium.sigma_a = rgb(fields, "sigma_a", 0, most, scale).value_or(Rgb{});
    if (!report.failed() && is_black(medium.sigma_s) && is_black(medium.sigma_a)) {
        report.error(fields.where, "scattering and absorption are zero in every channel",
                     "give a coefficient above 0, or \"opaque\": true");
    }
    return reduced;
}

std::optional<Medium> read_medium(const Fields& fields, gltf::Resources& resources) {
    Medium medium;
    const bool reduced = read_coefficients(fields, medium);
    if (const auto phase =
            object_in(fields, "phase", "give an object such as {\"type\": \"hg\", \"g\": 0.3}")) {
        medium.phase = read_phase(*phase, resources).value_or(PhaseFunction{});
    }
    if (reduced) {
        medium.sigma_s = static_cast<float>(1 / (1 - mean_cosine(medium.phase))) * medium.sigma_s;
    }
    number(fields, "eta", kMinEta, kMaxEta, medium.eta);
    number(fields, "roughness", 0, 1, medium.roughness);
    number(fields, "thickness", kMinThickness, kMaxThickness, medium.thickness);
    medium.profile = static_cast<Medium::Profile>(
        choice(fields, "profile", {"auto", "classic", "better", "beams", "normalized"})
            .value_or(0));
    medium.fidelity = is_paper(fields) ? Medium::Fidelity::paper : Medium::Fidelity::physical;
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
    if (!is_veined && !has(fields, "scatter_texture") && !has(fields, "density_texture")) return;
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
    const bool is_thin = has(fields, "thin_walled");
    if (is_thin || truth(fields, "opaque").value_or(false)) {
        const char* const key = is_thin ? "thin_walled" : "opaque";
        refuse_beside(
            fields, key,
            {"preset", "sigma_s", "sigma_s_prime", "sigma_a", "unit", "phase", "eta", "roughness",
             "profile", "fidelity", "thickness", "scatter_texture", "density_texture"},
            is_thin ? "give a medium or thin_walled" : "give a medium or \"opaque\": true");
        refuse_beside(fields, "thin_walled", {"opaque"}, "give a medium or thin_walled");
        refuse_veins_inside(fields, marble);
    } else {
        material.medium = read_medium(fields, resources);
        vary(fields, marble, *material.medium);
    }
    return material;
}

}  // namespace opaline::formats::media
