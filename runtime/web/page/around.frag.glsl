// What lights a small body at the eye, above, beneath or in a cloud layer (clouds/environment_at.cpp): a
// cube map, its faces one above the other, of what is seen but suns. Its last row has the shares that the
// layer leaves of its suns, then of the sky's discs. environment.glsl and layer_see.glsl come before it.
layout(location = 0) out vec4 color;
uniform int side;  // texels of a face

// Without the layer's own sun in the map.
vec3 sky_rest(vec3 world) {
    vec3 rest = sample_map(light_from_world * world);
    float luminance = dot(rest, vec3(0.2126, 0.7152, 0.0722));
    bool is_sun = luminance > horizon_luminance.a && dot(world, map_peak.xyz) > map_peak.w;
    return is_sun ? horizon_luminance.a / luminance * rest : rest;
}

// Of texels, counted from the face's corner.
vec3 direction_at(int face, vec2 at) {
    return normalize(opaline_cube_position(face, 2.0 * at / float(side) - 1.0));
}

// The layer's suns, then the sky's discs: direction, width.
vec4 disc_ray(int i) {
    if (i < radiance_counts.z) return vec4(suns[i].direction_cosine.xyz, 2.0 * suns[i].irradiance_radius.a);
    vec4 disc = disc_at(i - radiance_counts.z).direction_chord;
    return vec4(normalize(disc.xyz * light_from_world), 2.0 * disc.w);
}

// One look at the layer, in no loop: drivers would take a minute to compile it.
void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    int face = here.y / side;
    vec2 texel = vec2(here.x, here.y % side);
    bool is_disc = face == 6;
    vec4 wanted = vec4(0.0, 1.0, 0.0, 0.0);  // direction, width of the ray
    vec3 behind = vec3(0.0);
    if (!is_disc) {
        wanted = vec4(direction_at(face, texel + 0.5), 0.5 * kPi / float(side));
        for (int i = 0; i < 4; ++i) {
            behind += 0.25 * sky_rest(direction_at(face, texel + 0.25 + 0.5 * vec2(i & 1, i >> 1)));
        }
    } else if (here.x < radiance_counts.z + discs) {
        wanted = disc_ray(here.x);
    }
    LayerRay ray = LayerRay(vec3(0.0), wanted.xyz, 0.0, kNever, wanted.w);
    float ground = ground_distance(ray.from, ray.direction);
    bool to_sky = !(ground < kFarthest);
    if (!to_sky) {
        ray.end = ground;
        behind = see_ground_along(ray, ground);
    }
    SeenLayer seen = see_layer(ray, to_sky);
    vec3 sum = seen.radiance + seen.glow + seen.transmittance * behind;
    if (is_disc) sum = here.x < radiance_counts.z ? seen.sun_transmittance : seen.transmittance;
    color = vec4(tame(sum.r), tame(sum.g), tame(sum.b), 1.0);
}
