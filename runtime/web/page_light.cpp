#include "runtime/web/page_light.h"

#include <cmath>
#include <span>

#include "runtime/gloss_tables.h"
#include "runtime/reduce_map.h"
#include "runtime/specular.h"
#include "runtime/web/data_script.h"
#include "runtime/web/divide_light.h"
#include "runtime/web/page_layer.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;

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
    script.put(name, std::span<const float>(values));
}

void put_shining(DataScript& script, const Environment& environment, unsigned threads) {
    const DividedLight divided = divide_light(environment, threads);
    script.put_radiance("cube", divided.cube, kPageTexels, kDroppedOfLight);
    script.put("points", std::span<const float>(divided.points));
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
    script.put("background.shape", std::span<const std::uint32_t>(shape));
    script.put("background.turn", std::span<const float>(turn));
    script.put_radiance("background", map.pixel, map.width, kDroppedOfBackground);
}

}  // namespace

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
        script.put("cells", std::span<const float>(cells));
    }
    for (const SpecularLight::Map& map :
         prefilter_specular(environment, needs.levels, {}, threads).maps) {
        script.put_radiance("mirrored." + std::to_string(map.level), map.radiance.pixel,
                            map.radiance.width, kDroppedOfLight);
    }
    return script.text();
}

}  // namespace opaline::runtime
