// What a surface of some roughness mirrors, a texel of a cube map's face: the lobe's mean over cells of
// light that are small where they are near (runtime/prefilter.cpp, lobe_cells.cpp). cube_map.glsl comes before it.
layout(location = 0) out vec4 color;
uniform sampler2D tree_cells;  // of 2048 columns, three a cell: centre, solid angle; that of its light; its light
uniform int face, side, levels;
uniform float alpha_squared;

vec4 tree_value(int i) { return texelFetch(tree_cells, ivec2(i & 2047, i >> 11), 0); }

vec3 texel_direction(vec2 at) {
    return normalize(opaline_cube_position(face, 2.0 * at / float(side) - 1.0));
}

float squared_chord(vec3 a, vec3 b) {
    vec3 d = a - b;
    return dot(d, d);
}

// D(theta / 2) max(0, cos theta) up to a factor.
float lobe_toward(vec3 a, vec3 b) {
    float sine_squared = 0.25 * squared_chord(a, b), cosine = 1.0 - 2.0 * sine_squared;
    float ratio = alpha_squared / (alpha_squared * (1.0 - sine_squared) + sine_squared);
    return cosine > 0.0 ? cosine * ratio * ratio : 0.0;
}

// Cells are chosen for tiles of 4 x 2 texels.
void main() {
    vec2 tile = floor(gl_FragCoord.xy / vec2(4.0, 2.0)) * vec2(4.0, 2.0);
    vec3 here = texel_direction(gl_FragCoord.xy), middle = vec3(0.0);
    for (int k = 0; k < 8; ++k) middle += texel_direction(tile + vec2(k & 3, k >> 2) + 0.5);
    middle = normalize(middle);
    float radius = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec2 corner = tile + vec2(3 * (k & 1), k >> 1) + 0.5;
        radius = max(radius, length(texel_direction(corner) - middle));
    }
    vec3 light = vec3(0.0);
    float weight = 0.0;
    // Depth first, from face to face: rows of all faces are counted on.
    int level = 0, row = 0, column = 0;
    while (row < (6 << level)) {
        int at = 3 * (2 * ((1 << (2 * level)) - 1) + (row << level) + column);
        vec4 centre = tree_value(at);
        float half_diagonal = 1.42 / float(1 << level), squared = squared_chord(middle, centre.xyz);
        float lit = sqrt(2.0 * (1.0 + half_diagonal)) + radius;
        float room = 2.0 * half_diagonal * half_diagonal - alpha_squared, reach = -4.0;
        if (room > 0.0) reach = 2.0 * sqrt(room);
        if (level < 3 && alpha_squared > 0.05) reach = 4.0;
        reach += radius;
        bool is_lit = squared <= lit * lit;
        if (is_lit && level + 1 < levels && reach > 0.0 && squared < reach * reach) {
            level += 1;
            row *= 2;
            column *= 2;
            continue;
        }
        if (is_lit) {
            weight += lobe_toward(here, centre.xyz) * centre.w;
            light += lobe_toward(here, tree_value(at + 1).xyz) * tree_value(at + 2).rgb;
        }
        while (level > 0 && (row & column & 1) == 1) {
            level -= 1;
            row >>= 1;
            column >>= 1;
        }
        if (level == 0) {
            row += 1;
        } else if ((column & 1) == 0) {
            column += 1;
        } else {
            column -= 1;
            row += 1;
        }
    }
    color = vec4(min(light / max(weight, 1e-30), vec3(1e35)), 1.0);
}
