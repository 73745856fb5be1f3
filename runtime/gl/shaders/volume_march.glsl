// The integral along a ray through all volumes, the same steps as runtime/volumes/volume_march.cpp.
// Specialised by VOLUMES, their number, HARMONICS, the most terms that a node may have, and GLOW: 1 where
// one of them has light of its own, else 0.
// Distances are in units of the scene (view_unit), positions in bricks from a table's lowest corner.

struct Volume {
    vec4 to_bricks[3];   // rows: direction to bricks a unit; w: the eye's place
    uvec4 extent_first;  // bricks along each axis of the table; its first cell
    uvec4 numbers;       // first brick, first corner, boxes of nodes along a brick's edge, terms
    vec4 extinction;     // where the density is 1 [1 / unit]; w: power of the second term of suns
    vec4 albedo;         // w: of the third
    uvec4 coefficient;  // the first; suns; the first entry of its tables; terms of a sun
};
// Density: of each brick the scale, then 8 x 9 x 9 pairs of codes: of a voxel and of the next along x.
// Coefficients: R, G, B; of suns those of all suns for each term; before the first, what each sun sends. Phases: sun_phase.h, phase_table.h.
#ifdef DATA_IN_TEXTURES  // of 2048 columns
#ifdef RECORDS_IN_BLOCK
layout(std140) uniform VolumeRecords {
    Volume volumes[VOLUMES];
    vec3 suns[SUNS];  // directions toward them
#if GLOW
    vec4 glow_colors[VOLUMES];  // of their own light, times the scale of codes [1 / unit]
#endif
};
#else
uniform Volume volumes[VOLUMES];
#endif
uniform usampler2D brick_numbers, density_codes, corner_numbers;
uniform sampler2D node_light, phase_entries;
#if GLOW
uniform usampler2D glow_words;
#endif
ivec2 place_of(uint i) { return ivec2(i & 2047u, i >> 11); }
uint brick_at(uint cell) { return texelFetch(brick_numbers, place_of(cell), 0).r; }
uint density_word(uint i) { return texelFetch(density_codes, place_of(i), 0).r; }
uint node_at(uint corner) { return texelFetch(corner_numbers, place_of(corner), 0).r; }
vec3 coefficient_at(uint i) { return texelFetch(node_light, place_of(i / 3u), 0).rgb; }
float phase_at(uint i) { return texelFetch(phase_entries, place_of(i), 0).r; }
#if GLOW
uint glow_word(uint i) { return texelFetch(glow_words, place_of(i), 0).r; }
#endif
#else
layout(std430, binding = 0) readonly buffer Volumes { Volume volumes[]; };
layout(std430, binding = 1) readonly buffer Table { uint brick_table[]; };
layout(std430, binding = 2) readonly buffer Density { uint density_words[]; };
layout(std430, binding = 3) readonly buffer Corners { uint corner_nodes[]; };
layout(std430, binding = 4) readonly buffer Coefficients { float coefficients[]; };
layout(std430, binding = 5) readonly buffer Phases { float phase[]; };
uint brick_at(uint cell) { return brick_table[cell]; }
uint density_word(uint i) { return density_words[i]; }
uint node_at(uint corner) { return corner_nodes[corner]; }
vec3 coefficient_at(uint i) { return vec3(coefficients[i], coefficients[i + 1u], coefficients[i + 2u]); }
float phase_at(uint i) { return phase[i]; }
#if GLOW
layout(std430, binding = 6) readonly buffer Glow { uint glow_codes[]; };
uint glow_word(uint i) { return glow_codes[i]; }
#endif
#endif
#if VOLUMES == 1
int lowest_bit(uint bits) { return 0; }  // known to compilers, which then keep arrays in registers
#elif defined(DATA_IN_TEXTURES)
int lowest_bit(uint bits) {
    int bit = 0;
    while (bit < VOLUMES && (bits >> bit & 1u) == 0u) ++bit;
    return bit;
}
#else
int lowest_bit(uint bits) { return findLSB(bits); }
#endif
#ifndef RECORDS_IN_BLOCK
layout(location = 7) uniform vec3 suns[SUNS];  // as in the block
#if GLOW
layout(location = 17) uniform vec4 glow_colors[VOLUMES];
#endif
#endif

