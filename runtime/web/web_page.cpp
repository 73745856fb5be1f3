#include "runtime/web/web_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>

#include "page_text.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/gloss.h"
#include "runtime/picture/layer_pass.h"
#include "runtime/picture/volume_pass.h"
#include "runtime/reduce_map.h"
#include "runtime/specular.h"
#include "runtime/web/data_script.h"
#include "runtime/web/divide_light.h"
#include "runtime/web/page_asset.h"
#include "runtime/web/page_layer.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;
using formats::Environment;
using formats::Rgb;

bool ends_with(std::string_view name, std::string_view ending) {
    return name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending;
}

std::uint64_t bytes_of(const AssetView& asset) {
    const formats::SparseRowsView& rows = asset.transport;
    std::uint64_t bytes = rows.row_offset.size_bytes() + rows.average_scale.size_bytes() +
                          rows.detail_scale.size_bytes() + rows.average_code.size_bytes() +
                          rows.index16.size_bytes() + rows.index32.size_bytes() +
                          rows.code8.size_bytes() + rows.code16.size_bytes() +
                          asset.position.size_bytes() + asset.normal.size_bytes() +
                          asset.base_color.size_bytes() + asset.texcoord.size_bytes() +
                          asset.index.size_bytes() + asset.emitters.value.size_bytes();
    bytes += asset.volumes.density.size_bytes() + asset.volumes.corner.size_bytes() +
             asset.volumes.rows.code8.size_bytes() + asset.volumes.rows.code16.size_bytes() +
             asset.volumes.rows.index16.size_bytes() + asset.volumes.rows.index32.size_bytes() +
             asset.volumes.glow.code.size_bytes() + asset.volumes.glow.value.size_bytes() +
             asset.clouds.thickness.size_bytes() + 4 * asset.clouds.ground.size_bytes();
    for (const formats::PreviewImage& image : asset.images) {
        bytes += image.rgb.size_bytes();
    }
    return bytes;
}

// The texts that programs are made of, and the numbers that they share with the CPU.
std::string make_shader_script() {
    std::string script = "\"use strict\";\nopaline.shaders = {\n";
    for (const PageText& part : kPageTexts) {
        if (!ends_with(part.name, ".glsl")) continue;
        script += script_literal(part.name) + ": " + script_literal(part.text) + ",\n";
    }
    const auto constant = [&script](const char* name, const std::string& value) {
        script += std::string(name) + ": " + value + ",\n";
    };
    script += "};\nopaline.constants = {\n";
    constant("LOBE_TAPS", std::to_string(kLobeTaps));
    constant("ALBEDO_ROWS", std::to_string(formats::kAlbedoRows));
    constant("ALBEDO_COLUMNS", std::to_string(formats::kAlbedoColumns));
    constant("NARROW_ROUGHNESS", "\"" + std::to_string(kNarrowRoughness) + "\"");
    constant("WIDE_ROUGHNESS", "\"" + std::to_string(kWideRoughness) + "\"");
    constant("CORNER_TOLERANCE", std::to_string(kCornerTolerance));
    constant("SHEET_TOLERANCE", "\"" + std::to_string(kSheetTolerance) + "\"");
    constant("roughnessSteps", std::to_string(kRoughnessSteps));
    return script + "};\n";
}

std::string list_of(std::span<const std::string> texts) {
    std::string list = "[";
    for (const std::string& text : texts) {
        list += (list.size() > 1 ? "," : "") + script_literal(text);
    }
    return list + "]";
}

std::string make_contents_script(std::span<const PageLight> lights, const std::string& title) {
    std::vector<std::string> names;
    for (const PageLight& light : lights) {
        names.push_back(light.name);
    }
    return "\"use strict\";\nopaline.title = " + script_literal(title) +
           ";\nopaline.lights = " + list_of(names) + ";\n";
}

// Bits of halves that lights do without: what surfaces send on is a sum of many pixels, and a pixel
// of the background errs by 1/512, half a step of a screen.
constexpr unsigned kDroppedOfLight = 1, kDroppedOfBackground = 3;

// Direction, then `last`; radiance, then the solid angle: two texels a disc.
void put_discs(DataScript& script, const std::string& name,
               std::span<const formats::DistantDisc> discs, bool wants_chord) {
    std::vector<float> values;
    values.reserve(8 * discs.size());
    for (const formats::DistantDisc& disc : discs) {
        const float radius = disc.angular_radius;
        values.insert(values.end(), {disc.direction.x, disc.direction.y, disc.direction.z,
                                     wants_chord ? 2.0f * std::sin(0.5f * radius) : radius,
                                     disc.radiance.r, disc.radiance.g, disc.radiance.b,
                                     static_cast<float>(formats::disc_solid_angle(radius))});
    }
    script.put(name, values);
}

