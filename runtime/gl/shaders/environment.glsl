// Radiance of the environment, as formats::sample_radiance has it. cube_map.glsl and arc_tangent.glsl come before
// it.
layout(location = 5) uniform mat3 light_from_world;
layout(location = 6) uniform int layout_kind;   // 0 no map, 1 lat-long, 2 cube
layout(location = 7) uniform vec2 u_offset_sign;
layout(location = 8) uniform int rows_include_poles;
layout(location = 9) uniform int discs;

layout(binding = 0) uniform sampler2DArray map;
struct Disc {
    vec4 direction_chord;
    vec4 radiance;
};
layout(binding = 4) uniform sampler2D disc_table;
Disc disc_at(int i) {
    return Disc(texelFetch(disc_table, ivec2(0, i), 0), texelFetch(disc_table, ivec2(1, i), 0));
}

vec3 lat_long_texel(int column, int row, ivec2 size) {
    column = (column + size.x) % size.x;  // column >= -1; % of a negative number is undefined
    return texelFetch(map, ivec3(column, clamp(row, 0, size.y - 1), 0), 0).rgb;
}

vec3 sample_lat_long(vec3 d) {
    ivec2 size = textureSize(map, 0).xy;
    float u = u_offset_sign.x + u_offset_sign.y * arc_tangent(d.z, d.x) / (2.0 * kPi);
    float v = arc_tangent(length(d.xz), d.y) / kPi;
    vec2 at = vec2((u - floor(u)) * float(size.x) - 0.5,
                   rows_include_poles != 0 ? v * float(size.y - 1) : v * float(size.y) - 0.5);
    vec2 low = floor(at), t = at - low;
    ivec2 i = ivec2(low);
    return mix(mix(lat_long_texel(i.x, i.y, size), lat_long_texel(i.x + 1, i.y, size), t.x),
               mix(lat_long_texel(i.x, i.y + 1, size), lat_long_texel(i.x + 1, i.y + 1, size), t.x),
               t.y);
}

float tame(float value) {
    return value > 0.0 ? min(value, 1e35) : 0.0;
}

vec3 sample_map(vec3 d) {
    return layout_kind == 1 ? sample_lat_long(d)
         : layout_kind == 2 ? opaline_sample_cube(map, d)
                            : vec3(0.0);
}

bool is_in_disc(int i, vec3 d) {
    Disc disc = disc_at(i);
    return length(d - disc.direction_chord.xyz) <= disc.direction_chord.w;
}
