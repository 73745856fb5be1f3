// The BRDF of glossy opaque surfaces and its sum over distant light: the steps of
// formats/opal/gloss_model.cpp and runtime/gloss.cpp. Specialised by LOBE_TAPS, ALBEDO_ROWS,
// ALBEDO_COLUMNS, NARROW_ROUGHNESS and WIDE_ROUGHNESS. cube_map.glsl and surface.glsl come before it.
layout(binding = 2) uniform sampler2DArray light_maps;  // half as wide at each level

struct Cell {
    vec4 direction_solid_angle;
    vec4 flux_widening;
};
struct Sun {
    vec4 direction_radius;
    vec4 radiance_solid_angle;
};
// A row for each cell and sun, the table as it is.
layout(binding = 8) uniform sampler2D cells;
layout(binding = 9) uniform sampler2D sun_table;
layout(binding = 10) uniform sampler2D albedo;
int cell_count() { return textureSize(cells, 0).y; }
Cell cell_at(int i) {
    return Cell(texelFetch(cells, ivec2(0, i), 0), texelFetch(cells, ivec2(1, i), 0));
}
Sun sun_at(int i) {
    return Sun(texelFetch(sun_table, ivec2(0, i), 0), texelFetch(sun_table, ivec2(1, i), 0));
}
vec2 albedo_entry(int column, int row) { return texelFetch(albedo, ivec2(column, row), 0).rg; }

const float kLeastCosine = 1e-3, kLeastAlpha = 1e-3;

struct Gloss {
    float alpha, roughness;
    vec3 f0;
    float f90, diffuse;
};

// As make_gloss_surface. `factors`: metallic and roughness, times their image.
Gloss make_gloss(vec4 f0_f90, vec2 factors, vec3 base_color) {
    factors = clamp(factors, 0.0, 1.0);
    Gloss g;
    g.roughness = factors.y;
    g.alpha = max(factors.y * factors.y, kLeastAlpha);
    g.f0 = mix(f0_f90.rgb, clamp(base_color, 0.0, 1.0), factors.x);
    g.f90 = mix(f0_f90.a, 1.0, factors.x);
    g.diffuse = 1.0 - factors.x;
    return g;
}

// Both parts of the albedo of F0 and F90, from the table.
vec2 ggx_albedo(float cosine, float roughness) {
    float x = sqrt(clamp(cosine, 0.0, 1.0)) * float(ALBEDO_COLUMNS - 1);
    float y = clamp(roughness, 0.0, 1.0) * float(ALBEDO_ROWS - 1);
    int column = min(int(x), ALBEDO_COLUMNS - 2), row = min(int(y), ALBEDO_ROWS - 2);
    float s = x - float(column), t = y - float(row);
    return mix(mix(albedo_entry(column, row), albedo_entry(column + 1, row), s),
               mix(albedo_entry(column, row + 1), albedo_entry(column + 1, row + 1), s), t);
}

vec3 gloss_compensation(Gloss g, vec2 table) {
    return 1.0 + g.f0 * (1.0 / max(table.x + table.y, 1e-3) - 1.0);
}

// (1 - metallic) (1 - max E).
float gloss_diffuse(Gloss g, vec2 table) {
    vec3 e = gloss_compensation(g, table) * (table.x * g.f0 + g.f90 * table.y);
    return g.diffuse * max(1.0 - max(e.r, max(e.g, e.b)), 0.0);
}

float ggx_distribution(float n_h, float alpha) {
    float d = max((1.0 - n_h) * (1.0 + n_h), 0.0) + alpha * alpha * n_h * n_h;
    return alpha * alpha / (3.14159265 * d * d);
}

float smith_root(float c, float a2) {
    return sqrt(a2 + (1.0 - a2) * c * c);
}

float schlick_weight(float v_h) {
    float missing = 1.0 - clamp(v_h, 0.0, 1.0), squared = missing * missing;
    return squared * squared * missing;
}

// The view in the plane of incidence: eye = sine * tangent + cosine * normal, in the light's frame.
struct Frame {
    vec3 tangent, bitangent, normal, eye;
    float cosine, sine;
};

