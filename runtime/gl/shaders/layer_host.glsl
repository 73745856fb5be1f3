// What hosts call, besides ground_distance. Places are offsets from the eye that was last set [m],
// distances in metres, directions unit; `spread`: of the pixel [rad], what lies within it is
// averaged. layer_see.glsl comes before it.

SeenLayer see(vec3 from, vec3 direction, float begin, float end, float spread) {
    return see_layer(LayerRay(from, direction, begin, end, spread), true);
}

// Radiance of the ground at the distance that ground_distance gives, under its clouds, in its haze.
vec3 ground_radiance(vec3 from, vec3 direction, float distance, float spread) {
    return see_ground_along(LayerRay(from, direction, 0.0, distance, spread), distance);
}
