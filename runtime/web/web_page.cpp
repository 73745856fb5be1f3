#include "runtime/web/web_page.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "page_text.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/gloss.h"
#include "runtime/picture/layer_pass.h"
#include "runtime/picture/volume_pass.h"
#include "runtime/specular.h"
#include "runtime/web/data_script.h"
#include "runtime/web/page_asset.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;

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

}  // namespace opaline::runtime