Frame make_frame(vec3 n, vec3 w, float cosine) {
    Frame f;
    f.normal = n;
    f.cosine = cosine;
    f.sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec3 flat_part = w - dot(n, w) * n;
    float size = length(flat_part);
    f.tangent = size > 1e-5
                    ? flat_part / size
                    : normalize(cross(n, abs(n.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    f.bitangent = cross(n, f.tangent);
    f.eye = f.sine * f.tangent + cosine * n;
    return f;
}

// Sums of weights (x, y) and of weighted light, for both parts of Schlick's term.
struct LobeSum {
    vec3 light_f0, light_f90;
    vec2 weight;
};

struct LobeIntegral {
    vec3 of_f0, of_f90;
};

LobeIntegral scale_sum(LobeSum sum, vec2 table) {
    LobeIntegral result = LobeIntegral(vec3(0.0), vec3(0.0));
    if (sum.weight.x > 0.0) result.of_f0 = (table.x / sum.weight.x) * sum.light_f0;
    if (sum.weight.y > 0.0) result.of_f90 = (table.y / sum.weight.y) * sum.light_f90;
    return result;
}

LobeIntegral sum_taps(vec2 table, float alpha, Frame f) {
    const float kCosGolden = -0.73736888, kSinGolden = 0.67549029, kLevelBias = -0.7;
    float a2 = alpha * alpha, c = f.cosine, s = f.sine;
    float stretch = sqrt(a2 * s * s + c * c);
    float vx = alpha * s / stretch, vz = c / stretch;
    float root_v = smith_root(c, a2) / c;
    float n = float(textureSize(light_maps, 0).x);
    float last = floor(log2(n) + 0.5);  // down to one texel
    LobeSum sum = LobeSum(vec3(0.0), vec3(0.0), vec2(0.0));
    vec2 phi = vec2(1.0, 0.0);
    for (int i = 0; i < LOBE_TAPS; ++i) {
        float u = (float(i) + 0.5) / float(LOBE_TAPS);
        float z = (1.0 - u) * (1.0 + vz) - vz;
        float r = sqrt(max(1.0 - z * z, 0.0));
        vec3 h = normalize(vec3(alpha * (r * phi.x + vx), alpha * r * phi.y, z + vz));
        phi = vec2(phi.x * kCosGolden - phi.y * kSinGolden, phi.y * kCosGolden + phi.x * kSinGolden);
        float v_h = s * h.x + c * h.z;
        vec3 local = vec3(2.0 * v_h * h.x - s, 2.0 * v_h * h.y, 2.0 * v_h * h.z - c);
        if (!(local.z > 0.0)) continue;
        vec3 l = local.x * f.tangent + local.y * f.bitangent + local.z * f.normal;
        float root_l = smith_root(local.z, a2) / local.z;
        float pdf = ggx_distribution(h.z, alpha) / (2.0 * c * (1.0 + root_v));
        float major = max(abs(l.x), max(abs(l.y), abs(l.z)));
        float texel = 4.0 * major * major * major / (n * n);
        float level = 0.5 * log2(1.0 / (float(LOBE_TAPS) * pdf * texel)) + kLevelBias;
        vec3 radiance =
            opaline_sample_cube_level(light_maps, l, int(floor(clamp(level, 0.0, last) + 0.5)));
        float weight = (1.0 + root_v) / (root_v + root_l);
        float grazing = weight * schlick_weight(v_h), rest = weight - grazing;
        sum.weight += vec2(rest, grazing);
        sum.light_f0 += rest * radiance;
        sum.light_f90 += grazing * radiance;
    }
    return scale_sum(sum, table);
}

LobeIntegral sum_cells(vec2 table, float alpha, Frame f) {
    float a2 = alpha * alpha, c = f.cosine, root_v = smith_root(c, a2);
    LobeSum sum = LobeSum(vec3(0.0), vec3(0.0), vec2(0.0));
    for (int i = 0; i < cell_count(); ++i) {
        Cell cell = cell_at(i);
        vec3 direction = cell.direction_solid_angle.xyz;
        float n_l = dot(f.normal, direction);
        if (!(n_l > 0.0)) continue;
        float h_h = max(2.0 + 2.0 * dot(f.eye, direction), 1e-12);
        float n_h = c + n_l, n_h_squared = n_h * n_h / h_h;
        float wide = a2 + cell.flux_widening.w;
        float d = max(1.0 - n_h_squared, 0.0) + wide * n_h_squared;
        float lobe = wide * n_l /
                     (2.0 * 3.14159265 * d * d * (n_l * root_v + c * smith_root(n_l, a2)));
        float missing = max(1.0 - 0.5 * sqrt(h_h), 0.0), squared = missing * missing;
        float grazing = lobe * squared * squared * missing, rest = lobe - grazing;
        sum.weight += vec2(rest, grazing) * cell.direction_solid_angle.w;
        sum.light_f0 += rest * cell.flux_widening.rgb;
        sum.light_f90 += grazing * cell.flux_widening.rgb;
    }
    return scale_sum(sum, table);
}

void add_suns(float alpha, Frame f, inout LobeIntegral result) {
    for (int i = 0; i < textureSize(sun_table, 0).y; ++i) {
        Sun sun = sun_at(i);
        vec3 direction = sun.direction_radius.xyz;
        float radius = sun.direction_radius.w;
        float n_l = dot(f.normal, direction);
        if (!(n_l > 0.0)) continue;
        vec3 h = normalize(f.eye + direction);
        float wide = sqrt(alpha * alpha + 0.25 * radius * radius), a2 = wide * wide;
        float visibility =
            0.5 / (n_l * smith_root(f.cosine, a2) + f.cosine * smith_root(n_l, a2));
        float lobe = ggx_distribution(dot(f.normal, h), wide) * visibility * n_l *
                     sun.radiance_solid_angle.w;
        float schlick = schlick_weight(dot(f.eye, h));
        result.of_f0 += lobe * (1.0 - schlick) * sun.radiance_solid_angle.rgb;
        result.of_f90 += lobe * schlick * sun.radiance_solid_angle.rgb;
    }
}

// L_spec without openness; n and w in the light's frame.
vec3 eval_gloss(Gloss g, vec3 n, vec3 w, float cosine) {
    if (!(dot(n, n) > 0.0) || !(cosine > -0.2)) return vec3(0.0);
    float fade = 1.0 + min(cosine, 0.0) / 0.2;
    Frame f = make_frame(n, w, clamp(cosine, kLeastCosine, 1.0));
    vec2 table = ggx_albedo(f.cosine, g.roughness);
    float wide = clamp((g.roughness - NARROW_ROUGHNESS) / (WIDE_ROUGHNESS - NARROW_ROUGHNESS),
                       0.0, 1.0);
    LobeIntegral result = LobeIntegral(vec3(0.0), vec3(0.0));
    if (wide < 1.0) {
        result = sum_taps(table, g.alpha, f);
    }
    if (wide > 0.0) {
        LobeIntegral cells = sum_cells(table, g.alpha, f);
        result.of_f0 = mix(result.of_f0, cells.of_f0, wide);
        result.of_f90 = mix(result.of_f90, cells.of_f90, wide);
    }
    add_suns(g.alpha, f, result);
    return fade * gloss_compensation(g, table) * (g.f0 * result.of_f0 + g.f90 * result.of_f90);
}

// As gloss_visibility.
float gloss_visibility(Gloss g, OpalineView view, vec4 openness) {
    vec3 mirrored = opaline_unit_or_zero(2.0 * clamp(view.cosine, kLeastCosine, 1.0) * view.normal -
                                         view.to_eye);
    if (!(dot(mirrored, mirrored) > 0.0)) return 0.0;
    float a2 = max(g.alpha, 0.05) * max(g.alpha, 0.05);
    vec2 half_angle = vec2(1.0 - a2, 2.0 * max(g.alpha, 0.05)) / (1.0 + a2);
    return opaline_specular_visibility(opaline_open_axis(openness, view), clamp(openness.w, 0.0, 1.0),
                                       mirrored, half_angle);
}

// What a glossy opaque or thin-walled surface reflects diffusely, from its receivers' radiance;
// glossy_mirrored comes on top.
vec3 glossy_diffuse(Gloss g, vec3 radiance, vec3 base_color, OpalineView view) {
    float seen = clamp(abs(view.cosine), kLeastCosine, 1.0);
    return opaline_diffuse(gloss_diffuse(g, ggx_albedo(seen, g.roughness)) * radiance, base_color);
}

// What it mirrors. `openness`: as for opaline_mirrored.
vec3 glossy_mirrored(Gloss g, mat3 light_from_world, OpalineView view, vec4 openness) {
    return gloss_visibility(g, view, openness) *
           opaline_displayable(eval_gloss(g, light_from_world * view.normal,
                                          light_from_world * view.to_eye, view.cosine));
}

// What a metal without an image of metallic mirrors of surfaces, as mirrored_surfaces of
// runtime/surface.cpp: `radiance` of its receivers is what they send to it.
vec3 glossy_mirrored_surfaces(Gloss g, vec3 radiance, OpalineView view, vec4 openness) {
    float covered = 1.0 - openness.w;
    if (g.diffuse > 0.0 || covered < 1.0 / 64.0) return vec3(0.0);
    vec2 table = ggx_albedo(clamp(abs(view.cosine), kLeastCosine, 1.0), g.roughness);
    vec3 mirrors = gloss_compensation(g, table) * (table.x * g.f0 + g.f90 * table.y);
    float blocked = 1.0 - gloss_visibility(g, view, openness);
    return opaline_displayable(blocked / covered * (mirrors * radiance));
}
