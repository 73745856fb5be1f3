/* Opaline: relights baked light transport. C99; needs no other header of the project.

   Rules: the caller owns every array; nothing prints, exits or throws. A function that fails
   returns a status other than OPALINE_OK, changes nothing it was given, and leaves an English
   sentence in opaline_last_error. Structs begin with struct_size, set by the caller to sizeof;
   those that arrays are made of do not, and never change. Enum values and functions are never
   changed or reused, only added. */
#ifndef OPALINE_H
#define OPALINE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define OPALINE_API __attribute__((visibility("default")))
#else
#define OPALINE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define OPALINE_VERSION \
    100 /* major * 10000 + minor * 100 + patch; the file's version is separate */

typedef struct opaline_asset opaline_asset;               /* immutable once loaded */
typedef struct opaline_light opaline_light;               /* distant light in one asset's basis */
typedef struct opaline_volume_light opaline_volume_light; /* what its volumes scatter of one */

typedef enum opaline_status {
    OPALINE_OK = 0,
    OPALINE_INVALID_ARGUMENT = 1,
    OPALINE_BAD_FILE = 2,   /* damaged, truncated, or not an Opaline asset */
    OPALINE_NEWER_FILE = 3, /* written by a later version: update the library */
    OPALINE_BUFFER_TOO_SMALL = 4,
    OPALINE_OUT_OF_MEMORY = 5,
    OPALINE_BUSY = 6, /* another thread changes the light, or reads the one to be changed */

    /* Of functions in opaline_gl.h. */
    OPALINE_GL_NO_CONTEXT = 16,    /* no OpenGL context is current on the calling thread */
    OPALINE_GL_TOO_OLD = 17,       /* the context lacks functions that are needed */
    OPALINE_GL_WRONG_CONTEXT = 18, /* another context is current than that of the handle */
    OPALINE_GL_CONTEXT_LOST = 19,  /* the driver was reset: release the handle, make another */
    OPALINE_GL_REFUSED = 20        /* the driver refuses a shader or a size */
} opaline_status;

/* Version of the library that is linked, as in OPALINE_VERSION. Any thread. */
OPALINE_API uint32_t opaline_version(void);

/* Name of a status, such as "bad file"; never NULL. Any thread. */
OPALINE_API const char* opaline_status_string(opaline_status status);

/* What went wrong in the last call that failed on this thread; never NULL, valid until the next
   failing call on this thread. Any thread. */
OPALINE_API const char* opaline_last_error(void);

/* A host's thread pool: `run` calls task(context, i) for each i < count, on any threads and in any
   order, and returns when all calls have. Functions that are allowed more than one thread then give
   it as many tasks and start no threads; results have the same bits. NULL: threads are started
   again. For the whole process, and not while another function runs. */
OPALINE_API void opaline_set_thread_pool(void (*run)(void* user, uint32_t count,
                                                     void (*task)(void* context, uint32_t index),
                                                     void* context),
                                         void* user);

/* --- Assets ------------------------------------------------------------------------------- */

/* Reads an asset in place: `bytes`, aligned to 64 (memory maps are), must stay unchanged until
   the asset is released; only compressed sections are copied. The whole file is checked once,
   checksums included, so untrusted input is safe. Any thread. */
OPALINE_API opaline_status opaline_asset_load(const void* bytes, size_t size, opaline_asset** out);

/* The same of a file, whose bytes the asset reads and keeps on the C++ heap until it is released.
   `path` is the system's; a file that is missing or cannot be read is OPALINE_BAD_FILE. Any
   thread. */
OPALINE_API opaline_status opaline_asset_load_path(const char* path, opaline_asset** out);

typedef enum opaline_load_flags {
    OPALINE_LOAD_DEFAULT = 0,
    /* The file is as the baker wrote it, and nobody else could write to it: neither checksums nor
       values are checked, and of offsets and indices only that sections lie inside the file and
       arrays inside their sections. A file that is damaged or hostile may then make any function
       read outside of its memory. Takes time for compressed sections alone. */
    OPALINE_LOAD_TRUSTED = 1
} opaline_load_flags;