const uint kNone = 0xffffffffu;  // no brick, no node
const float kNever = 1e30;       // a distance
const float kStep = 0.5;         // as MarchOptions
const float kLeastTransmittance = 1e-3;

// Sets of volumes have a bit for each: what a ray does not meet costs it nothing, and no driver
// unrolls a loop over bits, which would take it many seconds.
const uint kAllVolumes = (2u << (VOLUMES - 1)) - 1u;

struct Ray {
    vec3 from;       // from the eye
    vec3 direction;  // unit
    float begin, end;
};

// A volume on the ray's way, with the brick where it is or comes to next.
struct Traveller {
    vec3 origin, direction;  // in bricks
    ivec3 cell;              // to be visited next
    float t, end;            // what is left of the table
    float voxel;
    vec3 corner;  // of the brick
    float span_begin, span_end;
    uint brick;  // kNone behind the last one
    uint box;    // of the nodes whose radiance stands in node_source
    float column;  // density times way
};

// Of each volume the source radiance at the eight nodes of the last box, in the order x + 2 y + 4 z:
// of harmonics and the suns' first term, then of each further term, which counts by what a ray has left.
const int kSunTerms = 3;  // kMaxSunTerms of sun_phase.h
const int kSources = 8 * kSunTerms;
vec3 node_source[VOLUMES * kSources];

struct Seen {
    vec3 radiance, transmittance;
};

// NaN fails the comparison and becomes 0.
vec3 tame_to(vec3 value, float largest) {
    return mix(vec3(0.0), min(value, largest), greaterThan(value, vec3(0.0)));
}

// Distances at which the ray meets planes across each axis; `else_at` where it runs along them.
vec3 meet(Traveller traveller, vec3 planes, vec3 else_at) {
    bvec3 stands = equal(traveller.direction, vec3(0.0));
    vec3 d = mix(traveller.direction, vec3(1.0), stands);
    return mix((planes - traveller.origin) / d, else_at, stands);
}

// The ray cut to the table: nothing is left of it if t >= end.
Traveller enter_table(Volume volume, Ray ray) {
    Traveller traveller;
    for (int a = 0; a < 3; ++a) {
        traveller.origin[a] = volume.to_bricks[a].w + dot(volume.to_bricks[a].xyz, ray.from);
        traveller.direction[a] = dot(volume.to_bricks[a].xyz, ray.direction);
    }
    vec3 extent = vec3(volume.extent_first.xyz), o = traveller.origin;
    bvec3 outside = bvec3(uvec3(lessThan(o, vec3(0.0))) | uvec3(greaterThan(o, extent)));
    vec3 low = meet(traveller, vec3(0.0), mix(vec3(-kNever), vec3(kNever), outside));
    vec3 high = meet(traveller, extent, vec3(kNever));
    vec3 near = min(low, high), far = max(low, high);
    traveller.t = max(max(ray.begin, near.x), max(near.y, near.z));
    traveller.end = min(min(ray.end, far.x), min(far.y, far.z));
    vec3 at = o + traveller.t * traveller.direction;
    traveller.cell = ivec3(clamp(floor(at), vec3(0.0), max(extent - 1.0, 0.0)));
    traveller.voxel = 1.0 / max(8.0 * length(traveller.direction), 1e-30);
    traveller.brick = kNone;
    traveller.column = 0.0;
    return traveller;
}

