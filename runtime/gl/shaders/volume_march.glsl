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
    uvec4 coefficient;  // the first of its nodes; suns; the first entry of its tables; terms of a sun
};
// Density: of each brick the scale, then 8 x 9 x 9 pairs of codes: of a voxel and of the next along x.
// Coefficients: R, G, B; relight_volumes.h. Phases: sun_phase.h, phase_table.h.
// Arrays stand in textures of 2048 columns. RECORDS_IN_BLOCK: the volumes in a uniform block.
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
uniform vec3 suns[SUNS];
#if GLOW
uniform vec4 glow_colors[VOLUMES];
#endif
#endif
layout(binding = 4) uniform usampler2D brick_numbers;
layout(binding = 5) uniform usampler2D density_codes;
layout(binding = 6) uniform usampler2D corner_numbers;
layout(binding = 7) uniform sampler2D node_light;
layout(binding = 8) uniform sampler2D phase_entries;
#if GLOW
layout(binding = 9) uniform usampler2D glow_words;
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
#if VOLUMES == 1
int lowest_bit(uint bits) { return 0; }  // known to compilers, which then keep arrays in registers
#else
int lowest_bit(uint bits) {
    int bit = 0;
    while (bit < VOLUMES && (bits >> bit & 1u) == 0u) ++bit;
    return bit;
}
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
    uint box, sun_box;  // whose source radiance stands in node_source
};

// Of each volume the source radiance at the eight nodes of the last box, in the order x + 2 y + 4 z, then
// at the eight points of suns' last box, of each of their terms, which count by what a ray has left.
const int kSunTerms = 3;  // kMaxSunTerms of sun_phase.h
const int kSources = 8 + 8 * kSunTerms;
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
    traveller.box = traveller.sun_box = kNone;
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

// Sets node_source for a box of volume v's brick.
void light_box(Volume volume, int v, uint brick, uvec3 box, float harmonic[HARMONICS]) {
    uint side = volume.numbers.z + 1u, terms = volume.numbers.w;
    uint first = volume.numbers.y + brick * side * side * side + (box.z * side + box.y) * side + box.x;
    for (int i = 0; i < 8; ++i) {
        uint at = uint(i), node = node_at(first + ((at >> 2) * side + (at >> 1 & 1u)) * side + (at & 1u));
        vec3 sum = vec3(0.0);
        for (uint k = 0u; k < terms && node != kNone; ++k) {
            sum += harmonic[k] * coefficient_at(volume.coefficient.x + 3u * (node * terms + k));
        }
        node_source[kSources * v + i] = sum;
    }
}

// Boxes between points of suns along a brick's edge, runtime/volumes/volume_lattice.h.
uint sun_boxes(Volume volume) { return min(2u * volume.numbers.z, 8u); }

// Sets a term of node_source, from `first`, at eight points of suns whose coefficients begin at `at`.
void light_term(Volume volume, int first, uint at[8], uint term, vec3 to_eye) {
    uint count = volume.coefficient.y;
    for (int i = 0; i < 8; ++i) node_source[first + i] = vec3(0.0);
    for (uint sun = 0u; sun < count; ++sun) {
        float weight = eval_phase(volume, term, sun, to_eye);
        for (int i = 0; i < 8; ++i) {
            node_source[first + i] += weight * coefficient_at(at[i] + 3u * (term * count + sun));
        }
    }
}

