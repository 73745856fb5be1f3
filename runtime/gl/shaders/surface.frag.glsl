// Outgoing radiance of a surface, as shade_surface of runtime/surface.cpp. Specialised:
// TEXTURED: base colour has an image (image.glsl comes before this);
// TRANSLUCENT: the rows are multiplied by the Fresnel transmittance;
// MIRRORING: translucent with a specular reflection on top (cube_map.glsl comes before this);
// GLOSS: glossy opaque (cube_map.glsl and gloss.glsl come before this); GLOSS_TEXTURED: with an
// image of roughness and metallic (image.glsl); GLOWS: it sends out light by itself; OWN_TEXTURED: with
// an image (image.glsl); HOLES: light passes it in places (holes.glsl comes before this).
layout(location = 0) in vec3 v_radiance;
layout(location = 1) in vec3 v_base_color;
layout(location = 0) out vec4 color;
layout(location = 11) uniform float shown;  // 1, or 0: left out
#ifdef GLOWS
layout(location = 19) uniform vec3 own_light;  // radiance that the surface sends out by itself
#endif

float tame(float value) {
    return value > 0.0 ? min(value, 1e35) : 0.0;
}

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

vec3 unit_or_zero(vec3 v) {
    float size = length(v);
    return size > 0.0 ? v / size : vec3(0.0);
}
#endif

#ifdef TRANSLUCENT
layout(location = 9) uniform float eta;

// As fresnel_transmittance of view_terms.cpp.
float transmittance(float c) {
    c = min(c, 1.0);
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (!(c > 0.0) || !(under_root > 0.0)) {
        return 0.0;
    }
    float behind = sqrt(under_root);
    float s = c + behind, p = eta * eta * c + behind;
    return min(2.0 * c * behind * (1.0 / (s * s) + eta * eta / (p * p)), 1.0);
}
#endif

#ifdef HAS_OPENNESS
layout(location = 5) in vec4 v_open;
layout(location = 12) uniform mat3 light_from_world;
layout(location = 14) uniform uint has_specular;  // 0: left out

// As in specular.cpp; `lobe`: cosine and sine of the lobe's half angle.
float specular_visibility(vec3 axis, float open, vec3 mirrored, vec2 lobe) {
    float cosine = sqrt(1.0 - open), sine = sqrt(open);
    float low = cosine * lobe.x - sine * lobe.y, high = cosine * lobe.x + sine * lobe.y;
    float at = high > low ? clamp((dot(axis, mirrored) - low) / (high - low), 0.0, 1.0) : 0.0;
    float fits = min(1.0, (1.0 - cosine) / (1.0 - lobe.x));
    float inside = fits * at * at * (3.0 - 2.0 * at);
    float squared = open * open, fourth = squared * squared;
    return 1.0 - (1.0 - inside) * (1.0 - fourth * fourth);
}

// Openness is stored for the front.
vec3 open_axis(vec3 n, bool is_turned) {
    vec3 axis = unit_or_zero(v_open.xyz);
    return is_turned ? axis - 2.0 * dot(axis, n) * n : axis;
}
#endif

#ifdef MIRRORING
layout(binding = 1) uniform sampler2DArray mirrored_light;
layout(location = 13) uniform vec2 lobe;  // cosine and sine of its half angle

// As eval_specular.
vec3 specular(vec3 n, vec3 w, float cosine, bool is_turned) {
    if (has_specular == 0u || !(dot(n, n) > 0.0) || !(cosine > -0.2)) {
        return vec3(0.0);
    }
    float c = clamp(cosine, 1e-6, 1.0);
    float fade = 1.0 + min(cosine, 0.0) / 0.2;
    vec3 mirrored = unit_or_zero(2.0 * c * n - w);
    if (!(dot(mirrored, mirrored) > 0.0)) {
        return vec3(0.0);
    }
    float share = fade * (1.0 - transmittance(c)) *
                  specular_visibility(open_axis(n, is_turned), clamp(v_open.w, 0.0, 1.0), mirrored,
                                      lobe);
    return share * sample_cube(mirrored_light, light_from_world * mirrored);
}
#endif

#ifdef GLOSS
layout(location = 15) uniform vec4 f0_f90;
layout(location = 16) uniform vec2 metallic_roughness;
#ifdef GLOSS_TEXTURED
layout(binding = 3) uniform usampler2D gloss_image;
layout(location = 17) uniform ivec2 gloss_wrap;
#endif

// As make_gloss_surface.
Gloss make_gloss(vec3 base_color) {
    vec2 factors = metallic_roughness;
#ifdef GLOSS_TEXTURED
    factors *= sample_image(gloss_image, v_texcoord, gloss_wrap, false).bg;
#endif
    factors = clamp(factors, 0.0, 1.0);
    Gloss g;
    g.roughness = factors.y;
    g.alpha = max(factors.y * factors.y, kLeastAlpha);
    g.f0 = mix(f0_f90.rgb, clamp(base_color, 0.0, 1.0), factors.x);
    g.f90 = mix(f0_f90.a, 1.0, factors.x);
    g.diffuse = 1.0 - factors.x;
    return g;
}

// As gloss_visibility.
float gloss_visibility(Gloss g, vec3 n, vec3 w, float cosine, bool is_turned) {
    vec3 mirrored = unit_or_zero(2.0 * clamp(cosine, kLeastCosine, 1.0) * n - w);
    if (!(dot(mirrored, mirrored) > 0.0)) {
        return 0.0;
    }
    float a2 = max(g.alpha, 0.05) * max(g.alpha, 0.05);
    vec2 half_angle = vec2(1.0 - a2, 2.0 * max(g.alpha, 0.05)) / (1.0 + a2);
    return specular_visibility(open_axis(n, is_turned), clamp(v_open.w, 0.0, 1.0), mirrored,
                               half_angle);
}
#endif

vec3 tame(vec3 v) {
    return vec3(tame(v.r), tame(v.g), tame(v.b));
}

// As shade_surface of runtime/surface.cpp.
void main() {
#ifdef HOLES
#ifdef HAS_TEXCOORD
    if (!sees_surface(v_texcoord)) discard;
#else
    if (!sees_surface(vec2(0.0))) discard;
#endif
#endif
    vec3 base_color = v_base_color;
#ifdef TEXTURED
    base_color *= sample_image(base_color_image, v_texcoord, wrap, true);
#endif
    vec3 radiance = shown * v_radiance * base_color;
#ifdef HAS_VIEW
    vec3 n = unit_or_zero(v_normal), w = unit_or_zero(v_to_eye);
    float c = dot(n, w);
    bool is_turned = c < 0.0 && is_double_sided != 0u;
    if (is_turned) {
        n = -n;
        c = -c;
    }
#endif
#ifdef TRANSLUCENT
    radiance *= transmittance(c);
#endif
#ifdef MIRRORING
    radiance = tame(radiance) + specular(n, w, c, is_turned);
#endif
#ifdef GLOSS
    Gloss g = make_gloss(base_color);
    float seen = clamp(abs(c), kLeastCosine, 1.0);
    radiance = tame(gloss_diffuse(g, ggx_albedo(seen, g.roughness)) * radiance);
    if (has_specular != 0u) {
        radiance += gloss_visibility(g, n, w, c, is_turned) *
                    tame(eval_gloss(g, light_from_world * n, light_from_world * w, c));
    }
#endif
    radiance = tame(radiance);
#ifdef GLOWS
    vec3 own = own_light;
#ifdef OWN_TEXTURED
    own *= sample_image(own_image, v_texcoord, own_wrap, true);
#endif
    radiance = tame(radiance + own);
#endif
    color = vec4(radiance, 1.0);
}