// On to the next brick that exists.
void advance(Volume volume, inout Traveller traveller) {
    ivec3 extent = ivec3(volume.extent_first.xyz);
    vec3 upper = vec3(greaterThan(traveller.direction, vec3(0.0)));
    ivec3 turn = ivec3(sign(traveller.direction));
    traveller.brick = kNone;
    while (traveller.t < traveller.end && traveller.brick == kNone) {
        vec3 faces = meet(traveller, vec3(traveller.cell) + upper, vec3(kNever));
        float leaves = min(faces.x, min(faces.y, faces.z));
        traveller.span_begin = traveller.t;
        traveller.span_end = min(leaves, traveller.end);
        traveller.t = max(traveller.t, traveller.span_end);
        if (traveller.span_begin < traveller.span_end) {
            ivec3 c = traveller.cell;
            traveller.corner = vec3(c);
            traveller.brick = brick_at(volume.extent_first.w +
                                       uint((c.z * extent.y + c.y) * extent.x + c.x));
        }
        traveller.cell += turn * (leaves == faces.x   ? ivec3(1, 0, 0)
                                  : leaves == faces.y ? ivec3(0, 1, 0)
                                                      : ivec3(0, 0, 1));
        if (any(lessThan(traveller.cell, ivec3(0))) ||
            any(greaterThanEqual(traveller.cell, extent))) {
            traveller.end = traveller.t;
        }
    }
    traveller.box = kNone;
}

// Codes of a voxel and the next along x, mixed; in 1 / 65535.
float mix_pair(uint word, float weight) {
    vec2 pair = unpackUnorm2x16(density_word(word));
    return mix(pair.x, pair.y, weight);
}

// `at`: voxels from the brick's voxel (0, 0, 0), in [0, 8].
float density_at(Volume volume, Traveller traveller, vec3 at) {
    vec3 base = min(floor(at), 7.0), w = at - base;
    uvec3 b = uvec3(base);
    uint first = (volume.numbers.x + traveller.brick) * uint(BRICK_WORDS);
    uint word = first + 1u + (b.z * 9u + b.y) * 8u + b.x;
    float low = mix(mix_pair(word, w.x), mix_pair(word + 8u, w.x), w.y);
    float high = mix(mix_pair(word + 72u, w.x), mix_pair(word + 80u, w.x), w.y);
    return uintBitsToFloat(density_word(first)) * mix(low, high, w.z);
}

// A table between the light of a sun and the eye, formats/opal/phase_table.h.
float eval_phase(Volume volume, uint term, uint sun, vec3 to_eye) {
    float cosine = -dot(suns[sun], to_eye);
    float end = 128.0 * sqrt(max(1.0 - abs(cosine), 0.0));
    float at = cosine < 0.0 ? end : 256.0 - end, base = min(floor(at), 255.0);
    uint i = volume.coefficient.z + 257u * term + uint(base);
    return mix(phase_at(i), phase_at(i + 1u), at - base);
}

// What counts of a term of suns behind what comes through to the eye, runtime/volumes/sun_phase.h.
vec3 sun_through(Volume volume, uint term, vec3 left) {
    if (term == 0u) return vec3(1.0);
    float power = term == 1u ? volume.extinction.w : volume.albedo.w;
    return pow(clamp(left, 1e-30, 1.0), power * volume.albedo.rgb);
}

// The share of a sun's light that counts as coming along the ray, runtime/volumes/volume_source.h.
float ahead_share(vec3 sun, vec3 to_eye) {
    vec3 off = sun + to_eye;
    float u = min(dot(off, off) / 0.0437048, 1.0);
    return (1.0 - u * u) * (1.0 - u * u);
}

// Adds coefficient k of eight nodes to what begins at `first` of node_source.
void add_nodes(int first, uint at[8], uint k, float weight) {
    for (int i = 0; i < 8; ++i) {
        if (at[i] != kNone) node_source[first + i] += weight * coefficient_at(at[i] + 3u * k);
    }
}

