// Steps of what Radiosity does with planes of cells, one a texel: LINES sums cells along an axis
// (clouds/plane_gather.cpp), SHINE makes radiosity of gathered light, ADD adds it up (clouds/radiosity.cpp).
// Planes that light is gathered on have two ghosts on every side.
layout(location = 0) out vec4 color;
uniform sampler2D plane, before;
uniform vec3 gathered_outside;  // which `plane` is without
uniform int adds_before;
const int kGhosts = 2;

#ifdef LINES
uniform sampler2D plan;   // of 2048 columns
uniform ivec2 axis;
uniform int cells_along;  // of `plane` along the axis
uniform uint wraps;
uniform int mixes;        // the first value of a mix a cell: first cell, count, weights; -1: taps
uniform ivec3 taps;       // first cell from a cell's own place, count, first weight

float plan_value(int i) { return texelFetch(plan, ivec2(i & 2047, i >> 11), 0).r; }

// Counted without ghosts.
vec3 cell_at(ivec2 across, int along) {
    if (wraps != 0u) {
        along -= cells_along * ((along >= 0 ? along : along - cells_along + 1) / cells_along);
    }
    if (along < -kGhosts || along >= cells_along + kGhosts) return vec3(0.0);
    return texelFetch(plane, across + (along + kGhosts) * axis, 0).rgb;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy), across = here * (1 - axis);
    int place = here.x * axis.x + here.y * axis.y;
    int first = place - kGhosts + taps.x, count = taps.y, weights = taps.z;
    if (mixes >= 0) {
        int at = mixes + 8 * place;
        first = int(plan_value(at));
        count = int(plan_value(at + 1));
        weights = at + 2;
    }
    vec3 sum = adds_before != 0 ? texelFetch(before, here, 0).rgb : vec3(0.0);
    for (int k = 0; k < count; ++k) {
        sum += plan_value(weights + k) * cell_at(across, first + k);
    }
    color = vec4(sum, 1.0);
}
#else
// Rounding may leave a little less than nothing.
vec3 gathered(ivec2 cell) {
    return max(texelFetch(plane, cell + kGhosts, 0).rgb + gathered_outside, vec3(0.0));
}
#endif

#ifdef SHINE
uniform sampler2D reflecting, shining;
uniform int reflects, shines;
uniform vec3 outside;
uniform ivec2 inner_size;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy) - kGhosts;
    vec3 radiosity = outside;
    if (all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, inner_size))) {
        radiosity = shines != 0 ? texelFetch(shining, cell, 0).rgb : vec3(0.0);
        if (reflects != 0) radiosity = texelFetch(reflecting, cell, 0).rgb * (radiosity + gathered(cell));
    }
    color = vec4(radiosity - outside, 1.0);
}
#endif

#ifdef ADD
uniform vec3 share;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    vec3 sum = adds_before != 0 ? texelFetch(before, cell, 0).rgb : vec3(0.0);
    color = vec4(sum + share * gathered(cell), 1.0);
}
#endif