// Sets all terms for a box of volume v's brick.
void light_suns(Volume volume, int v, uint brick, uvec3 box, vec3 to_eye) {
    uint side = sun_boxes(volume) + 1u, stride = volume.coefficient.y * volume.coefficient.w, at[8];
    // Bricks stand before what suns send, the first one last.
    uint first = volume.coefficient.x - 3u * (volume.coefficient.y + (brick + 1u) * side * side * side * stride);
    for (uint i = 0u; i < 8u; ++i) {
        uvec3 p = box + uvec3(i & 1u, i >> 1 & 1u, i >> 2);
        at[i] = first + 3u * stride * ((p.z * side + p.y) * side + p.x);
    }
#if VOLUMES == 1  // no loop: compilers know all places then, and keep node_source in registers
    light_term(volume, 8, at, 0u, to_eye);
    if (volume.coefficient.w > 1u) {
        light_term(volume, 16, at, 1u, to_eye);
        light_term(volume, 24, at, 2u, to_eye);
    }
#else
    for (uint term = 0u; term < volume.coefficient.w; ++term) {
        light_term(volume, kSources * v + 8 + 8 * int(term), at, term, to_eye);
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

// A point of a brick between its `boxes` along each edge: the box, and in it, in [0, 1].
uvec3 box_at(vec3 at, uint boxes, out vec3 within) {
    vec3 scaled = at * (float(boxes) / 8.0), base = min(floor(scaled), float(boxes) - 1.0);
    within = scaled - base;
    return uvec3(base);
}

// What suns add to J; `left` of it comes through to the eye.
vec3 suns_at(Volume volume, int v, inout Traveller traveller, vec3 at, vec3 to_eye, vec3 left) {
    vec3 w;
    uint boxes = sun_boxes(volume);
    uvec3 b = box_at(at, boxes, w);
    uint box = (b.z * boxes + b.y) * boxes + b.x;
    if (traveller.sun_box != box) {
        traveller.sun_box = box;
        light_suns(volume, v, traveller.brick, b, to_eye);
    }
#if VOLUMES == 1
    vec3 sum = mix_nodes(8, w);
    if (volume.coefficient.w > 1u) {
        sum += sun_through(volume, 1u, left) * mix_nodes(16, w);
        sum += sun_through(volume, 2u, left) * mix_nodes(24, w);
    }
#else
    vec3 sum = vec3(0.0);
    for (uint term = 0u; term < volume.coefficient.w; ++term) {
        sum += sun_through(volume, term, left) * mix_nodes(kSources * v + 8 + 8 * int(term), w);
    }
#endif
    return sum;
}

// max(0, J), trilinear between nodes.
vec3 source_at(Volume volume, int v, inout Traveller traveller, vec3 at, vec3 to_eye, vec3 left,
               float harmonic[HARMONICS]) {
    vec3 w;
    uvec3 b = box_at(at, volume.numbers.z, w);
    uint box = (b.z * volume.numbers.z + b.y) * volume.numbers.z + b.x;
    if (traveller.box != box) {
        traveller.box = box;
        light_box(volume, v, traveller.brick, b, harmonic);
    }
    vec3 sum = mix_nodes(kSources * v, w);
    if (volume.coefficient.y > 0u) sum += suns_at(volume, v, traveller, at, to_eye, left);
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
                   float voxel, vec3 to_eye, float harmonic[HARMONICS], inout Seen seen) {
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
            emitted += glow_at(volumes[v], glow_colors[v].rgb, travellers[v], at);
#endif
            float density = density_at(volumes[v], travellers[v], at);
            if (!(density > 0.0)) continue;
            vec3 c = tame_to(density * volumes[v].extinction.rgb, 1e15);
            extinction += c;
            scattered += c * volumes[v].albedo.rgb *
                         source_at(volumes[v], v, travellers[v], at, to_eye, seen.transmittance, harmonic);
        }
        step_ray(extinction, scattered, emitted, h, seen);
    }
}

// What volumes add to a ray and what they leave of the light behind.
Seen march(Ray ray, float harmonic[HARMONICS]) {
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
        march_segment(travellers, inside, begin, end, voxel, -ray.direction, harmonic, seen);
        if (is_opaque(seen)) break;
        t = end;
        for (uint left = inside; left != 0u; left &= left - 1u) {
            int v = lowest_bit(left);
            if (travellers[v].span_end > t) continue;
            advance(volumes[v], travellers[v]);
            remaining &= travellers[v].brick == kNone ? ~(1u << v) : kAllVolumes;
        }
    }
    if (is_opaque(seen)) seen.transmittance = vec3(0.0);
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
