// Homogeneous position without a projection matrix: w is the distance along the view axis, depth is
// near / w (reversed, no far plane). y points down, so that row 0 is the top of the picture.
// FORWARD_DEPTH: 1 - near / w instead, where depth cannot be reversed without losing its digits.
// HAS_OPENNESS, NORMAL_MAP: openness.glsl comes before this.
// RADIANCE_OF_ROWS: what comes before this looks up what the vertex sends to the eye.
layout(location = 0) in vec3 position;
#ifndef RADIANCE_OF_ROWS
layout(location = 1) in vec3 radiance;
#endif
layout(location = 2) in vec3 base_color;
#ifdef HAS_TEXCOORD
layout(location = 3) in vec2 texcoord;
layout(location = 2) out vec2 v_texcoord;
#endif
#if defined(HAS_VIEW) || defined(RADIANCE_OF_ROWS)
layout(location = 4) in vec3 normal;
#endif
#ifdef HAS_VIEW
layout(location = 3) out vec3 v_normal;
layout(location = 4) out vec3 v_to_eye;
#endif

#ifdef HAS_OPENNESS
layout(location = 5) in vec2 open_axis;
layout(location = 6) in float open_fraction;
layout(location = 5) out vec4 v_open;  // mean open direction, open fraction
#endif

#ifdef NORMAL_MAP
layout(location = 8) in vec3 tangent;  // octahedral direction, sign
layout(location = 8) out vec4 v_tangent;
#endif

layout(location = 0) uniform vec3 eye;
layout(location = 1) uniform vec3 right;      // over the half width of the image plane
layout(location = 2) uniform vec3 down;       // over the half height
layout(location = 3) uniform vec3 forward;
layout(location = 4) uniform float unit;      // 1 / distance scale: keeps w near 1 for any scene
layout(location = 5) uniform float near_plane;  // in that unit
layout(location = 6) uniform vec4 tile;       // scale xy, offset zw: the tile out of the picture

layout(location = 0) out vec3 v_radiance;
layout(location = 1) out vec3 v_base_color;

#ifdef HOLES
flat layout(location = 6) out uint v_last_vertex;
#endif
#ifdef HOLE_VERTICES
layout(location = 7) in float alpha;
layout(location = 7) out float v_alpha;
#endif

void main() {
    vec3 p = (position - eye) * unit;
    float w = dot(forward, p);
    gl_Position = vec4(dot(right, p) * tile.x + w * tile.z, dot(down, p) * tile.y + w * tile.w,
#ifdef FORWARD_DEPTH
                       w - 2.0 * near_plane, w);
#else
                       near_plane, w);
#endif
#ifdef RADIANCE_OF_ROWS
    v_radiance = radiance_of_rows(normal, -p);
#else
    v_radiance = radiance;
#endif
    v_base_color = base_color;
#ifdef HOLES
    v_last_vertex = uint(gl_VertexID);  // flat: of the last vertex
#endif
#ifdef HOLE_VERTICES
    v_alpha = alpha;
#endif
#ifdef HAS_TEXCOORD
    v_texcoord = texcoord;
#endif
#ifdef HAS_VIEW
    v_normal = normal;
    v_to_eye = -p;
#endif
#ifdef NORMAL_MAP
    v_tangent = vec4(abs(tangent.z) * opaline_decode_axis(tangent.xy), tangent.z);
#endif
#ifdef HAS_OPENNESS
    v_open = vec4(opaline_decode_axis(open_axis), open_fraction);
#endif
}
