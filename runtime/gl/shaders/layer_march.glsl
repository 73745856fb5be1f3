// The thickness of a layer and the way of a ray through it, as clouds/layer_field.cpp and
// clouds/layer_march.cpp have it. layer_tables.glsl comes before it. Places are offsets from the
// eye along x and z [m].
// Its levels one after the other, x fastest [m].
layout(binding = 12) uniform sampler2D thickness_values;
float thickness_value(int i) { return value_of(thickness_values, i); }

const float kFarthest = 1e8, kNever = 1e38;
const int kSteps = 48;

struct LayerRay {
    vec3 from;       // from the eye
    vec3 direction;  // unit
    float begin, end;
    float spread;  // of the pixel that it stands for [rad]
};

struct LayerMarch {
    float length, distance, thickness, level;
};

float thickness_texel(ivec2 at, ivec2 size, int first) {
#if REPEAT
    at += size * (ivec2(lessThan(at, ivec2(0))) - ivec2(greaterThanEqual(at, size)));
    return thickness_value(first + at.y * size.x + at.x);
#else
    bool is_within = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
    return is_within ? thickness_value(first + at.y * size.x + at.x) : 0.0;
#endif
}

float thickness_of_level(vec2 uv, int level) {
    ivec2 size = max(field_albedo.xy >> level, ivec2(1));
    int texels = level_first[level >> 2][level & 3];
    vec2 place = clamp(uv * vec2(size) - 0.5, vec2(-2.0), vec2(size + 2));
    vec2 first = floor(place), t = place - first;
    ivec2 i = ivec2(first);
    float a = thickness_texel(i, size, texels), b = thickness_texel(i + ivec2(1, 0), size, texels);
    float c = thickness_texel(i + ivec2(0, 1), size, texels), d = thickness_texel(i + 1, size, texels);
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

// Trilinear, written out: filters of GPUs round their weights to 1/256 of a step between texels, and
// Mesa's renderer in software fetches all four pixels of a quad from the level of one.
float thickness_at(vec2 place, float level) {
    vec2 uv = field_origin + place / field.xy;
#if REPEAT
    uv -= floor(uv);
#endif
    float at = clamp(level, 0.0, float(levels_counts.x));
    int first = int(at);
    float share = at - float(first), thickness = thickness_of_level(uv, first);
    return share > 0.0 ? mix(thickness, thickness_of_level(uv, first + 1), share) : thickness;
}

float field_level(float size) {
    return log2(max(size, 1e-30) / field.z);
}

// dH/dx and dH/dz
vec2 slope_at(vec2 place, float level) {
    float s = field.z * exp2(clamp(level, 0.0, float(levels_counts.x)));
    return vec2(thickness_at(place + vec2(s, 0.0), level) - thickness_at(place - vec2(s, 0.0), level),
                thickness_at(place + vec2(0.0, s), level) - thickness_at(place - vec2(0.0, s), level)) *
           (0.5 / s);
}

void cut_to(inout vec2 part, float position, float direction, float low, float high) {
    if (direction == 0.0) {
        if (position < low || position > high) part.y = part.x;
        return;
    }
    float a = (low - position) / direction, b = (high - position) / direction;
    part = vec2(max(part.x, min(a, b)), min(part.y, max(a, b)));
}

float log_of_one_more(float x) {
    return x > 0.01 ? log(1.0 + x) : x * (1.0 - x * (0.5 - x / 3.0));
}

float exp_minus_one(float x) {
    return x > 0.1 ? exp(x) - 1.0
                   : x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0))));
}

LayerMarch march_layer(LayerRay ray, float kappa) {
    LayerMarch none = LayerMarch(0.0, 0.0, 0.0, 0.0);
    vec3 d = ray.direction;
    float highest = field.w;
    vec2 part = vec2(ray.begin, min(ray.end, kFarthest));
    float above_base = eye_above_base + ray.from.y;
    cut_to(part, above_base, d.y, 0.0, highest);
#if !REPEAT
    vec2 origin = field_origin + ray.from.xz / field.xy;
    cut_to(part, origin.x, d.x / field.x, -0.125, 1.125);
    cut_to(part, origin.y, d.z / field.y, -0.125, 1.125);
#endif
    if (!(part.y > part.x) || !(highest > 0.0)) return none;
    // Where it comes in through base or top its height is exact, and so is the way from there to the
    // other: as a sum of far distances both would be off by their rounding.
    float entry = d.y < 0.0 ? highest : 0.0, exit = highest - entry;
    bool comes_in = part.x == (entry - above_base) / d.y, goes_out = part.y == (exit - above_base) / d.y;
    float first_height = comes_in ? entry : above_base + d.y * part.x;
    // Distances from part.x: (part.x + offset) growth, growth + 1 a power of the ratio.
    float offset = 0.5 * highest, start = part.x + offset;
    float whole = goes_out ? (exit - first_height) / d.y : part.y - part.x;
    float step_growth = exp_minus_one(log_of_one_more(whole / start) / float(kSteps));
    float level_scale = length(d.xz) * step_growth;
    float s = 0.0, growth = 0.0;
    float level = field_level(max(level_scale * start, ray.spread * part.x));
    float thickness = thickness_at(ray.from.xz + part.x * d.xz, level), below_top = thickness - first_height;
    float weights = 0.0;
    LayerMarch march = none;
    for (int i = 0; i < kSteps && kappa * march.length < 20.0; ++i) {
        growth += step_growth * (1.0 + growth);
        float next = i + 1 < kSteps ? start * growth : whole, t = part.x + next;
        float next_level = field_level(max(level_scale * (t + offset), ray.spread * t));
        float next_thickness = thickness_at(ray.from.xz + t * d.xz, next_level);
        float next_below = next_thickness - (first_height + d.y * next);
        if (below_top > 0.0 || next_below > 0.0) {
            float crossing = below_top / (below_top - next_below);
            float begin = below_top > 0.0 ? 0.0 : crossing, end = next_below > 0.0 ? 1.0 : crossing;
            float inside = (end - begin) * (next - s), middle = 0.5 * (begin + end);
            float weight = exp(-kappa * march.length) * taken_share(kappa * inside);
            march.length += max(inside, 0.0);
            weights += weight;
            march.thickness += weight * mix(thickness, next_thickness, middle);
            march.level += weight * mix(level, next_level, middle);
            march.distance += weight * mix(s, next, middle);
        }
        s = next;
        level = next_level;
        thickness = next_thickness;
        below_top = next_below;
    }
    if (!(weights > 0.0)) return none;
    return LayerMarch(march.length, part.x + march.distance / weights, march.thickness / weights,
                      march.level / weights);
}