typedef struct opaline_load_options {
    size_t struct_size; /* in: sizeof(opaline_load_options) */
    uint32_t flags;     /* of opaline_load_flags */
    /* Memory of the asset: the handle and decoded sections, which is all that grows with the file.
       Both NULL: the C++ heap, as for what lights hold and for what functions need while they run.
       `allocate` may return NULL: then loading fails with OPALINE_OUT_OF_MEMORY. `alignment` is a
       power of two, at most 64. Called by opaline_asset_load_with and opaline_asset_release on
       their thread, with `user`; must not throw. */
    void* (*allocate)(void* user, size_t size, size_t alignment);
    void (*release)(void* user, void* memory, size_t size, size_t alignment);
    void* user;
} opaline_load_options;

/* opaline_asset_load with options; NULL for none. Any thread. */
OPALINE_API opaline_status opaline_asset_load_with(const void* bytes, size_t size,
                                                   const opaline_load_options* options,
                                                   opaline_asset** out);

/* NULL is fine. No other thread may be using the asset; lights made for it stay valid. */
OPALINE_API void opaline_asset_release(opaline_asset* asset);

/* Receivers: the vertices of all primitives, in the order of the source mesh, and after those of
   each primitive what the baker added (opaline_primitive_mesh). 0 for NULL. Any thread,
   concurrently. */
OPALINE_API uint32_t opaline_asset_receiver_count(const opaline_asset* asset);

/* Side of the cube map that the light basis was made of. 0 for NULL. Any thread, concurrently. */
OPALINE_API uint32_t opaline_asset_cubemap_size(const opaline_asset* asset);

/* Primitives, one per primitive of the source file and node instance. 0 for NULL.
   Any thread, concurrently. */
OPALINE_API uint32_t opaline_asset_primitive_count(const opaline_asset* asset);

typedef struct opaline_primitive_info {
    size_t struct_size;                       /* in: sizeof(opaline_primitive_info) */
    uint32_t node, mesh, primitive, material; /* indices in the source file */
    uint32_t first_receiver, receiver_count;  /* receiver first_receiver + v is vertex v */
    uint32_t bands;                           /* 1: grey transport, 3: RGB */
    uint32_t double_sided;                    /* 0 or 1 */
} opaline_primitive_info;

/* Fills `info`. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_primitive(const opaline_asset* asset, uint32_t index,
                                                   opaline_primitive_info* info);

typedef enum opaline_shading {
    OPALINE_SHADING_DIFFUSE = 1,     /* opaque: without gloss the same from everywhere */
    OPALINE_SHADING_TRANSLUCENT = 2, /* depends on the eye: Fresnel, and directions inside */
    OPALINE_SHADING_SHEET = 3        /* thin-walled: depends on the side that the eye is on */
} opaline_shading;

typedef struct opaline_primitive_shading {
    size_t struct_size; /* in: sizeof(opaline_primitive_shading) */
    uint32_t shading;   /* an opaline_shading */
    uint32_t terms;     /* transport vectors per receiver; cost goes with them */
    float eta;          /* translucent: index of refraction relative to outside; else 0 */
} opaline_primitive_shading;

/* Fills `shading`. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_primitive_shading(const opaline_asset* asset,
                                                           uint32_t index,
                                                           opaline_primitive_shading* shading);

/* Where a vertex that the baker added lies: at weight[0] of the way from corner[0] to corner[1] and
   weight[1] of that to corner[2], vertices of the same primitive that the source mesh has. */
typedef struct opaline_added_vertex {
    uint32_t corner[3];
    float weight[2]; /* barycentric, of corner[1] and corner[2]; their sum is at most 1 */
} opaline_added_vertex;

/* A primitive's mesh as it was baked: of receiver_count vertices (opaline_primitive_info). The
   baker adds vertices where the light changes between those of the source mesh, and divides
   triangles there, so that values interpolate to shadows. A host draws this mesh, or its own one
   with the values of the first vertices, which are its own, and without these shadows; or it
   divides its own triangles as `added` says. Pointers are valid while the asset is. */
