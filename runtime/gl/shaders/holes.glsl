// As runtime/holes.cpp: which samples see a surface that light passes in places. covers.glsl comes
// before it. HOLE_IMAGE: alpha has an image (image.glsl comes before this). HOLE_VERTICES: vertices
// have alpha.
flat layout(location = 6) in uint v_last_vertex;
layout(location = 21) uniform vec3 hole;  // alpha, cutoff, 1: a mask, 2: a blend
layout(location = 22) uniform uvec2 first_sample;  // of the tile
#ifdef HOLE_VERTICES
layout(location = 7) in float v_alpha;
#endif
#ifdef HOLE_IMAGE
layout(binding = 5) uniform usampler2D hole_image;
layout(location = 23) uniform ivec2 hole_wrap;
#endif

bool sees_surface(vec2 texcoord) {
    float alpha = hole.x;
#ifdef HOLE_VERTICES
    alpha *= v_alpha;
#endif
#ifdef HOLE_IMAGE
    alpha *= sample_image(hole_image, texcoord, hole_wrap, false).r;
#endif
    return covers(alpha, hole.yz, first_sample + uvec2(gl_FragCoord.xy), v_last_vertex);
}
