// A cell of the ground and of the layer's base above it (clouds/ground_cells.cpp), seen from the first corner
// of their grid. layer_see.glsl comes before it.
layout(location = 0) out vec4 emission;
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 albedo;
layout(location = 3) out vec4 reflectance;
uniform vec2 sample_step;  // a quarter of a cell [m]
uniform int sample_count;  // 16; a number that compilers do not know keeps the loop short
uniform int mean_first;    // of T of even light, by band and depth, among the tables
uniform int has_radiosity;

float mean_transmittance(int band, float depth) {
    Place row = place_depth(depth, counts.y);
    int i = mean_first + band * counts.y + row.first;
    return clamp(mix(value_of(table_values, i), value_of(table_values, i + 1), row.share), 0.0, 1.0);
}

// T_ms - T_0 - T_1 of a sun's flux.
float scattered_share(int sun, int band, float depth) {
    Place row = place_depth(depth, counts.y);
    int i = (sun * counts.y + row.first) * 3 + band;
    vec2 flux = clamp(mix(sun_flux_at(i), sun_flux_at(i + 3), row.share), 0.0, 1.0);
    float x = depth / suns[sun].direction_cosine.w;
    float across = clamp(flux.x - exp(-x), 0.0, taken_share(x));
    return across - min(flux.y, across);
}

void main() {
    float footprint = max(sample_step.x, sample_step.y);
    vec3 send = vec3(0.0), straight = vec3(0.0), ground = vec3(0.0), reflected = vec3(0.0);
    for (int s = 0; s < sample_count; ++s) {
        vec2 place = (4.0 * floor(gl_FragCoord.xy) + vec2(s & 3, s >> 2) + 0.5) * sample_step;
        vec3 depth = thickness_at(place, field_level(footprint)) * rest_kappa_peak.rgb, mean;
        for (int b = 0; b < 3; ++b) mean[b] = mean_transmittance(b, depth[b]);
        send += mean * sky_irradiance.rgb;
        reflected += 1.0 - mean;
        ground += albedo_at(place, footprint);
        for (int i = 0; i < radiance_counts.z; ++i) {
            vec4 shadow = suns[i].shadow;
            vec3 flux = suns[i].direction_cosine.y * suns[i].irradiance_radius.rgb, scattered;
            for (int b = 0; b < 3; ++b) scattered[b] = scattered_share(i, b, depth[b]);
            float above = thickness_at(place + shadow.xy, field_level(max(shadow.z, footprint)));
            send += flux * scattered;
            straight += flux * kept_share(i, above * rest_kappa_peak.rgb);
        }
    }
    float share = 1.0 / float(sample_count);
    emission = vec4(share * send, 1.0);
    direct = vec4(share * straight, 1.0);
    albedo = vec4(has_radiosity != 0 ? share * ground : vec3(0.0), 1.0);
    reflectance = vec4(share * reflected, 1.0);
}