typedef struct opaline_primitive_mesh {
    size_t struct_size;      /* in: sizeof(opaline_primitive_mesh) */
    const float* position;   /* [m], world: 3 a vertex */
    const float* normal;     /* unit, or zero where the source has none: 3 a vertex */
    const float* base_color; /* linear, without the texture: 3 a vertex */
    const float* texcoord;   /* 2 a vertex; NULL: the asset has none */
    const uint32_t* index;   /* 3 a triangle, counted from the primitive's first vertex */
    uint32_t index_count;
    uint32_t added_count; /* vertices at the end that the source mesh does not have */
    const opaline_added_vertex* added;
} opaline_primitive_mesh;

/* Fills `mesh`. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_primitive_mesh(const opaline_asset* asset, uint32_t index,
                                                        opaline_primitive_mesh* mesh);

/* Emitters: lamps that are part of the asset, each baked by itself, so that they are switched,
   dimmed and coloured (opaline_light_set_emitter) without another bake. 0 for NULL, and where none
   was baked. Any thread, concurrently. */
OPALINE_API uint32_t opaline_asset_emitter_count(const opaline_asset* asset);

typedef struct opaline_emitter_info {
    size_t struct_size; /* in: sizeof(opaline_emitter_info) */
    char name[256]; /* of the node, light or group: UTF-8, not empty, no two alike, ends with 0 */
} opaline_emitter_info;

/* Fills `info`. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_emitter(const opaline_asset* asset, uint32_t index,
                                                 opaline_emitter_info* info);

#define OPALINE_NO_EMITTER 0xffffffffu

typedef struct opaline_primitive_emission {
    size_t struct_size; /* in: sizeof(opaline_primitive_emission) */
    uint32_t emitter;   /* that it is part of, or OPALINE_NO_EMITTER */
    float radiance[3];  /* [W m^-2 sr^-1], or nits where the source has them, that its surface sends
                           out by itself, before its emissive texture and the emitter's colour */
} opaline_primitive_emission;

/* Fills `emission`: for hosts that draw emissive textures themselves. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_primitive_emission(const opaline_asset* asset,
                                                            uint32_t index,
                                                            opaline_primitive_emission* emission);

/* --- Lights ------------------------------------------------------------------------------- */

/* A light starts black: no map, no suns, no rotation. Functions that change a light project it on
   the basis at once. What a change costs on two cores, basis of 6 x 32 x 32 (measured on one:
   tests/bench/RESULTS.md): a turn 2 ms (opaline_light_turn) or 14 ms (opaline_light_set_rotation),
   a map of 1024 x 512 20 ms, a sun less than one. For assets with glossy surfaces another map or
   sun is also blurred to their roughnesses: 5 to 25 ms for opaque and rough ones, 50 to 70 ms for
   mirrors.
   One thread at a time may change a light ("one writer"), and none may read it meanwhile. Nothing
   waits or races: a call that comes while another thread changes the light, or that would change it
   while others read it, returns OPALINE_BUSY and does nothing. Different lights are independent:
   each can be changed while others are read. A light outlives its asset. */
OPALINE_API opaline_status opaline_light_create(const opaline_asset* asset, opaline_light** out);

/* NULL is fine. No other thread may be using the light. */
OPALINE_API void opaline_light_release(opaline_light* light);

/* How many threads the functions below may start, 1 (default: none) to 256, or 0: one per core.
   The result has the same bits for any number. One writer. */
OPALINE_API opaline_status opaline_light_set_threads(opaline_light* light, uint32_t threads);

/* The light's axes in the world: nine floats, three columns of a rotation matrix, the images of
   +X, +Y and +Z (column-major, as in OpenGL). Orthonormal to 1e-3, determinant +1. Turns map and
   suns. One writer. */
OPALINE_API opaline_status opaline_light_set_rotation(opaline_light* light,
                                                      const float world_from_light[9]);

/* The same for a light that turns from frame to frame: its map is sampled at a tenth of the points,
   which errs by about a percent of the light at most (root mean square over coefficients, where it
   has sharp edges: tests/bench/RESULTS.md; suns, harmonics and quarter turns of cube maps are
   exact). Call opaline_light_set_rotation once the light rests. On one thread it never allocates.
   One writer. */
OPALINE_API opaline_status opaline_light_turn(opaline_light* light,
                                              const float world_from_light[9]);

