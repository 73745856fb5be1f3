#include "runtime/web/page_asset.h"

#include <span>

#include "formats/opal/ggx_albedo.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/sun_phase.h"
#include "runtime/web/data_script.h"
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

}  // namespace

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

}  // namespace opaline::runtime