void put_shining(DataScript& script, const Environment& environment, unsigned threads) {
    const DividedLight divided = divide_light(environment, threads);
    script.put_radiance("cube", divided.cube, kPageTexels, kDroppedOfLight);
    script.put("points", divided.points);
    put_discs(script, "suns", divided.suns, false);
}

void put_background(DataScript& script, const Environment& environment, unsigned threads) {
    constexpr std::uint32_t kColumns = 1024, kRows = 512, kSide = 512;
    const bool is_cube = environment.layout == Environment::Layout::cube;
    Environment map = environment;
    if (!map.pixel.empty()) {
        map = is_cube ? reduce_cube(environment, kSide, threads)
                      : reduce_lat_long(environment, kColumns, kRows, threads);
    }
    const std::uint32_t layout = map.pixel.empty() ? 0u : is_cube ? 2u : 1u;
    const std::uint32_t shape[] = {layout, map.width, is_cube ? map.width : map.height,
                                   map.rows_include_poles ? 1u : 0u};
    const float turn[] = {map.u_offset, map.u_sign};
    script.put("background.shape", shape);
    script.put("background.turn", turn);
    script.put_radiance("background", map.pixel, map.width, kDroppedOfBackground);
}

}  // namespace

bool is_page_file(std::string_view name) {
    const std::string_view light = "light-";
    if (name.substr(0, light.size()) == light && ends_with(name, ".js")) {
        const std::string_view number = name.substr(light.size(), name.size() - light.size() - 3);
        return number.find_first_not_of("0123456789") == std::string_view::npos;
    }
    return name == "shaders.js" || name == "contents.js" || name == "asset-data.js" ||
           std::any_of(std::begin(kPageTexts), std::end(kPageTexts),
                       [name](const PageText& part) { return part.name == name; });
}

formats::Result<std::vector<PageFile>> make_web_page(const AssetView& asset,
                                                     std::span<const PageLight> lights,
                                                     const std::string& title,
                                                     const std::string& file, unsigned threads) {
    if (asset.primitives.empty() && asset.volumes.empty() && asset.clouds.empty()) {
        return formats::make_error(formats::ErrorKind::bad_input, file, "",
                                   "it has neither surfaces nor volumes nor a cloud layer",
                                   "bake a scene that has one of them");
    }
    if (asset.volumes.records.size() > kMostPageVolumes) {
        return formats::make_error(formats::ErrorKind::bad_input, file, "volumes",
                                   "found " + std::to_string(asset.volumes.records.size()) +
                                       ", a page draws at most " + std::to_string(kMostPageVolumes),
                                   "use `opaline render`, or join them before the bake");
    }
    if (bytes_of(asset) > kMostPageBytes) {
        return formats::make_error(
            formats::ErrorKind::bad_input, file, "",
            "it holds " + std::to_string(bytes_of(asset) >> 20) + " MiB, more than the " +
                std::to_string(kMostPageBytes >> 20) + " MiB that a page can",
            "bake it with fewer coefficients or vertices");
    }
    std::vector<PageFile> files;
    for (const PageText& part : kPageTexts) {
        if (ends_with(part.name, ".glsl")) continue;
        files.push_back({std::string(part.name), std::string(part.text)});
    }
    files.push_back({"shaders.js", make_shader_script()});
    files.push_back({"contents.js", make_contents_script(lights, title)});
    files.push_back({"asset-data.js", make_asset_script(asset)});
    const SpecularNeeds specular = specular_needs(asset);
    const PageLightNeeds needs{specular.levels, specular.gloss};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::string owner = "light-" + std::to_string(i);
        std::optional<LayerLight> above;
        if (!asset.clouds.empty()) {
            above = light_layers(asset.clouds, lights[i].environment, {},
                                 {.time = 0, .threads = threads});
        }
        files.push_back(
            {owner + ".js",
             make_light_script(owner, lights[i], above ? &*above : nullptr, needs, threads)});
    }
    return files;
}

std::string make_light_script(const std::string& owner, const PageLight& light,
                              const LayerLight* above, const PageLightNeeds& needs,
                              unsigned threads) {
    DataScript script(owner);
    const Environment& environment = light.environment;
    put_background(script, environment, threads);
    put_discs(script, "discs", environment.discs, true);
    if (above != nullptr) {
        put_layer_light(script, *above);
        return script.text();
    }
    put_shining(script, environment, threads);
    if (needs.gloss) {
        const std::vector<float> cells = make_cell_table(make_gloss_light(environment, threads));
        script.put("cells", cells);
    }
    for (const SpecularLight::Map& map :
         prefilter_specular(environment, needs.levels, {}, threads).maps) {
        script.put_radiance("mirrored." + std::to_string(map.level), map.radiance.pixel,
                            map.radiance.width, kDroppedOfLight);
    }
    return script.text();
}

}  // namespace opaline::runtime