/* Linear Rec. 709 radiance [W m^-2 sr^-1], 3 * 6 * size * size floats: faces +X -X +Y -Y +Z -Z,
   rows and columns oriented as OpenGL cube maps. Finite, not negative; size 1 ... 8192. Replaces
   the map or what stands for it; the values are copied. One writer. */
OPALINE_API opaline_status opaline_light_set_cubemap(opaline_light* light, const float* rgb,
                                                     uint32_t size);

/* The same from a latitude-longitude map, 3 * width * height floats, row 0 up, +X in the centre of
   the image, +Z to its right. width and height 1 ... 32768. One writer. */
OPALINE_API opaline_status opaline_light_set_lat_long(opaline_light* light, const float* rgb,
                                                      uint32_t width, uint32_t height);

/* Replaces the map by spherical harmonics: radiance sum_k c_k Y_k(w) [W m^-2 sr^-1] from direction
   w = (x, y, z) of the light's axes, c_k = rgb[3 k .. 3 k + 2], any finite values. Real,
   orthonormal, no Condon-Shortley sign, sorted by degree and order as engines have them:
       Y_0 = 0.282095                                Y_1, Y_2, Y_3 = 0.488603 * (y, z, x)
       Y_4, Y_5, Y_7 = 1.092548 * (x y, y z, x z)    Y_6 = 0.315392 * (3 z z - 1)
       Y_8 = 0.546274 * (x x - y y)
   These are of radiance. Where an engine stores irradiance, divide its coefficients of degrees 0, 1
   and 2 by pi, 2 pi / 3 and pi / 4. Negative radiance counts, but is not mirrored. One writer. */
OPALINE_API opaline_status opaline_light_set_harmonics(opaline_light* light, const float rgb[27]);

/* Replaces the map by coefficients of the asset's own basis, as opaline_light_get_coefficients
   gives them and in the order of formats/README.md ("Haar"): three floats each, any finite values,
   `count` floats, 18 * size * size for a cube map of that size. They describe the light unturned:
   with a rotation they are resampled as a cube map of mean radiance. Negative radiance counts, but
   is not mirrored. One writer. */
OPALINE_API opaline_status opaline_light_set_coefficients(opaline_light* light, const float* rgb,
                                                          size_t count);

/* The light vector: coefficients of the turned map and of suns [W m^-2], 18 * size * size floats.
   Emitters are not part of it. Any thread, concurrently. */
OPALINE_API opaline_status opaline_light_get_coefficients(const opaline_light* light,
                                                          float* out_rgb, size_t out_count);

/* Adds a disc at infinity: direction toward it (any length but 0), radius [rad] from
   1e-6 to below pi/2,
   radiance [W m^-2 sr^-1]. Irradiance facing it is about pi * radius^2 * radiance. One writer. */
OPALINE_API opaline_status opaline_light_add_sun(opaline_light* light, const float direction[3],
                                                 float angular_radius, const float radiance[3]);

/* Changes the sun that the call of opaline_light_add_sun number `index` added, counted from 0 since
   the light was created or cleared. Costs as much as adding one. One writer. */
OPALINE_API opaline_status opaline_light_set_sun(opaline_light* light, uint32_t index,
                                                 const float direction[3], float angular_radius,
                                                 const float radiance[3]);

/* Multiplies the light of an emitter, as authored, by three factors, finite and not negative: 0, 0,
   0 switches it off. Each is 1, 1, 1 in a new light. Costs nothing. One writer. */
OPALINE_API opaline_status opaline_light_set_emitter(opaline_light* light, uint32_t index,
                                                     const float color[3]);

/* Back to black; keeps the rotation, the number of threads and emitters' colours. One writer. */
OPALINE_API opaline_status opaline_light_clear(opaline_light* light);

/* --- Shading ------------------------------------------------------------------------------ */

