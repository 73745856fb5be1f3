// Outgoing radiance of a surface, as shade_surface of runtime/surface.cpp. cube_map.glsl and
// surface.glsl come before this. Specialised:
// TEXTURED: base colour has an image (image.glsl comes before this);
// TRANSLUCENT: the rows are multiplied by the Fresnel transmittance;
// MIRRORING: translucent with a specular reflection on top;
// GLOSS: glossy opaque (gloss.glsl comes before this); GLOSS_TEXTURED: with an
// image of roughness and metallic (image.glsl); GLOWS: it sends out light by itself; OWN_TEXTURED: with
// an image (image.glsl); HOLES: light passes it in places (holes.glsl comes before this);
// NORMAL_MAP: an image has its normals (image.glsl); TURNED: its light is turned to them;
// TWO_SIDES: and is that of a thin-walled surface.
layout(location = 0) in vec3 v_radiance;
layout(location = 1) in vec3 v_base_color;
layout(location = 0) out vec4 color;
layout(location = 11) uniform float shown;  // 1, or 0: left out
#ifdef GLOWS
layout(location = 19) uniform vec3 own_light;  // radiance that the surface sends out by itself
#endif

#ifdef HAS_TEXCOORD
layout(location = 2) in vec2 v_texcoord;
#endif
#ifdef TEXTURED
layout(binding = 0) uniform usampler2D base_color_image;
layout(location = 8) uniform ivec2 wrap;
#endif

#ifdef OWN_TEXTURED
layout(binding = 4) uniform usampler2D own_image;
layout(location = 20) uniform ivec2 own_wrap;
#endif

#ifdef HAS_VIEW
layout(location = 3) in vec3 v_normal;
layout(location = 4) in vec3 v_to_eye;
layout(location = 10) uniform uint is_double_sided;
#endif

#ifdef TRANSLUCENT
layout(location = 9) uniform float eta;
#endif

#ifdef HAS_OPENNESS
layout(location = 5) in vec4 v_open;
layout(location = 12) uniform mat3 light_from_world;
layout(location = 14) uniform uint has_specular;  // 0: left out
#endif

#ifdef MIRRORING
layout(binding = 1) uniform sampler2DArray mirrored_light;
layout(location = 13) uniform vec2 lobe;  // cosine and sine of its half angle
#endif

#ifdef GLOSS
layout(location = 15) uniform vec4 f0_f90;
layout(location = 16) uniform vec2 metallic_roughness;
#ifdef GLOSS_TEXTURED
layout(binding = 3) uniform usampler2D gloss_image;
layout(location = 17) uniform ivec2 gloss_wrap;
#endif

vec2 gloss_factors() {
#ifdef GLOSS_TEXTURED
    return metallic_roughness * sample_image(gloss_image, v_texcoord, gloss_wrap, false).bg;
#else
    return metallic_roughness;
#endif
}
#endif

#ifdef NORMAL_MAP
layout(location = 8) in vec4 v_tangent;
layout(binding = 6) uniform usampler2D normal_image;
layout(location = 24) uniform ivec2 normal_wrap;
layout(location = 25) uniform float normal_scale;
#endif
#ifdef TURNED
layout(location = 26) uniform OpalineTurnedLight turned_light;
#endif

// As shade_surface of runtime/surface.cpp.
void main() {
#ifdef HOLES
    float met_cosine = 1.0;
#ifdef CLEAR_HOLE
    met_cosine = abs(dot(opaline_unit_or_zero(v_normal), opaline_unit_or_zero(v_to_eye)));
#endif
#ifdef HAS_TEXCOORD
    if (!sees_surface(v_texcoord, met_cosine)) discard;
#else
    if (!sees_surface(vec2(0.0), met_cosine)) discard;
#endif
#endif
    vec3 base_color = v_base_color;
#ifdef TEXTURED
    base_color *= sample_image(base_color_image, v_texcoord, wrap, true);
#endif
    vec3 radiance = shown * v_radiance;
#ifdef HAS_VIEW
    OpalineView view = opaline_view(v_normal, v_to_eye, is_double_sided != 0u);
#endif
#ifdef NORMAL_MAP
    vec3 normal = opaline_unit_or_zero(v_normal);
    vec3 mapped = opaline_mapped_normal(sample_image(normal_image, v_texcoord, normal_wrap, false),
                                        normal_scale, normal, v_tangent);
#ifdef TURNED
    float side = 1.0;
#ifdef TWO_SIDES
    if (view.is_turned) side = -1.0;  // the one that is seen
#endif
    radiance = opaline_turn_light(turned_light, radiance, side * normal, side * mapped);
#endif
    view = opaline_view_mapped(view, mapped);
#endif
#ifdef MIRRORING
    radiance = opaline_translucent(radiance, base_color, view, eta, v_open, lobe);
#elif defined(TRANSLUCENT)
    radiance = opaline_translucent(radiance, base_color, view, eta);
#elif defined(GLOSS)
    Gloss g = make_gloss(f0_f90, gloss_factors(), base_color);
    vec3 received = radiance;
    radiance = glossy_diffuse(g, radiance, base_color, view);
    if (has_specular != 0u) {
        radiance += glossy_mirrored(g, light_from_world, view, v_open);
#ifndef GLOSS_TEXTURED
        radiance += glossy_mirrored_surfaces(g, received, view, v_open);
#endif
    }
#else
    radiance = opaline_diffuse(radiance, base_color);
#endif
#ifdef MIRRORING
    if (has_specular != 0u) {
        radiance += opaline_mirrored(mirrored_light, light_from_world, view, eta, v_open, lobe);
    }
#endif
    radiance = opaline_displayable(radiance);
#ifdef GLOWS
    vec3 own = own_light;
#ifdef OWN_TEXTURED
    own *= sample_image(own_image, v_texcoord, own_wrap, true);
#endif
    radiance = opaline_displayable(radiance + own);
#endif
    color = vec4(radiance, 1.0);
}
