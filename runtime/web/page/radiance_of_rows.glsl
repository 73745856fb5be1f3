// What a vertex sends to the eye, from the products <T_k, L> in a texture of 2048 columns: the steps
// of view.comp.glsl. Specialised by TERMS, the rows of a vertex; OPAQUE or SHEET or, of translucent
// ones, HARMONICS and SEPARATE. SHARED_ROWS: rows are those of slots. MIXED_ROWS: a vertex has three slots and their
// weights, in 255ths; one of which it has all, unless it is OPAQUE. view_terms.glsl comes before this.
uniform sampler2D products;
uniform uint first_row;  // of vertex 0, or of slot 0, modulo 2^32
#ifdef SHARED_ROWS
#ifdef MIXED_ROWS
layout(location = 1) in uvec4 mixed;
#define slot mixed.x
#else
layout(location = 1) in uint slot;
#endif
#endif
#if HARMONICS > 1
uniform float eta;
uniform uint is_double_sided;
#endif

vec3 product_at(uint row) {
    return texelFetch(products, ivec2(row & 2047u, row >> 11), 0).rgb;
}

vec3 radiance_of_rows(vec3 normal, vec3 to_eye) {
#ifdef SHARED_ROWS
    uint at = first_row + slot * uint(TERMS);
#else
    uint at = first_row + uint(gl_VertexID) * uint(TERMS);
#endif
#if defined(SHEET)
    return max(product_at(at + (dot(normal, to_eye) < 0.0 ? 1u : 0u)), 0.0);
#elif defined(OPAQUE) && defined(MIXED_ROWS)
    vec3 weight = vec3(mixed.w & 255u, (mixed.w >> 8) & 255u, (mixed.w >> 16) & 255u) / 255.0;
    return weight.x * max(product_at(first_row + mixed.x), 0.0) +
           weight.y * max(product_at(first_row + mixed.y), 0.0) +
           weight.z * max(product_at(first_row + mixed.z), 0.0);
#elif defined(OPAQUE)
    return max(product_at(at), 0.0);
#else
    vec3 sum = vec3(0.0);
#ifdef SEPARATE
    sum = product_at(at++);
#endif
#if HARMONICS > 1
    return sum + sum_toward_eye(normal, to_eye, eta, is_double_sided != 0u, at);
#elif HARMONICS == 1
    return sum + product_at(at);
#else
    return sum;
#endif
#endif
}
