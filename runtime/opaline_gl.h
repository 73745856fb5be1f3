/* Opaline in the host's OpenGL context: relights a baked asset in compute shaders and hands out
   buffers that the host's own shaders read. C99. Needs desktop OpenGL 4.3 or OpenGL ES 3.1, core
   parts alone, and links to no OpenGL library: functions come from the host's loader.

   Every function here wants the context that the handle was made in, or one that shares objects
   with it, to be current on the calling thread, and checks it: another one is refused. After each
   call all GL state is as it was before, but for errors: those that the host left unasked are
   dropped. A program must not be marked for deletion while it is current: nothing could bring it
   back. Calls only enqueue work, nothing waits for the GPU; shaders and vertex arrays of the same
   context see the results without a barrier of the host's. Call outside of conditional rendering.
   The rules of opaline.h hold as well; statuses are listed there.

   share/opaline/glsl/opaline_surface.glsl holds functions that turn a receiver's radiance into that
   of a surface seen by the eye, opaline_gloss.glsl those of glossy opaque ones (after the former).
   Paste them into shaders of GLSL 3.30, ES 3.00 or later, behind the version; default precisions
   are high from there on. opaline_images.glsl, opaline_volumes.glsl and opaline_layer.glsl hold
   those of volumes and cloud layers, below; each file may be used without the others but for
   opaline_gloss.glsl. */
#ifndef OPALINE_GL_H
#define OPALINE_GL_H

#include "opaline.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct opaline_gl opaline_gl; /* an asset in an OpenGL context */

/* Address of an OpenGL function by its name, or NULL; as eglGetProcAddress, SDL_GL_GetProcAddress
   and the like. Called within opaline_gl_create alone. */
typedef void* (*opaline_gl_loader)(const char* name);

typedef enum opaline_gl_flags {
    OPALINE_GL_DEFAULT = 0,
    OPALINE_GL_WITH_MESH = 1,    /* uploads the mesh: for hosts that draw it from the asset */
    OPALINE_GL_WITH_TEXTURE = 2, /* keeps a texture of the radiance beside the buffer */
    OPALINE_GL_WITH_VOLUMES = 4, /* uploads volumes, four at most */
    OPALINE_GL_WITH_IMAGES = 8   /* uploads images of surfaces */
} opaline_gl_flags;

/* Uploads transport and compiles the shaders; all radiance is 0 until the first relight. The asset
   may be released afterwards. `loader` NULL: the context is looked for in the EGL or GLX library
   that the program has loaded. `flags`: a sum of opaline_gl_flags.
   OPALINE_GL_NO_CONTEXT: none is current, or no loader was found. OPALINE_GL_TOO_OLD: below OpenGL
   4.3 or ES 3.1, or a function is missing. OPALINE_GL_REFUSED: a limit of the driver, or a shader
   that it does not compile. */
OPALINE_API opaline_status opaline_gl_create(const opaline_asset* asset, opaline_gl_loader loader,
                                             uint32_t flags, opaline_gl** out);

/* Deletes the objects in the context. Memory is freed in any case: without the right context the
   status says so, and the objects stay until their context goes. NULL is fine. */
OPALINE_API opaline_status opaline_gl_release(opaline_gl* gl);

/* Computes <T_k, L> of all receivers under the light, that of emitters included, and what they show
   the eye that was last set. The light must have been made for an asset of the same cube map size
   and number of emitters; it is copied from. OPALINE_OUT_OF_MEMORY where the driver has none. */
OPALINE_API opaline_status opaline_gl_relight(opaline_gl* gl, const opaline_light* light);

/* Where translucent and thin-walled receivers, volumes and the cloud layer are seen from, in the
   asset's world [m], three finite floats; NULL, as at first: each receiver along its own normal,
   the others from the world's origin. Opaque receivers cost nothing. */
OPALINE_API opaline_status opaline_gl_look_from(opaline_gl* gl, const float eye[3]);

/* Names of GL objects; 0 where there is none. They stay the library's and keep their names until
   the release. Read them only. Receivers are counted as in opaline.h: receiver i begins at byte
   i * stride. */