typedef enum opaline_shade_flags {
    OPALINE_SHADE_DEFAULT = 0,
    OPALINE_SHADE_WITHOUT_BASE_COLOR = 1, /* as if white: multiply by your own texture per pixel */
    /* Translucent receivers without their Fresnel factor, which falls steeply toward the
       silhouette: interpolate, multiply per pixel by 1 - F(normal . to eye; eta), clamp at 0. These
       values alone may be negative. Opaque receivers without the factor that gloss puts before
       their diffuse part, which depends on roughness and view. No specular reflection, which
       changes as fast. */
    OPALINE_SHADE_WITHOUT_FRESNEL = 2,
    /* Components left out. An asset that was not baked with separate terms holds multiple and
       single scattering as one: leave out both or none. */
    OPALINE_SHADE_WITHOUT_MULTIPLE = 4,  /* scattered often, in a translucent body or a volume */
    OPALINE_SHADE_WITHOUT_SINGLE = 8,    /* scattered once */
    OPALINE_SHADE_WITHOUT_SPECULAR = 16, /* mirrored by glossy surfaces, translucent or opaque */
    OPALINE_SHADE_WITHOUT_DIFFUSE = 32,  /* by opaque surfaces; by thin-walled ones, both ways */
    /* What surfaces and volumes of emitters send out by themselves; their light on other surfaces
       stays. Never added where WITHOUT_BASE_COLOR or WITHOUT_FRESNEL is set. */
    OPALINE_SHADE_WITHOUT_EMISSION = 64
} opaline_shade_flags;

/* out_rgb[3 i .. 3 i + 2]: outgoing radiance [W m^-2 sr^-1] of receiver i, finite and not
   negative. Translucent receivers are seen along their own normals; see opaline_shade_from.
   `out_count` floats, at least 3 * receiver_count. The light must have been made for an asset of
   the same cube map size and number of emitters and, where it is glossy, the same roughnesses.
   `flags` is a sum of opaline_shade_flags. Runs on the calling thread, never allocates, costs in
   proportion to the stored coefficients, with gloss some microseconds a glossy opaque receiver
   more. Any thread, concurrently; the light must not change meanwhile. */
OPALINE_API opaline_status opaline_shade(const opaline_asset* asset, const opaline_light* light,
                                         uint32_t flags, float* out_rgb, size_t out_count);

/* The same for receivers first ... first + count - 1, written to out_rgb[0 ... 3 count - 1]: give
   each of your threads a range of its own. */
OPALINE_API opaline_status opaline_shade_range(const opaline_asset* asset,
                                               const opaline_light* light, uint32_t flags,
                                               uint32_t first, uint32_t count, float* out_rgb,
                                               size_t out_count);

/* The same as opaline_shade_range, seen from the point `eye`: three finite floats [m], in world
   space as the mesh is. NULL: each receiver along its own normal. Only translucent, thin-walled and
   glossy receivers look different. Translucent ones that face away are black unless their primitive
   is double-sided, but for a rim of specular reflection that fades just behind the silhouette;
   thin-walled ones show the side that the eye is on. */
OPALINE_API opaline_status opaline_shade_from(const opaline_asset* asset,
                                              const opaline_light* light, uint32_t flags,
                                              const float eye[3], uint32_t first, uint32_t count,
                                              float* out_rgb, size_t out_count);

/* --- Volumes ------------------------------------------------------------------------------ */

/* Smoke and clouds. Relight them once for each light, then march as many rays as are needed: the
   eye may move freely. An asset may have volumes and no receivers. Radiance is linear Rec. 709
   [W m^-2 sr^-1], lengths are metres in the world, as the mesh is. */

/* 0 for NULL. Any thread, concurrently. */
OPALINE_API uint32_t opaline_asset_volume_count(const opaline_asset* asset);

typedef struct opaline_volume_info {
    size_t struct_size;  /* in: sizeof(opaline_volume_info) */
    float corner[8][3];  /* [m] of the smallest box around density and light of its own, turned and
                            sheared as the volume is: corner x + 2 y + 4 z, x, y and z 0 or 1; all
                            0: neither is there */
    uint32_t bricks;     /* of 8 x 8 x 8 voxels of density */
    uint32_t nodes;      /* points at which light is known */
    uint32_t node_terms; /* dot products per node when it is relit; up to 8 more where the
                            phase function is sharp and the light has small bright parts */
    uint32_t bands;      /* 1: grey transport, 3: RGB */
} opaline_volume_info;

/* Fills `info`; reads all density of the volume. Any thread, concurrently. */
OPALINE_API opaline_status opaline_asset_volume(const opaline_asset* asset, uint32_t index,
                                                opaline_volume_info* info);

