#include "tests/runtime/embed_gl/host/host_images.h"

#include <cstddef>
#include <sstream>
#include <string>

namespace opaline::test {
namespace {

// from.xy: texture coordinates, begin: alpha of a sample; direction.xy: its pixel.
const char* const kSeeImages = R"(
uniform usampler2D base_color_image, other_image;
uniform ivec2 base_color_wrap, other_wrap;
uniform vec2 cutoff_mode;
void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b) {
    a.rgb = opaline_sample_image(base_color_image, from.xy, base_color_wrap, true);
    b.rgb = opaline_sample_image(other_image, from.xy, other_wrap, false);
    a.a = opaline_covers(begin, cutoff_mode, uvec2(direction.xy), 17u) ? 1.0 : 0.0;
    b.a = 0.0;
}
)";

std::string glsl(const float (&v)[3]) {
    std::ostringstream text;
    text.precision(9);
    text << std::scientific << "vec3(" << v[0] << ", " << v[1] << ", " << v[2] << ")";
    return text.str();
}

template <std::size_t N>
std::string glsl_array(const float (&values)[N][3]) {
    std::string text = "vec3[" + std::to_string(N) + "](";
    for (std::size_t i = 0; i < N; ++i)
        text += (i == 0 ? "" : ", ") + glsl(values[i]);
    return text + ")";
}

}  // namespace

HostPicture make_image_picture(HostApi api, const opaline_gl_image& color,
                               const opaline_gl_image& values, const opaline_gl_images& of) {
    HostPicture picture(api, {"opaline_images.glsl"}, "", kSeeImages);
    picture.bind_texture("base_color_image", color.texture);
    picture.bind_texture("other_image", values.texture);
    picture.bind_texture("opaline_srgb_table", of.srgb_table);
    picture.set_pair("base_color_wrap", color.wrap[0], color.wrap[1]);
    picture.set_pair("other_wrap", values.wrap[0], values.wrap[1]);
    picture.set_numbers("cutoff_mode", of.cutoff_mode[0], of.cutoff_mode[1]);
    return picture;
}

HostPicture make_normal_map_picture(HostApi api, const opaline_gl_normal_map& map) {
    std::ostringstream scale;
    scale.precision(9);
    scale << std::scientific << map.scale;
    const std::string see =
        "uniform usampler2D image;\nuniform ivec2 wrap;\n"
        "void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b) {\n"
        "    OpalineTurnedLight light = OpalineTurnedLight(" +
        glsl_array(map.harmonics) + ", " + glsl(map.least) + ", " + std::to_string(map.suns) +
        ", " + glsl_array(map.sun_direction) + ", " + glsl_array(map.sun_light) +
        ");\n"
        "    vec3 mapped = opaline_mapped_normal(opaline_sample_image(image, from.xy, wrap, "
        "false), " +
        scale.str() +
        ", direction, vec4(normalize(cross(direction, vec3(0.1, 0.2, 1.0))), -1.0));\n"
        "    a = vec4(mapped, 0.0);\n"
        "    b = vec4(opaline_turn_light(light, vec3(begin, 0.9 * begin, 0.8 * begin), direction, "
        "mapped), 0.0);\n}\n";
    HostPicture picture(api, {"opaline_surface.glsl", "opaline_images.glsl"}, "", see);
    picture.bind_texture("image", map.image.texture);
    picture.set_pair("wrap", map.image.wrap[0], map.image.wrap[1]);
    return picture;
}

formats::DecodedTangent host_tangent(formats::Vec3 normal) {
    return {formats::normalize(cross(normal, {0.1f, 0.2f, 1})), -1};
}

}  // namespace opaline::test