typedef struct opaline_gl_objects {
    size_t struct_size; /* in: sizeof(opaline_gl_objects) */

    /* Buffer, 4 floats a receiver, stride 16: what opaline_shade_from gives with
       OPALINE_SHADE_WITHOUT_BASE_COLOR and _WITHOUT_FRESNEL, then 0. For vertex attributes, or for
       buffer blocks of std430 as vec4[]. */
    uint32_t radiance;

    /* With OPALINE_GL_WITH_TEXTURE: the same as a 2D texture of RGBA32F, nearest filter: receiver i
       is texel (i mod width, i / width). For vertex shaders, where OpenGL ES promises no buffer
       blocks. */
    uint32_t radiance_texture, radiance_texture_width;

    /* With OPALINE_GL_WITH_MESH. Buffers of floats, by receiver: position [m], stride 12; normal,
       unit, stride 12; base colour factor times vertex colour, stride 12; texture coordinate,
       stride 8, 0 where the asset has none. Triangles: uint32 numbers, counted within their
       primitive. */
    uint32_t position, normal, base_color, texcoord, triangle;

    /* With OPALINE_GL_WITH_MESH, for assets with glossy surfaces, stride 4: openness, two signed
       normalised bytes (the axis, octahedral), then one unsigned normalised byte (the fraction). */
    uint32_t openness;

    /* For assets with glossy opaque or thin-walled surfaces: textures of the uniforms
       opaline_light_maps (a 2D array), opaline_cells, opaline_sun_table and opaline_albedo (2D) of
       opaline_gloss.glsl; the first three are filled by each relight. */
    uint32_t light_maps, cells, sun_table, albedo;
} opaline_gl_objects;

/* Fills `objects`. */
OPALINE_API opaline_status opaline_gl_get_objects(const opaline_gl* gl,
                                                  opaline_gl_objects* objects);

/* What the functions of opaline_surface.glsl and opaline_gloss.glsl need to know of a primitive,
   beside opaline_asset_primitive and opaline_asset_primitive_shading. */
typedef struct opaline_gl_surface {
    size_t struct_size; /* in: sizeof(opaline_gl_surface) */

    /* Its part of the buffer of triangles: of the numbers' count, from the first on. */
    uint32_t first_index, index_count;

    /* Translucent and glossy: a 2D array texture of six layers for opaline_mirrored, filled by each
       relight; else 0. */
    uint32_t mirrored_light;
    float lobe[2]; /* for opaline_mirrored and opaline_translucent */

    /* Column by column, as glUniformMatrix3fv takes it: of the light that relit last. */
    float light_from_world[9];

    uint32_t is_glossy;          /* 1: glossy and not translucent, for opaline_gloss.glsl; else 0 */
    float f0_f90[4], factors[2]; /* for opaline_make_gloss, before the asset's image of factors */
} opaline_gl_surface;

/* Fills `surface`. */
OPALINE_API opaline_status opaline_gl_get_surface(const opaline_gl* gl, uint32_t primitive,
                                                  opaline_gl_surface* surface);

/* Images of surfaces, for opaline_images.glsl: all share the texture coordinates of the receivers.

       vec3 opaline_sample_image(usampler2D image, vec2 texcoord, ivec2 wrap, bool is_srgb)
           bilinear in linear light, or the nearest texel as `wrap` says; is_srgb for base colour and emission, which are decoded.
       bool opaline_covers(float alpha, vec2 cutoff_mode, uvec2 pixel, uint triangle)
           whether a sample sees a surface of that alpha; `triangle`: any number of it. Blends are
           spread over samples, so that nothing needs sorting; hosts that sort may blend instead. */
typedef struct opaline_gl_image {
    uint32_t texture; /* 2D, 8-bit codes for usampler2D; 0: there is none, take 1 */
    int32_t wrap[2];
} opaline_gl_image;

typedef struct opaline_gl_images {
    size_t struct_size;          /* in: sizeof(opaline_gl_images) */
    opaline_gl_image base_color; /* times the receivers' base colour */
    opaline_gl_image gloss;      /* .bg, times `factors` of opaline_gl_surface; is_srgb false */
    opaline_gl_image emission;   /* times the radiance of opaline_asset_primitive_emission */
    opaline_gl_image alpha;      /* .r, is_srgb false */
    float alpha_factor;          /* times that of vertices and image */
    float cutoff_mode[2];        /* for opaline_covers; mode 0: the surface is whole */
    uint32_t vertex_alpha;       /* buffer of floats by receiver, stride 4; 0: take 1 */
    uint32_t srgb_table;         /* 2D texture of the uniform opaline_srgb_table */
} opaline_gl_images;

/* Fills `images`; without OPALINE_GL_WITH_IMAGES all names are 0. */
OPALINE_API opaline_status opaline_gl_get_images(const opaline_gl* gl, uint32_t primitive,
                                                 opaline_gl_images* images);

