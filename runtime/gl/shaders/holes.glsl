// As runtime/surface.cpp: which samples see a surface that light passes in places. covers.glsl comes
// before it. HOLE_IMAGE: alpha has an image (image.glsl comes before this). HOLE_VERTICES: vertices
// have alpha. CLEAR_HOLE: light passes it as glass (HAS_VIEW).
flat layout(location = 6) in uint v_last_vertex;
layout(location = 21) uniform vec3 hole;  // alpha, cutoff, 1: a mask, 2: a blend
layout(location = 22) uniform uvec2 first_sample;  // of the tile
#ifdef HOLE_VERTICES
layout(location = 7) in float v_alpha;
#endif
#ifdef CLEAR_HOLE
layout(location = 53) uniform vec2 hole_clear;  // share, index of refraction

// thin_glass_transmittance of formats/opal/thin_glass.h.
float thin_glass_transmittance(float cosine, float eta) {
    if (!(cosine > 0.0) || !(eta > 0.0)) return 0.0;
    float face = opaline_transmittance(cosine, eta);
    return face / (2.0 - face);
}
#endif
#ifdef HOLE_IMAGE
layout(binding = 5) uniform usampler2D hole_image;
layout(location = 23) uniform ivec2 hole_wrap;
#endif

// `cosine`: of the view with the normal, its absolute value.
bool sees_surface(vec2 texcoord, float cosine) {
    float alpha = hole.x;
#ifdef HOLE_VERTICES
    alpha *= v_alpha;
#endif
#ifdef HOLE_IMAGE
    alpha *= sample_image(hole_image, texcoord, hole_wrap, false).r;
#endif
#ifdef CLEAR_HOLE
    if (hole.z == 1.0) alpha = alpha >= hole.y ? 1.0 : 0.0;
    alpha *= 1.0 - hole_clear.x * thin_glass_transmittance(cosine, hole_clear.y);
    return covers(alpha, vec2(0.0, 2.0), first_sample + uvec2(gl_FragCoord.xy), v_last_vertex);
#endif
    return covers(alpha, hole.yz, first_sample + uvec2(gl_FragCoord.xy), v_last_vertex);
}
