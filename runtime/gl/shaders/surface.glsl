// What a surface sends to the eye from the radiance of its receivers, as runtime/surface.cpp,
// view_terms.cpp, specular.cpp and turned_light.cpp. No uniforms. cube_map.glsl comes before this.

float opaline_displayable(float value) {
    return value > 0.0 ? min(value, 1e35) : 0.0;
}

// Finite and not negative: truncated light rings below zero where there is none.
vec3 opaline_displayable(vec3 v) {
    return vec3(opaline_displayable(v.r), opaline_displayable(v.g), opaline_displayable(v.b));
}

vec3 opaline_unit_or_zero(vec3 v) {
    float size = length(v);
    return size > 0.0 ? v / size : vec3(0.0);
}

// How a point is seen: the normal it is shaded with, the direction to the eye, unit or zero both,
// and their cosine, below 0 where a surface of one side faces away.
struct OpalineView {
    vec3 normal, to_eye;
    float cosine;
    bool is_turned;  // whether the normal was turned toward the eye
};

// From an interpolated normal and a vector toward the eye, of any lengths.
OpalineView opaline_view(vec3 normal, vec3 to_eye, bool is_double_sided) {
    OpalineView view = OpalineView(opaline_unit_or_zero(normal), opaline_unit_or_zero(to_eye), 0.0, false);
    view.cosine = dot(view.normal, view.to_eye);
    if (view.cosine < 0.0 && is_double_sided) {
        view = OpalineView(-view.normal, view.to_eye, -view.cosine, true);
    }
    return view;
}

// The unit normal that a normal map gives a point: mapped_normal. `value`: the image's, code / 255,
// interpolated. `normal`: unit; `tangent`: interpolated direction and sign.
vec3 opaline_mapped_normal(vec3 value, float scale, vec3 normal, vec4 tangent) {
    vec3 at = (255.0 * value - 128.0) / 127.0;
    vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
    vec3 mapped = (scale * at.x) * tangent.xyz + (scale * at.y) * bitangent + at.z * normal;
    float size = length(mapped);
    return size > 0.0 ? mapped / size : normal;
}

// The same point with that normal, bent toward an eye that it turns away from: view_mapped.
OpalineView opaline_view_mapped(OpalineView view, vec3 mapped) {
    OpalineView bent = view;
    bent.normal = view.is_turned ? -mapped : mapped;
    bent.cosine = dot(bent.normal, view.to_eye);
    float least = min(view.cosine, 0.05);
    if (bent.cosine < least) {
        vec3 toward = bent.normal + (least - bent.cosine) * view.to_eye;
        bent.normal = toward / length(toward);
        bent.cosine = dot(bent.normal, view.to_eye);
    }
    return bent;
}

// Distant light, as it is turned to the normal of a map: TurnedLight.
struct OpalineTurnedLight {
    vec3 harmonics[9];
    vec3 least;
    int suns;
    vec3 sun_direction[8], sun_light[8];
};

vec3 opaline_smooth_light(OpalineTurnedLight light, vec3 n) {
    return max(light.harmonics[0] + n.y * light.harmonics[1] + n.z * light.harmonics[2] +
                   n.x * light.harmonics[3] + (n.x * n.y) * light.harmonics[4] +
                   (n.y * n.z) * light.harmonics[5] + (3.0 * n.z * n.z - 1.0) * light.harmonics[6] +
                   (n.x * n.z) * light.harmonics[7] + (n.x * n.x - n.y * n.y) * light.harmonics[8],
               vec3(0.0));
}

vec3 opaline_sun_light(OpalineTurnedLight light, vec3 n) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < light.suns; ++i) {
        sum += max(dot(n, light.sun_direction[i]), 0.0) * light.sun_light[i];
    }
    return sum;
}

// The radiance of receivers with the normal `from`, for the normal `to`: turn_light. Unit normals.
vec3 opaline_turn_light(OpalineTurnedLight light, vec3 radiance, vec3 from, vec3 to) {
    const vec3 kOne = vec3(1.0);
    vec3 smoothly = opaline_smooth_light(light, from), sun = opaline_sun_light(light, from);
    float most = max(dot(sun, kOne), dot(light.least, kOne));
    float share = most > 0.0 ? clamp((dot(radiance, kOne) - dot(smoothly, kOne)) / most, 0.0, 1.0) : 0.0;
    vec3 a = smoothly + share * sun;
    vec3 b = opaline_smooth_light(light, to) + share * opaline_sun_light(light, to);
    vec3 straight = min(radiance, a), below = a + light.least, above = b + light.least;
    vec3 ratio = vec3(below.r > 0.0 ? above.r / below.r : 1.0, below.g > 0.0 ? above.g / below.g : 1.0,
                      below.b > 0.0 ? above.b / below.b : 1.0);
    return radiance - straight + straight * ratio;
}

