#include "runtime/web/web_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/ggx_albedo.h"
#include "page_text.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/gloss.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/layer_pass.h"
#include "runtime/picture/volume_pass.h"
#include "runtime/reduce_map.h"
#include "runtime/specular.h"
#include "runtime/volumes/sun_phase.h"
#include "runtime/web/data_script.h"
#include "runtime/web/divide_light.h"
#include "runtime/web/page_layer.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;

template <class T>
std::span<const float> floats_of(std::span<const T> values) {
    static_assert(sizeof(T) % sizeof(float) == 0);
    return {reinterpret_cast<const float*>(values.data()),
            values.size() * (sizeof(T) / sizeof(float))};
}

// `of`: what begins the names.
void put_rows(DataScript& script, const std::string& of, const formats::SparseRowsView& rows) {
    script.put(of + "code bits", std::array{rows.code_bits});
    script.put(of + "row offset", rows.row_offset);
    script.put(of + "average scale", rows.average_scale);
    script.put(of + "detail scale", rows.detail_scale);
    script.put(of + "average code", rows.average_code);
    rows.index_bytes == 2 ? script.put(of + "index", rows.index16)
                          : script.put(of + "index", rows.index32);
    rows.code_bits == 8 ? script.put(of + "code", rows.code8)
                        : script.put(of + "code", rows.code16);
}

void put_volumes(DataScript& script, const formats::VolumesView& volumes) {
    script.put_records("volumes", volumes.records);
    if (volumes.empty()) return;
    script.put("brick table", volumes.table);
    script.put("density scale", volumes.density_scale);
    script.put("density", volumes.density);
    script.put("corners", volumes.corner);
    script.put("phase", volumes.phase);
    std::vector<std::uint32_t> terms;
    std::vector<float> powers;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const SunPhase phase = make_sun_phase(volumes.records[v], volumes.phase_of(v));
        terms.push_back(phase.terms);
        powers.insert(powers.end(), phase.power.begin(), phase.power.end());
    }
    script.put("sun terms", terms);
    script.put("sun powers", powers);
    script.put("sun tables", pack_sun_tables(volumes));
    put_rows(script, "volume ", volumes.rows);
    script.put_records("glow", volumes.glow.record);
    script.put("glow bricks", volumes.glow.brick);
    script.put("glow codes", volumes.glow.code);
    script.put("glow values", volumes.glow.value);
}

void put_images(DataScript& script, const AssetView& asset) {
    std::vector<std::uint32_t> sizes;
    for (std::size_t i = 0; i < asset.images.size(); ++i) {
        sizes.push_back(asset.images[i].width);
        sizes.push_back(asset.images[i].height);
        script.put("image " + std::to_string(i), asset.images[i].rgb);
    }
    script.put("image sizes", sizes);
}

void put_emitters(DataScript& script, const formats::EmittersView& emitters) {
    std::string names;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) {
        names += (i == 0 ? "" : ",") + script_literal(emitters.name(i));
    }
    script.add_statement("opaline.emitters = [" + names + "]");
    script.put_records("emitter blocks", emitters.block);
    script.put_records("own lights", emitters.own);
    script.put("emitter values", emitters.value);
}

// The default camera at a square picture, the sphere that near planes depend on, and the near plane
// where there is a cloud layer, else 0.
void put_camera(DataScript& script, const AssetView& asset) {
    const Camera camera = frame_asset(asset, 32, 1, 1);
    const UprightBounds upright = bound_upright(asset);
    const BoundingSphere all = bound_asset(asset);
    const float values[] = {camera.eye.x,
                            camera.eye.y,
                            camera.eye.z,
                            camera.target.x,
                            camera.target.y,
                            camera.target.z,
                            static_cast<float>(all.x),
                            static_cast<float>(all.y),
                            static_cast<float>(all.z),
                            static_cast<float>(all.radius),
                            asset.clouds.empty() ? 0 : near_plane_for(asset, camera.eye),
                            static_cast<float>(bound_object(asset).radius),
                            static_cast<float>(upright.radius),
                            static_cast<float>(upright.half_height)};
    script.put("camera", values);
}

/// A script that hands the asset's arrays to the page, as they stand in the file
/// (formats/README.md), with where a camera frames it.
std::string make_asset_script(const AssetView& asset) {
    DataScript script("asset");
    put_camera(script, asset);
    script.put_records("primitives", asset.primitives);
    script.put("slot offset", asset.slots.offset);
    script.put("slots", asset.slots.slot);
    script.put_records("slot mixes", asset.slots.mix);
    script.put("position", floats_of(asset.position));
    script.put("normal", floats_of(asset.normal));
    script.put("base color", floats_of(asset.base_color));
    script.put("texcoord", floats_of(asset.texcoord));
    script.put("triangles", asset.index);
    script.put("roughness", asset.roughness);
    script.put_records("openness", asset.openness);
    script.put_records("gloss", asset.gloss);
    script.put_records("holes", asset.holes.record);
    script.put("alpha", asset.holes.vertex_alpha);
    script.put_records("normal maps", asset.normal_maps.record);
    script.put_records("tangents", asset.normal_maps.tangent);
    if (!asset.gloss.empty()) script.put("albedo", floats_of(formats::ggx_albedo_table()));
    script.put("cubemap", std::array{asset.cubemap_size});
    put_rows(script, "", asset.transport);
    put_volumes(script, asset.volumes);
    if (!asset.clouds.empty()) put_layer(script, asset);
    put_images(script, asset);
    put_emitters(script, asset.emitters);
    return script.text();
}

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