// Sets a term of node_source, from `first`; coefficients of eight nodes begin at `at`. `ahead`: of
// suns ahead alone.
void light_term(Volume volume, int first, uint at[8], uint term, vec3 to_eye, float harmonic[HARMONICS],
                bool ahead) {
    for (int i = 0; i < 8; ++i) node_source[first + i] = vec3(0.0);
    uint terms = volume.numbers.w, sun_count = volume.coefficient.y;
    if (term == 0u && !ahead) {
        for (uint k = 0u; k < terms; ++k) add_nodes(first, at, k, harmonic[k]);
    }
    for (uint sun = 0u; sun < sun_count; ++sun) {
        float share = ahead ? ahead_share(suns[sun], to_eye) : 1.0;
        add_nodes(first, at, terms + term * sun_count + sun, share * eval_phase(volume, term, sun, to_eye));
    }
}

// Sets node_source for a box of volume v's brick.
void light_box(Volume volume, int v, uint brick, uvec3 box, vec3 to_eye, float harmonic[HARMONICS],
               bool ahead) {
    uint side = volume.numbers.z + 1u;
    uint first = volume.numbers.y + brick * side * side * side + (box.z * side + box.y) * side + box.x;
    uint stride = volume.numbers.w + volume.coefficient.y * volume.coefficient.w, at[8];
    for (uint i = 0u; i < 8u; ++i) {
        uint node = node_at(first + ((i >> 2) * side + (i >> 1 & 1u)) * side + (i & 1u));
        at[i] = node == kNone ? kNone : volume.coefficient.x + node * stride * 3u;
    }
#if VOLUMES == 1  // no loop: compilers know all places then, and keep node_source in registers
    light_term(volume, 0, at, 0u, to_eye, harmonic, ahead);
    if (volume.coefficient.w > 1u) {
        light_term(volume, 8, at, 1u, to_eye, harmonic, ahead);
        light_term(volume, 16, at, 2u, to_eye, harmonic, ahead);
    }
#else
    for (uint term = 0u; term < volume.coefficient.w; ++term) {
        light_term(volume, v * kSources + 8 * int(term), at, term, to_eye, harmonic, ahead);
    }
#endif
}

vec3 mix_nodes(int first, vec3 w) {
    vec3 low = mix(mix(node_source[first], node_source[first + 1], w.x),
                   mix(node_source[first + 2], node_source[first + 3], w.x), w.y);
    vec3 high = mix(mix(node_source[first + 4], node_source[first + 5], w.x),
                    mix(node_source[first + 6], node_source[first + 7], w.x), w.y);
    return mix(low, high, w.z);
}

// max(0, J), trilinear between nodes; `left` of it comes through to the eye.
vec3 source_at(Volume volume, int v, inout Traveller traveller, vec3 at, vec3 to_eye, vec3 left,
               float harmonic[HARMONICS], bool ahead) {
    float boxes = float(volume.numbers.z);
    vec3 scaled = at * (boxes / 8.0), base = min(floor(scaled), boxes - 1.0), w = scaled - base;
    uvec3 b = uvec3(base);
    uint box = (b.z * volume.numbers.z + b.y) * volume.numbers.z + b.x;
    if (traveller.box != box) {
        traveller.box = box;
        light_box(volume, v, traveller.brick, b, to_eye, harmonic, ahead);
    }
#if VOLUMES == 1
    vec3 sum = mix_nodes(0, w);
    if (volume.coefficient.w > 1u) {
        sum += sun_through(volume, 1u, left) * mix_nodes(8, w);
        sum += sun_through(volume, 2u, left) * mix_nodes(16, w);
    }
#else
    vec3 sum = vec3(0.0);
    for (uint term = 0u; term < volume.coefficient.w; ++term) {
        sum += sun_through(volume, term, left) * mix_nodes(v * kSources + 8 * int(term), w);
    }
#endif
    return tame_to(sum, 1e20);
}

#if GLOW
// Own light: for each brick the first of its words, or kNone; then 9 x 9 x 9 codes a brick,
// formats/opal/shared_exponent.h.
vec3 glow_code(uint i) {
    uint code = glow_word(i);
    return vec3(code & 511u, code >> 9 & 511u, code >> 18 & 511u) * exp2(float(code >> 27) - 24.0);
}

