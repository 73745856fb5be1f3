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

/* --- Assets ------------------------------------------------------------------------------- */

/* Reads an asset in place: `bytes`, aligned to 64 (memory maps are), must stay unchanged until
   the asset is released; only compressed sections are copied. The whole file is checked once,
   checksums included, so untrusted input is safe. Any thread. */
OPALINE_API opaline_status opaline_asset_load(const void* bytes, size_t size, opaline_asset** out);

/* NULL is fine. No other thread may be using the asset; lights made for it stay valid. */
OPALINE_API void opaline_asset_release(opaline_asset* asset);

/* Receivers: the vertices of all primitives, in the order of the source mesh. 0 for NULL.
   Any thread, concurrently. */
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
   the basis at once, which takes time in proportion to map and basis: set the rotation before the
   map to pay once. For assets with glossy surfaces it is also blurred to their roughnesses, which
   takes some tenths of a second more (seconds for mirrors), whenever map or suns change. One thread
   at a time may change a light, and none may read it meanwhile; different lights are independent.
 */
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

/* Linear Rec. 709 radiance [W m^-2 sr^-1], 3 * 6 * size * size floats: faces +X -X +Y -Y +Z -Z,
   rows and columns oriented as OpenGL cube maps. Finite, not negative; size 1 ... 8192. Replaces
   the map; the values are copied. One writer. */
OPALINE_API opaline_status opaline_light_set_cubemap(opaline_light* light, const float* rgb,
                                                     uint32_t size);

/* The same from a latitude-longitude map, 3 * width * height floats, row 0 up, +X in the centre of
   the image, +Z to its right. width and height 1 ... 32768. One writer. */
OPALINE_API opaline_status opaline_light_set_lat_long(opaline_light* light, const float* rgb,
                                                      uint32_t width, uint32_t height);

/* Adds a disc at infinity: direction toward it (any length but 0), radius [rad] from
   1e-6 to below pi/2,
   radiance [W m^-2 sr^-1]. Irradiance facing it is about pi * radius^2 * radiance. One writer. */
OPALINE_API opaline_status opaline_light_add_sun(opaline_light* light, const float direction[3],
                                                 float angular_radius, const float radiance[3]);

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
    /* What surfaces of emitters send out by themselves; their light on other surfaces stays. Never
       added where WITHOUT_BASE_COLOR or WITHOUT_FRESNEL is set. */
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
    float corner[8][3];  /* [m] of the smallest box around the density, turned and sheared as the
                            volume is: corner x + 2 y + 4 z, x, y and z 0 or 1; all 0: no density */
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
   _WITHOUT_MULTIPLE, which every volume can show apart. Costs nodes times node_terms dot products
   on up to `threads` threads, 1 to 256, or 0: one per core; the result has the same bits for any
   number. One writer; the light must not change meanwhile. */
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
    float radiance[3];      /* what the volumes scatter toward the origin */
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
    float scattered[3];  /* radiance toward the eye added per metre [W m^-3 sr^-1] */
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
