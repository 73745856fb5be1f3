#include "tests/runtime/embed_gl/host/host_layer.h"

#include <string>

namespace opaline::test {
namespace {

// A pixel of a host whose sky is even; or the layer's parts.
const char* const kSeeLayer = R"(
uniform bool wants_parts;
uniform float spread;
void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b) {
    if (wants_parts) {
        OpalineSeenLayer seen = opaline_layer_see(from, direction, begin, end, spread);
        a = vec4(seen.radiance + 2.0 * seen.glow, seen.distance);
        b = vec4(seen.transmittance, seen.sun_transmittance.b);
        return;
    }
    float ground = opaline_layer_ground_distance(from, direction);
    bool is_sky = ground > 1e8;
    OpalineSeenLayer seen =
        opaline_layer_see(from, direction, begin, is_sky ? 1e30 : ground, spread);
    vec3 behind = is_sky ? vec3(1.0, 0.8, 0.5)
                         : opaline_layer_ground_radiance(from, direction, ground, spread);
    a = vec4(seen.radiance + seen.transmittance * behind + (is_sky ? seen.glow : vec3(0.0)), 1.0);
    b = vec4(0.0);
}
)";

}  // namespace

HostPicture make_layer_picture(HostApi api, const opaline_gl_layer& layer) {
    HostPicture picture(api, {"opaline_layer.glsl"},
                        "#define OPALINE_LAYER_REPEAT " + std::to_string(layer.repeats) +
                            "\n#define OPALINE_LAYER_MODES " + std::to_string(layer.modes) +
                            "\n#define OPALINE_LAYER_GLOW " + std::to_string(layer.glows) + "\n",
                        kSeeLayer);
    picture.bind_texture("opaline_layer_table_values", layer.table_values);
    picture.bind_texture("opaline_layer_sun_values", layer.sun_values);
    picture.bind_texture("opaline_layer_thickness_values", layer.thickness_values);
    picture.bind_texture("opaline_layer_albedo_map", layer.albedo_map);
    picture.bind_texture("opaline_layer_ground_light", layer.ground_light);
    picture.bind_texture("opaline_layer_base_light", layer.base_light);
    picture.bind_block("OpalineLayer", layer.block);
    return picture;
}

}  // namespace opaline::test
