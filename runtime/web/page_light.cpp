#include "runtime/web/page_light.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "formats/opal/half.h"
#include "runtime/gloss_light.h"
#include "runtime/reduce_map.h"
#include "runtime/specular.h"
#include "runtime/web/data_script.h"
#include "runtime/web/divide_light.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;

// Radiance = scale * half.
void put_radiance(DataScript& script, const std::string& name, std::span<const Rgb> pixels) {
    constexpr float kMost = 60000;  // below the largest half
    float most = 0;
    for (const Rgb pixel : pixels) {
        most = std::max({most, pixel.r, pixel.g, pixel.b});
    }
    const float scale = most > 0 ? most / kMost : 1.0f;
    std::vector<std::uint16_t> halves;
    halves.reserve(3 * pixels.size());
    for (const Rgb pixel : pixels) {
        for (const float band : {pixel.r, pixel.g, pixel.b}) {
            halves.push_back(formats::half_from_float(std::min(band / scale, kMost)));
        }
    }
    script.put(name, std::span<const std::uint16_t>(halves));
    script.put(name + ".scale", std::span<const float>(&scale, 1));
}

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
    script.put(name, std::span<const float>(values));
}

void put_cells(DataScript& script, const GlossLight::Cells& cells) {
    std::vector<float> values;
    values.reserve(8 * cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        values.insert(values.end(), {cells.x[i], cells.y[i], cells.z[i], cells.solid_angle[i],
                                     cells.r[i], cells.g[i], cells.b[i], cells.widening[i]});
    }
    script.put("cells", std::span<const float>(values));
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
    script.put("background.shape", std::span<const std::uint32_t>(shape));
    script.put("background.turn", std::span<const float>(turn));
    put_radiance(script, "background", map.pixel);
}

}  // namespace

std::string make_light_script(const std::string& owner, const PageLight& light,
                              const LightAboveLayer* above, const PageLightNeeds& needs,
                              unsigned threads) {
    DataScript script(owner);
    const Environment& shining = above != nullptr ? above->below : light.environment;
    const DividedLight divided = divide_light(shining, threads);
    put_radiance(script, "cube", divided.cube);
    script.put("points", std::span<const float>(divided.points));
    put_discs(script, "suns", divided.suns, false);
    put_background(script, light.environment, threads);
    put_discs(script, "discs", light.environment.discs, true);
    if (needs.gloss) put_cells(script, make_gloss_light(shining, threads).cells);
    for (const SpecularLight::Map& map :
         prefilter_specular(shining, needs.levels, {}, threads).maps) {
        put_radiance(script, "mirrored." + std::to_string(map.level), map.radiance.pixel);
    }
    if (above != nullptr) put_layer_light(script, above->layer);
    return script.text();
}

}  // namespace opaline::runtime
