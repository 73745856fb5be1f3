// Radiance of the environment along the sample's ray. environment.glsl comes before it.
layout(location = 0) out vec4 color;

layout(location = 0) uniform vec2 tile_origin;  // [samples] of the picture
layout(location = 1) uniform vec2 to_plane;     // samples to [0, 2] over the picture
layout(location = 2) uniform vec3 right;        // times the half width of the image plane
layout(location = 3) uniform vec3 down;         // times the half height
layout(location = 4) uniform vec3 forward;

void main() {
    vec2 plane = (tile_origin + gl_FragCoord.xy) * to_plane - 1.0;
    vec3 d = light_from_world * normalize(plane.x * right + plane.y * down + forward);
    vec3 radiance = sample_map(d);
    for (int i = 0; i < discs; ++i) {
        if (is_in_disc(i, d)) radiance += disc_at(i).radiance.rgb;
    }
    color = vec4(tame(radiance.r), tame(radiance.g), tame(radiance.b), 1.0);
}