/* The normal map of a primitive, for functions of opaline_surface.glsl:

       vec3 opaline_mapped_normal(vec3 value, float scale, vec3 normal, vec4 tangent)
           the unit normal of a point. value: opaline_sample_image(...), is_srgb false; normal:
           interpolated and unit; tangent: what vertices make of their attribute t,
           vec4(abs(t.z) * opaline_decode_axis(t.xy), t.z), interpolated.
       OpalineView opaline_view_mapped(OpalineView view, vec3 mapped)
           the same point seen with that normal: for translucent and glossy surfaces.
       vec3 opaline_turn_light(OpalineTurnedLight light, vec3 radiance, vec3 from, vec3 to)
           where `is_turned`: interpolated radiance of receivers, turned from their normal to the
           mapped one. Uniforms of a struct OpalineTurnedLight take the numbers below. Of
           thin-walled surfaces (is_turned 2) both normals are negated where view.is_turned.
   Rows of other surfaces stay as they are. */
typedef struct opaline_gl_normal_map {
    size_t struct_size;     /* in: sizeof(opaline_gl_normal_map) */
    opaline_gl_image image; /* texture 0: there is none */
    float scale;
    uint32_t tangent;   /* buffer, stride 8: by receiver three signed normalised shorts, t above */
    uint32_t is_turned; /* 1: diffuse; 2: thin-walled; else 0 */
    /* Of the light that relit last; 0 before. The first `suns` of eight count. */
    float harmonics[9][3], least[3];
    int32_t suns;
    float sun_direction[8][3], sun_light[8][3];
} opaline_gl_normal_map;

/* Fills `map`; without OPALINE_GL_WITH_IMAGES there is none. */
OPALINE_API opaline_status opaline_gl_get_normal_map(const opaline_gl* gl, uint32_t primitive,
                                                     opaline_gl_normal_map* map);

/* --- Volumes ------------------------------------------------------------------------------ */

/* Uploads what the volumes scatter, updated by opaline_volume_light_update, which relights them on
   the CPU: 12 bytes a node and term, and for each sun as much a term of each of its points, which
   stand half as far apart; OPALINE_GL_REFUSED if the driver's textures hold no such number; and the
   colour of what they send out by themselves (fire), black with OPALINE_SHADE_WITHOUT_EMISSION.
   Until the first call they only absorb. The volume light must have been made for the handle of the
   asset that opaline_gl_create had; it is copied from. Nothing happens without volumes, or without
   OPALINE_GL_WITH_VOLUMES. */
OPALINE_API opaline_status opaline_gl_light_volumes(opaline_gl* gl,
                                                    const opaline_volume_light* volume_light);

/* What share/opaline/glsl/opaline_volumes.glsl reads, in GLSL 4.00 or ES 3.00 and later. Before it
   the host defines OPALINE_VOLUMES, OPALINE_VOLUME_TERMS and OPALINE_VOLUME_GLOW, the `count`,
   `terms` and `glows` below (without the last, volumes show no light of their own); a program costs
   registers and time to compile for each volume. Its functions take places as offsets from the eye
   of opaline_gl_look_from, in world directions [m], so that floats keep digits; `direction` and
   `to_eye` are unit vectors:

       OpalineSeen opaline_march_volumes(vec3 from, vec3 direction, float begin, float end)
           .radiance that volumes scatter and send out toward `from` and .transmittance of what lies
   behind, of the ray from begin >= 0 to end: as opaline_volumes_march with its usual options. An
   end of 1e30: a ray without end. A pixel shows radiance + transmittance * its color.
       OpalineVolumeSample opaline_sample_volumes(vec3 place, vec3 to_eye)
           .extinction [1/m] and .scattered radiance per metre, with what is sent out: as
           opaline_volumes_sample. */
typedef struct opaline_gl_volumes {
    size_t struct_size; /* in: sizeof(opaline_gl_volumes) */
    uint32_t count;     /* 0: there are none, or without the flag; then all names are 0 */
    uint32_t terms;
    uint32_t block; /* buffer of the uniform block OpalineVolumeRecords; the eye changes it, too */
    /* 2D textures of the usampler2D opaline_brick_numbers, opaline_density_codes and
       opaline_corner_numbers, and of the sampler2D opaline_node_light and opaline_phase_entries. */
    uint32_t brick_numbers, density_codes, corner_numbers, node_light, phase_entries;
    uint32_t glows;      /* 1: one of them sends out light by itself; else 0 */
    uint32_t glow_words; /* then 2D texture of the usampler2D opaline_glow_words; else 0 */
} opaline_gl_volumes;

/* Fills `volumes`, a struct_size of those before `glows` too. The names stay the library's and the
   same until the release. */
OPALINE_API opaline_status opaline_gl_get_volumes(const opaline_gl* gl,
                                                  opaline_gl_volumes* volumes);

/* --- Cloud layers ------------------------------------------------------------------------- */

/* Stratiform clouds above a ground, of what `opaline bake` makes from a layer; of several the first
   is shown. Functions of opaline_layer_light need no context, and run where those of lights do:
   one thread may update one while others use others. */
OPALINE_API uint32_t opaline_asset_layer_count(const opaline_asset* asset);