/* A volume light starts black: volumes absorb and scatter nothing. It belongs to this handle of the
   asset, and to no other one even of the same file. One thread at a time may update it, and none
   may read it meanwhile; different ones are independent. */
OPALINE_API opaline_status opaline_volume_light_create(const opaline_asset* asset,
                                                       opaline_volume_light** out);

/* NULL is fine, and so is an asset that is released already. No other thread may be using the
   volume light. */
OPALINE_API void opaline_volume_light_release(opaline_volume_light* volume_light);

/* Relights every node: `light`, made for an asset of the same cube map size, is copied from and may
   change afterwards. `flags`: OPALINE_SHADE_DEFAULT, or OPALINE_SHADE_WITHOUT_SINGLE or
   _WITHOUT_MULTIPLE, which every volume can show apart, or _WITHOUT_EMISSION: what volumes that are
   emitters send straight to the eye is left out; what they scatter of it stays. Costs nodes times
   node_terms dot products and, for each sun that volumes which scatter forward meet, a march
   through the density from points half as far apart as nodes, for which the volume light keeps 12
   to 36 bytes each; on up to `threads` threads, 1 to 256, or 0: one per core; the result has the
   same bits for any number. One writer; the light must not change meanwhile. */
OPALINE_API opaline_status opaline_volume_light_update(opaline_volume_light* volume_light,
                                                       const opaline_asset* asset,
                                                       const opaline_light* light, uint32_t flags,
                                                       uint32_t threads);

typedef struct opaline_march_ray {
    float origin[3];    /* finite [m] */
    float direction[3]; /* finite, any length but 0 */
    float begin;        /* distance from the origin [m], finite, not negative */
    float end;          /* [m], may be INFINITY; up to `begin` or before it nothing is met */
} opaline_march_ray;

typedef struct opaline_march_result {
    float radiance[3];      /* what the volumes scatter and send out toward the origin */
    float transmittance[3]; /* the share of light from behind `end` that comes through */
} opaline_march_result;

typedef struct opaline_march_options {
    size_t struct_size;        /* in: sizeof(opaline_march_options) */
    float step;                /* longest step, in voxels, 1/64 ... 8; without options 0.5 */
    float least_transmittance; /* in [0, 1): once all bands are below, nothing comes through;
                                  without options 1e-3 */
    uint32_t threads;          /* as for updates, but without options 1: none is started */
} opaline_march_options;

/* What all volumes together add to each ray and leave of the light behind it: a pixel shows
   radiance + transmittance * (radiance of the surface at `end`, or of the sky). results[i] is of
   rays[i], finite and not negative. `options` may be NULL. Allocates; costs in proportion to the
   steps within bricks of density. Any thread, concurrently; the volume light must not be updated
   meanwhile. */
OPALINE_API opaline_status opaline_volumes_march(const opaline_asset* asset,
                                                 const opaline_volume_light* volume_light,
                                                 const opaline_march_options* options,
                                                 const opaline_march_ray* rays, uint32_t count,
                                                 opaline_march_result* results);

typedef struct opaline_sample_point {
    float position[3]; /* finite [m] */
    float to_eye[3];   /* from the position toward the eye: finite, any length but 0 */
} opaline_sample_point;

typedef struct opaline_sample_result {
    float extinction[3]; /* sigma_t [1/m] */
    float scattered[3];  /* radiance toward the eye added per metre [W m^-3 sr^-1], own light too */
} opaline_sample_result;

/* The integrands of opaline_volumes_march, for hosts that march by themselves or fill a grid in
   front of the camera: along a ray dL/dt = -extinction L + scattered, t toward the eye. results[i]
   is of points[i], all volumes added up, finite and not negative. Runs on the calling thread and
   never allocates: give each of your threads points of its own. Any thread, concurrently; the
   volume light must not be updated meanwhile. */
OPALINE_API opaline_status opaline_volumes_sample(const opaline_asset* asset,
                                                  const opaline_volume_light* volume_light,
                                                  const opaline_sample_point* points,
                                                  uint32_t count, opaline_sample_result* results);

#ifdef __cplusplus
}
#endif

#endif