// Radiance per unit at a point of the brick, `at` as density_at's; `color` of glow_colors.
vec3 glow_at(Volume volume, vec3 color, Traveller traveller, vec3 at) {
    uint first = glow_word(volume.numbers.x + traveller.brick);
    if (first == kNone) return vec3(0.0);
    vec3 base = min(floor(at), 7.0), w = at - base;
    uvec3 b = uvec3(base);
    uint i = first + (b.z * 9u + b.y) * 9u + b.x;
    vec3 sum = vec3(0.0);
    for (uint z = 0u; z < 2u; ++z, i += 81u) {
        vec3 low = mix(glow_code(i), glow_code(i + 1u), w.x);
        vec3 high = mix(glow_code(i + 9u), glow_code(i + 10u), w.x);
        sum += (z == 0u ? 1.0 - w.z : w.z) * mix(low, high, w.y);
    }
    return tame_to(color * sum, 1e20);
}

// The way [units] over which light of a step comes through.
vec3 way_through(vec3 c, float h, vec3 absorbed) {
    return mix(vec3(h), absorbed / max(c, 1e-36), greaterThan(c * h, vec3(1e-6)));
}
#endif

// 1 - exp(-x): where that would cancel, its Taylor series, whose first left-out term is below
// 6e-8 x.
vec3 absorbed_over(vec3 x) {
    vec3 series = x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0)));
    return mix(series, 1.0 - exp(-x), greaterThan(x, vec3(0.05)));
}

void step_ray(vec3 c, vec3 b, vec3 e, float h, inout Seen seen) {
    vec3 absorbed = absorbed_over(min(c * h, 1e4));
#if GLOW
    seen.radiance += seen.transmittance * e * way_through(c, h, absorbed);
#endif
    seen.radiance += seen.transmittance * (b / max(c, 1e-36)) * absorbed;
    seen.transmittance *= 1.0 - absorbed;
}

bool is_opaque(Seen seen) {
    vec3 t = seen.transmittance;
    return max(t.r, max(t.g, t.b)) < kLeastTransmittance;
}

// From begin to end lies no face of a brick: the volumes `inside` all along.
void march_segment(inout Traveller travellers[VOLUMES], uint inside, float begin, float end,
                   float voxel, vec3 to_eye, float harmonic[HARMONICS], bool ahead,
                   inout Seen seen) {
    float count = clamp(ceil((end - begin) / (kStep * voxel)), 1.0, ceil(14.0 / kStep));
    float h = (end - begin) / count;
    for (float i = 0.0; i < count && !is_opaque(seen); ++i) {
        float t = begin + (i + 0.5) * h;
        vec3 extinction = vec3(0.0), scattered = vec3(0.0), emitted = vec3(0.0);
        for (uint left = inside; left != 0u; left &= left - 1u) {
            int v = lowest_bit(left);
            vec3 place = travellers[v].origin + t * travellers[v].direction;
            vec3 at = clamp((place - travellers[v].corner) * 8.0, 0.0, 8.0);
#if GLOW
            if (!ahead) emitted += glow_at(volumes[v], glow_colors[v].rgb, travellers[v], at);
#endif
            float density = density_at(volumes[v], travellers[v], at);
            if (!(density > 0.0)) continue;
            travellers[v].column += density * h;
            vec3 c = tame_to(density * volumes[v].extinction.rgb, 1e15);
            extinction += c;
            scattered += c * volumes[v].albedo.rgb *
                         source_at(volumes[v], v, travellers[v], at, to_eye, seen.transmittance, harmonic, ahead);
        }
        step_ray(extinction, scattered, emitted, h, seen);
    }
}