// The share of light that passes a smooth boundary: fresnel_transmittance. `eta`: index of
// refraction behind it over that in front.
float opaline_transmittance(float cosine, float eta) {
    float c = min(cosine, 1.0);
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (!(c > 0.0) || !(under_root > 0.0)) return 0.0;
    float behind = sqrt(under_root);
    float s = c + behind, p = eta * eta * c + behind;
    return min(2.0 * c * behind * (1.0 / (s * s) + eta * eta / (p * p)), 1.0);
}

// Diffuse and thin-walled surfaces: `radiance` as receivers have it, interpolated.
vec3 opaline_diffuse(vec3 radiance, vec3 base_color) {
    return opaline_displayable(radiance * base_color);
}

// What comes out of translucent surfaces that mirror nothing.
vec3 opaline_translucent(vec3 radiance, vec3 base_color, OpalineView view, float eta) {
    return opaline_displayable(opaline_transmittance(view.cosine, eta) * (radiance * base_color));
}

// `openness`: interpolated mean open direction (opaline_decode_axis) and open fraction; stored for
// the front.
vec3 opaline_open_axis(vec4 openness, OpalineView view) {
    vec3 axis = opaline_unit_or_zero(openness.xyz);
    return view.is_turned ? axis - 2.0 * dot(axis, view.normal) * view.normal : axis;
}

// The part of a lobe that nothing blocks: specular_visibility. `lobe`: cosine and sine of its half
// angle.
float opaline_specular_visibility(vec3 axis, float open, vec3 mirrored, vec2 lobe) {
    float cosine = sqrt(1.0 - open), sine = sqrt(open);
    float low = cosine * lobe.x - sine * lobe.y, high = cosine * lobe.x + sine * lobe.y;
    float at = high > low ? clamp((dot(axis, mirrored) - low) / (high - low), 0.0, 1.0) : 0.0;
    float fits = min(1.0, (1.0 - cosine) / (1.0 - lobe.x));
    float inside = fits * at * at * (3.0 - 2.0 * at);
    float squared = open * open, fourth = squared * squared;
    return 1.0 - (1.0 - inside) * (1.0 - fourth * fourth);
}

// What the boundary of a glossy translucent surface mirrors: mirrored_shares. `direction`: unit, or
// zero where it mirrors nothing.
struct OpalineMirror {
    vec3 direction;
    float sky, own;
};

OpalineMirror opaline_mirror(OpalineView view, float eta, vec4 openness, vec2 lobe) {
    OpalineMirror mirror = OpalineMirror(vec3(0.0), 0.0, 0.0);
    vec3 n = view.normal;
    if (!(dot(n, n) > 0.0) || !(view.cosine > -0.4)) return mirror;
    float c = clamp(view.cosine, 1e-6, 1.0);
    float behind = max(-view.cosine, 0.0) / 0.2;
    mirror.direction = opaline_unit_or_zero(2.0 * c * n - view.to_eye);
    if (!(dot(mirror.direction, mirror.direction) > 0.0)) return mirror;
    float sky = max(1.0 - behind, 0.0) *
                opaline_specular_visibility(opaline_open_axis(openness, view),
                                            clamp(openness.w, 0.0, 1.0), mirror.direction, lobe);
    float mirrors = 1.0 - opaline_transmittance(c, eta);
    mirror.sky = mirrors * sky;
    mirror.own = mirrors * min(2.0 - behind, 1.0) * (1.0 - sky);
    return mirror;
}

// What comes out of glossy translucent surfaces, with what their boundary mirrors of light like it
// where it does not see the sky; opaline_mirrored comes on top.
vec3 opaline_translucent(vec3 radiance, vec3 base_color, OpalineView view, float eta, vec4 openness,
                         vec2 lobe) {
    float share = opaline_transmittance(view.cosine, eta) + opaline_mirror(view, eta, openness, lobe).own;
    return opaline_displayable(share * (radiance * base_color));
}

// What the boundary of a glossy translucent surface mirrors of the sky: eval_specular. `light`: the
// environment, convolved for its roughness, in the light's frame.
vec3 opaline_mirrored(sampler2DArray light, mat3 light_from_world, OpalineView view, float eta,
                      vec4 openness, vec2 lobe) {
    OpalineMirror mirror = opaline_mirror(view, eta, openness, lobe);
    if (!(mirror.sky > 0.0)) return vec3(0.0);
    return mirror.sky * opaline_sample_cube(light, light_from_world * mirror.direction);
}