/* The layer at one time under one sky: at time 0 and black until the first update. It belongs to
   this handle of the asset, whose bytes it refers to. OPALINE_INVALID_ARGUMENT: there is no layer.
 */
typedef struct opaline_layer_light opaline_layer_light;
OPALINE_API opaline_status opaline_layer_light_create(const opaline_asset* asset,
                                                      opaline_layer_light** out);
/* NULL is fine. */
OPALINE_API void opaline_layer_light_release(opaline_layer_light* layer_light);

typedef struct opaline_layer_sun {
    float direction[3];   /* toward it, in the light's frame; any length */
    float angular_radius; /* [rad], 1e-6 ... pi/2 */
    float radiance[3];
} opaline_layer_sun;

typedef struct opaline_layer_sky {
    size_t struct_size; /* in: sizeof(opaline_layer_sky) */
    double time;        /* [s]: of the wind, and of layers with frames */
    /* Radiance of the sky, 3 * width * height floats as in opaline_light_set_lat_long, or with
       is_cubemap 1 and height 6 * width as in opaline_light_set_cubemap; NULL: black. Its two
       brightest small lights count as suns. */
    const float* map;
    uint32_t width, height, is_cubemap;
    uint32_t sun_count;
    const opaline_layer_sun* suns;
    const float* world_from_light; /* 9 floats as in opaline_light_set_rotation; NULL: unturned */
} opaline_layer_sky;

/* Lights layer and ground, on the CPU: tens to hundreds of ms. threads: 0 for all cores, 256 at
   most; the result has the same bits for any number. */
OPALINE_API opaline_status opaline_layer_light_update(opaline_layer_light* layer_light,
                                                      const opaline_asset* asset,
                                                      const opaline_layer_sky* sky,
                                                      uint32_t threads);

/* Lights a body at a point of the world [m] beneath, in or above the layer: replaces map, suns and
   rotation of `light`, of any asset, by what is seen from there of layer, ground and sky; the time
   of 32768 rays and of a map. Clouds' shadows within the body are not resolved, and the body
   darkens neither. Runs on the threads of the light. One writer. */
OPALINE_API opaline_status opaline_light_set_from_layer(opaline_light* light,
                                                        const opaline_asset* asset,
                                                        const opaline_layer_light* layer_light,
                                                        const float point[3]);

/* Uploads what the layer light holds, which is copied from: the layer itself the first time, its
   thickness where other frames are seen, else some hundred kB. */
OPALINE_API opaline_status opaline_gl_show_layer(opaline_gl* gl, const opaline_asset* asset,
                                                 const opaline_layer_light* layer_light);

/* What share/opaline/glsl/opaline_layer.glsl reads, in GLSL 3.30 or ES 3.00 and later. Before it
   the host defines OPALINE_LAYER_REPEAT, OPALINE_LAYER_MODES and OPALINE_LAYER_GLOW, `repeats`,
   `modes` and `glows` below. Places are offsets from the eye of opaline_gl_look_from in world
   directions [m], directions are unit vectors; `spread` is the angle of a pixel [rad], within which
   clouds and ground are averaged:

       OpalineSeenLayer opaline_layer_see(vec3 from, vec3 direction, float begin, float end,
                                          float spread)
           the layer along a ray to what ends it, or to 1e30: .radiance of its own, in its haze;
           .transmittance of what lies behind, .sun_transmittance of the discs of suns, .glow that
           is to be added to the sky, and its mean .distance.
       float opaline_layer_ground_distance(vec3 from, vec3 direction)
           to the layer's ground, 1e38 where it is not met.
       vec3 opaline_layer_ground_radiance(vec3 from, vec3 direction, float distance, float spread)
           of the ground there, under its clouds and in its haze.

   A pixel shows radiance + transmittance * (surface, ground, or sky without suns); rays that end in
   the sky also glow + sun_transmittance * suns. */
typedef struct opaline_gl_layer {
    size_t struct_size; /* in: sizeof(opaline_gl_layer) */
    uint32_t repeats, modes, glows;
    uint32_t block; /* buffer of the uniform block OpalineLayer; the eye changes it, too */
    /* 2D textures of the sampler2D opaline_layer_table_values, opaline_layer_sun_values,
       opaline_layer_thickness_values, opaline_layer_albedo_map, opaline_layer_ground_light and
       opaline_layer_base_light. */
    uint32_t table_values, sun_values, thickness_values, albedo_map, ground_light, base_light;
} opaline_gl_layer;

/* Fills `layer`; all 0 before the first opaline_gl_show_layer, then the same until the release. */
OPALINE_API opaline_status opaline_gl_get_layer(const opaline_gl* gl, opaline_gl_layer* layer);

#ifdef __cplusplus
}
#endif

#endif