// The most that suns ahead can show, runtime/volumes/volume_march.cpp.
vec3 most_ahead(Traveller travellers[VOLUMES], vec3 to_eye, vec3 left) {
    vec3 most = vec3(0.0);
    for (uint bits = kAllVolumes; bits != 0u; bits &= bits - 1u) {
        int v = lowest_bit(bits);
        uint count = volumes[v].coefficient.y;
        vec3 sum = vec3(0.0);
        for (uint k = 0u; k < count * volumes[v].coefficient.w; ++k) {
            uint term = k / count, sun = k % count;
            sum += ahead_share(suns[sun], to_eye) * eval_phase(volumes[v], term, sun, to_eye) *
                   sun_through(volumes[v], term, left) *
                   coefficient_at(volumes[v].coefficient.x - 3u * (count - sun));
        }
        vec3 depth = tame_to(travellers[v].column * volumes[v].extinction.rgb, 1e15);
        most += tame_to(depth * volumes[v].albedo.rgb * left * sum, 1e20);
    }
    return most;
}

bool has_sun_ahead(vec3 to_eye) {
    for (int s = 0; s < SUNS; ++s) {
        if (ahead_share(suns[s], to_eye) > 0.0) return true;
    }
    return false;
}

// The radiance of suns ahead beyond the most they can show, or all.
Seen march_part(Ray ray, float harmonic[HARMONICS], bool ahead) {
    Seen seen = Seen(vec3(0.0), vec3(1.0));
    Traveller travellers[VOLUMES];
    uint remaining = 0u;  // those with a brick at t or further on
    for (uint left = kAllVolumes; left != 0u; left &= left - 1u) {
        int v = lowest_bit(left);
        travellers[v] = enter_table(volumes[v], ray);
        advance(volumes[v], travellers[v]);
        remaining |= travellers[v].brick != kNone ? 1u << v : 0u;
    }
    for (float t = -kNever; remaining != 0u;) {
        // The next stretch with at least one brick, up to where one of them ends or another begins.
        float begin = kNever, end = kNever, voxel = kNever;
        for (uint left = remaining; left != 0u; left &= left - 1u) {
            begin = min(begin, max(t, travellers[lowest_bit(left)].span_begin));
        }
        uint inside = 0u;
        for (uint left = remaining; left != 0u; left &= left - 1u) {
            int v = lowest_bit(left);
            bool is_inside = travellers[v].span_begin <= begin;
            inside |= is_inside ? 1u << v : 0u;
            end = min(end, is_inside ? travellers[v].span_end : travellers[v].span_begin);
            voxel = is_inside ? min(voxel, travellers[v].voxel) : voxel;
        }
        march_segment(travellers, inside, begin, end, voxel, -ray.direction, harmonic, ahead, seen);
        if (is_opaque(seen)) break;
        t = end;
        for (uint left = inside; left != 0u; left &= left - 1u) {
            int v = lowest_bit(left);
            if (travellers[v].span_end > t) continue;
            advance(volumes[v], travellers[v]);
            remaining &= travellers[v].brick == kNone ? ~(1u << v) : kAllVolumes;
        }
    }
    if (ahead) {
        seen.radiance = max(seen.radiance - most_ahead(travellers, -ray.direction, seen.transmittance), 0.0);
    }
    if (is_opaque(seen)) seen.transmittance = vec3(0.0);
    return seen;
}

// What volumes add to a ray and what they leave of the light behind.
Seen march(Ray ray, float harmonic[HARMONICS]) {
    Seen seen;
    for (int part = 0; part < 2; ++part) {  // a loop: drivers inline a march for each call
        Seen found = march_part(ray, harmonic, part == 1);
        if (part == 0) {
            seen = found;
            if (!has_sun_ahead(-ray.direction)) break;
        } else {
            seen.radiance = max(seen.radiance - found.radiance, 0.0);
        }
    }
    return seen;
}

// Where the ray enters the first table and where it leaves the last one; its end and its beginning
// if it meets none.
vec2 volumes_span(Ray ray) {
    vec2 span = vec2(ray.end, ray.begin);
    for (uint left = kAllVolumes; left != 0u; left &= left - 1u) {
        Traveller traveller = enter_table(volumes[lowest_bit(left)], ray);
        if (traveller.t < traveller.end) {
            span = vec2(min(span.x, traveller.t), max(span.y, traveller.end));
        }
    }
    return span;
}
