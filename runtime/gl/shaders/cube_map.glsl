// Bilinear samples of a cube map whose faces are layers, as formats::sample_map has them.
// The cube map convention of formats/opal/cubemap.h.
vec3 opaline_cube_position(int face, vec2 p) {
    switch (face) {
        case 0: return vec3(1.0, -p.y, -p.x);
        case 1: return vec3(-1.0, -p.y, p.x);
        case 2: return vec3(p.x, 1.0, p.y);
        case 3: return vec3(p.x, -1.0, -p.y);
        case 4: return vec3(p.x, -p.y, 1.0);
        default: return vec3(-p.x, -p.y, -1.0);
    }
}

int opaline_cube_point(vec3 d, out vec2 p) {
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z) {
        p = vec2(d.x > 0.0 ? -d.z : d.z, -d.y) / a.x;
        return d.x > 0.0 ? 0 : 1;
    }
    if (a.y >= a.z) {
        p = vec2(d.x, d.y > 0.0 ? d.z : -d.z) / a.y;
        return d.y > 0.0 ? 2 : 3;
    }
    p = vec2(d.z > 0.0 ? d.x : -d.x, -d.y) / a.z;
    return d.z > 0.0 ? 4 : 5;
}

// Texels a side of a level. Not textureSize(map, level): Mesa's software driver takes one level for
// fragments that ask for several.
int opaline_cube_size(sampler2DArray map, int level) {
    return textureSize(map, 0).x >> level;
}

vec3 opaline_cube_texel(sampler2DArray map, int level, int face, vec2 at) {
    int n = opaline_cube_size(map, level);
    if (min(at.x, at.y) < 0.0 || max(at.x, at.y) > float(n - 1)) {
        // Over the edge: the texel of the neighbouring face that this direction falls into.
        vec2 p;
        face = opaline_cube_point(opaline_cube_position(face, 2.0 * (at + 0.5) / float(n) - 1.0), p);
        at = floor((p * 0.5 + 0.5) * float(n));
    }
    return texelFetch(map, ivec3(clamp(ivec2(at), ivec2(0), ivec2(n - 1)), face), level).rgb;
}

vec3 opaline_sample_cube_level(sampler2DArray map, vec3 d, int level) {
    int n = opaline_cube_size(map, level);
    vec2 p;
    int face = opaline_cube_point(d, p);
    vec2 at = (p * 0.5 + 0.5) * float(n) - 0.5;
    vec2 low = floor(at), t = at - low;
    return mix(mix(opaline_cube_texel(map, level, face, low),
                   opaline_cube_texel(map, level, face, low + vec2(1.0, 0.0)), t.x),
               mix(opaline_cube_texel(map, level, face, low + vec2(0.0, 1.0)),
                   opaline_cube_texel(map, level, face, low + vec2(1.0)), t.x), t.y);
}

vec3 opaline_sample_cube(sampler2DArray map, vec3 d) {
    return opaline_sample_cube_level(map, d, 0);
}
