// What hosts call. Places are offsets from the eye that was last set [m], distances in metres;
// volume_march.glsl and harmonics.glsl come before it.

// What the volumes scatter toward `from` and leave of what lies behind, along a unit direction.
Seen march_volumes(vec3 from, vec3 direction, float begin, float end) {
    float harmonic[HARMONICS];
    find_harmonics(-direction, harmonic);
    return march(Ray(from, direction, begin, end), harmonic);
}

// The integrands of that: extinction [1/m] and radiance per metre, scattered toward `to_eye`, unit,
// and sent out; all volumes added up. runtime/volumes/volume_sample.cpp.
struct Sample {
    vec3 extinction, scattered;
};

Sample sample_volumes(vec3 place, vec3 to_eye) {
    Sample found = Sample(vec3(0.0), vec3(0.0));
    float harmonic[HARMONICS];
    find_harmonics(to_eye, harmonic);
    for (uint left = kAllVolumes; left != 0u; left &= left - 1u) {
        int v = lowest_bit(left);
        // A ray that does not move.
        Traveller traveller = enter_table(volumes[v], Ray(place, vec3(0.0), 0.0, kNever));
        ivec3 extent = ivec3(volumes[v].extent_first.xyz), cell = ivec3(floor(traveller.origin));
        if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, extent))) continue;
        traveller.corner = vec3(cell);
        traveller.box = traveller.sun_box = kNone;
        traveller.brick = brick_at(volumes[v].extent_first.w +
                                   uint((cell.z * extent.y + cell.y) * extent.x + cell.x));
        if (traveller.brick == kNone) continue;
        vec3 at = clamp((traveller.origin - traveller.corner) * 8.0, 0.0, 8.0);
#if GLOW
        found.scattered += glow_at(volumes[v], glow_colors[v].rgb, traveller, at);
#endif
        float density = density_at(volumes[v], traveller, at);
        if (!(density > 0.0)) continue;
        vec3 c = tame_to(density * volumes[v].extinction.rgb, 1e15);
        found.extinction += c;
        found.scattered += c * volumes[v].albedo.rgb *
                           source_at(volumes[v], v, traveller, at, to_eye, vec3(1.0), harmonic);
    }
    return found;
}
