#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "formats/opal/added_vertices.h"
#include "formats/opal/preview_image.h"
#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "formats/sparse_grid.h"

namespace opaline::formats {

inline constexpr std::uint32_t kNone = 0xffffffffu;  ///< "no such index"
inline constexpr std::size_t kMaxVolumes = 16;       ///< of a scene

/// Angular distribution of light after one scattering event; int p dw = 1 over the sphere. All are
/// functions of the cosine between propagation directions.
struct PhaseFunction {
    enum class Type {
        isotropic,
        henyey_greenstein,
        rayleigh,
        gaussian,
        tabulated
    } type = Type::isotropic;
    float g = 0;          ///< henyey_greenstein: mean cosine, |g| <= 0.99; > 0: forward
    float rms_angle = 0;  ///< gaussian: root mean square angle [rad], in (0, 1]
    std::vector<float> cosine, value;  ///< tabulated: ascending from -1 to 1, p >= 0 [1/sr]
};

/// Veins through a solid: a colour as a function of the position alone (bake/scene/marble.h).
struct Marble {
    float scale = 0.04f;      ///< distance between veins [m], > 0
    std::vector<Rgb> colors;  ///< from within a vein to halfway between two; 2 or more, in [0, 1]
};

/// How a texture is looked up along one axis.
using TextureWrap = Wrap;

/// An image over the surface of a body that says what is inside: a point inside has the value of
/// the nearest point of the surface. Coordinates: Primitive::texcoord.
struct InnerTexture {
    std::uint32_t image = kNone;  ///< index into Scene::inner_images; none: 1 everywhere
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
};

/// How a medium differs from point to point inside its body: its scattering colour, which is what a
/// thick layer reflects of even light, is that of the stated coefficients times `marble`, `color`
/// and `strength`, and both coefficients are scaled by `density` (bake/scene/medium_field.h).
struct Variation {
    std::optional<Marble> marble = std::nullopt;
    InnerTexture color = {};     ///< red, green and blue as sRGB codes
    InnerTexture strength = {};  ///< alpha, linear codes
    InnerTexture density = {};   ///< red, linear codes; 0 counts as 1/255
    float g = 0;                 ///< in the relation of scattering colour and albedo, |g| < 1
};

/// A scattering medium that fills the closed surface of its material, homogeneous unless it has a
/// variation. SI units.
struct Medium {
    Rgb sigma_s, sigma_a;  ///< scattering, absorption [1/m], finite, >= 0, not all zero
    PhaseFunction phase;
    float eta = 1.3f;        ///< index of refraction relative to the outside, in [1/3, 3]
    float roughness = 0.2f;  ///< of the specular reflection at its surface, GGX, in [0, 1]
    float thickness = 0;     ///< [m]; > 0: fills no closed surface but a sheet so thick
    enum class Profile {
        automatic,
        classic,
        better,
        beams,
        normalized
    } profile = Profile::automatic;
    enum class Fidelity {
        physical,  ///< corrected formulas (formats/media/README.md, "Fidelity")
        paper      ///< [Wang2005] to the letter
    } fidelity = Fidelity::physical;
    /// None: homogeneous. Else automatic and physical, without a thickness.
    std::optional<Variation> variation = std::nullopt;
};

/// A surface that is lit and seen on both sides, such as a leaf, paper, a window pane or a
/// double-sided wall: of the light that arrives on one side, the
/// share base colour * reflect leaves on that side and base colour * transmit on the other one,
/// both diffusely. With the base colour the two shares of a band add up to 1 at most.
struct Sheet {
    Rgb reflect{1, 1, 1}, transmit{0, 0, 0};  ///< each in [0, 1]
    /// Thin glass: of the light that meets it, the share clear * T passes straight, T that of two
    /// smooth faces of index `eta` (opal/thin_glass.h). `reflect`, `transmit` and the gloss are of
    /// the rest.
    float clear = 0;   ///< in [0, 1]
    float eta = 1.5f;  ///< >= 1; or 0: infinite
    /// The material's base colour, sides and metallic factor without it, for what replaces it.
    Rgb opaque_color{1, 1, 1};
    bool opaque_double_sided = false;
    float opaque_metallic = 0;
};

/// What an opaque surface adds to its diffuse reflection: the metallic-roughness model of glTF 2.0
/// with KHR_materials_specular and KHR_materials_ior. Of a metal, the base colour is the
/// reflectance at normal incidence; of a dielectric that is F0 = min(((ior - 1)/(ior + 1))^2
/// specular_color, 1) specular, rising to `specular` at grazing. The default reflects diffusely
/// alone.
struct Gloss {
    float metallic = 0;           ///< in [0, 1]
    float roughness = 1;          ///< in [0, 1]; GGX alpha = roughness^2
    Rgb specular_color{1, 1, 1};  ///< >= 0, may exceed 1
    float specular = 0;           ///< in [0, 1]
    float ior = 1.5f;             ///< >= 1; or 0, for an infinite one: F0 before factors is 1
    std::uint32_t image = kNone;  ///< index into Scene::images; linear codes: green multiplies
                                  ///< roughness, blue metallic. Coordinates: Primitive::texcoord
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;  ///< of the image

    /// Nothing but diffuse reflection, whatever the image holds.
    bool is_diffuse() const { return metallic == 0 && specular == 0; }
};

/// Surface appearance, as the input formats mean it. Colours are linear Rec. 709.
struct Material {
    std::string name;
    Rgb base_color{1, 1, 1};                  ///< factor, each in [0,1]
    std::uint32_t base_color_image = kNone;   ///< index into Scene::images
    std::uint32_t base_color_texcoord = 0;    ///< texture coordinate set of both textures
    glm::mat3 base_color_uv_transform{1.0f};  ///< of both textures: KHR_texture_transform, applied
                                              ///< to (u, v, 1)
    using Wrap = TextureWrap;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;  ///< of the base colour
    Gloss gloss = {};                                   ///< of opaque materials: unused in a medium
    bool double_sided = false;
    Rgb emission{0, 0, 0};                 ///< radiance it sends out by itself [nit], finite, >= 0:
                                           ///< emissiveFactor * KHR_materials_emissive_strength
    std::uint32_t emission_image = kNone;  ///< index into Scene::images: multiplies `emission` by
                                           ///< sRGB codes. Coordinates: Primitive::texcoord
    Wrap emission_wrap_u = Wrap::repeat, emission_wrap_v = Wrap::repeat;  ///< of that image
    std::uint32_t normal_image = kNone;  ///< index into Scene::images: a normal map, linear codes
                                         ///< in the frame of Primitive::tangent
                                         ///< (opal/normal_maps.h). Coordinates: Primitive::texcoord
    float normal_scale = 1;              ///< of its x and y, finite
    Wrap normal_wrap_u = Wrap::repeat, normal_wrap_v = Wrap::repeat;  ///< of that image
    /// Coverage of the surface, of materials without a medium: alpha * Primitive::alpha * alpha of
    /// the base colour's image. mask: there is no surface where it is below alpha_cutoff; blend: it
    /// is there with that probability.
    enum class AlphaMode { opaque, mask, blend } alpha_mode = AlphaMode::opaque;
    float alpha = 1;                              ///< in [0, 1]
    float alpha_cutoff = 0.5f;                    ///< >= 0, of mask
    std::optional<Medium> medium = std::nullopt;  ///< translucent; none: opaque
    std::optional<Sheet> sheet = std::nullopt;    ///< thin-walled; no medium then
    std::optional<Marble> marble = std::nullopt;  ///< multiplies the base colour
    bool is_unstated_metal = false;  ///< a metal only because the file states neither a metallic
                                     ///< factor nor a roughness, and glTF's default is a metal
};

/// The largest share of light that an opaque material may reflect diffusely besides its base
/// colour: 1 - metallic; an image may make parts of a metal dielectric.
inline float diffuse_share(const Material& material) {
    return material.gloss.image == kNone ? 1 - material.gloss.metallic : 1.0f;
}

/// A metal throughout: it reflects nothing diffusely. Rows of its receivers hold what other
/// surfaces send to it, of which its lobe mirrors the mean where something blocks it
/// (runtime/surface.h).
inline bool is_metal(const Material& material) {
    return !material.medium && !material.gloss.is_diffuse() && diffuse_share(material) == 0;
}

/// A medium that fills no closed surface: smoke, fog, a cloud. Its extinction at a point is
/// density * sigma_t. Overlapping volumes add up.
struct Volume {
    std::string name;           ///< "volume 1 (smoke.vdb)", for messages
    SparseGrid<float> density;  ///< >= 0, of some unit; at least one voxel is > 0
    Rgb sigma_t{1, 1, 1};       ///< extinction [1/m] where the density is 1, finite, >= 0
    Rgb albedo{1, 1, 1};        ///< single-scattering albedo, in [0, 1]; where `scattering` is
                                ///< there, the largest of each band
    PhaseFunction phase;
    /// Light that it sends out by itself: radiance per metre [W m^-3 sr^-1], finite, >= 0, the same
    /// in all directions. On the voxels of `density`, whose to_scene holds; also where there is no
    /// density. Empty: it does not glow.
    SparseGrid<glm::vec3> emission = {};
    std::string emitter = {};  ///< name of that light, where there is any
    /// Where the albedo is not the same everywhere: density times albedo of each voxel, in bricks
    /// numbered as those of `density`, whose table and to_scene hold. Else empty.
    SparseGrid<glm::vec3> scattering = {};
    bool paper = false;  ///< fidelity "paper": pictures by path integration take [Premoze2003] as
                         ///< printed (formats/media/README.md)

    /// The albedo at a point in index coordinates: scattering and extinction are linear between
    /// voxels, so that voxels without density do not count. `albedo` where there is no density.
    glm::vec3 albedo_at(glm::vec3 index) const {
        const glm::vec3 largest(albedo.r, albedo.g, albedo.b);
        const float here = scattering.empty() ? 0.0f : density.sample(index);
        return here > 0 ? glm::min(scattering.sample(index) / here, largest) : largest;
    }
};

/// A stratiform cloud layer: droplets between the height `base` and `base` + thickness. Heights and
/// coordinates are the world's [m], whatever the scene's origin is.
struct CloudLayer {
    std::string name;                     ///< "layer 1 (layer.exr)", for messages
    std::uint32_t columns = 0, rows = 0;  ///< 2 or more
    /// [m], finite, >= 0; x fastest, rows toward +z; `frames` of them, one after another.
    std::vector<float> thickness;
    std::uint32_t frames = 1;        ///< 1 or more; the first one is of time 0
    double frame_seconds = 0;        ///< from one to the next, > 0; 0 of a single frame
    bool loops = false;              ///< the first frame follows on the last one
    double base = 1000;              ///< height of the flat lower side, above `ground`
    double ground = 0;               ///< height of the ground
    glm::dvec2 center{0};            ///< x, z
    glm::dvec2 size{20000};          ///< along x and z
    glm::dvec2 wind{0};              ///< [m/s] along x and z
    bool repeats = false;            ///< goes on beyond its size, over and over
    double visibility = 0;           ///< of the air: distance [m] where contrast is 5 %; 0: clear
    double droplets = 3e8;           ///< N0, per volume [1/m^3]
    double effective_radius = 7e-6;  ///< <r^3> / <r^2> [m]
    double gamma = 2;    ///< of the modified gamma distribution (bake/physics/mie/droplets.h)
    bool ice = false;    ///< spheres of ice instead of water
    bool paper = false;  ///< fidelity "paper": [Bouthors2006] as printed (formats/media/README.md)
    std::optional<double> peak_angle;  ///< theta_f [rad]; nothing: where the phase function bends
    std::uint32_t ground_columns = 1, ground_rows = 1;       ///< over `size`, rows toward +z
    std::vector<std::array<std::uint8_t, 4>> ground_albedo;  ///< sRGB codes, last byte 255
};

/// A light without a surface: KHR_lights_punctual. Radiance of the scene is in nits [cd/m^2], so
/// that intensities need no factor.
struct Light {
    enum class Type { point, spot, directional } type = Type::point;
    std::string name;               ///< of the node, else of the light; unique among emitters
    Rgb intensity{1, 1, 1};         ///< color * intensity, finite, >= 0: [cd] of point and spot,
                                    ///< illuminance [lx] of directional
    glm::vec3 position{0};          ///< [m] from Scene::origin; unused of directional
    glm::vec3 direction{0, -1, 0};  ///< unit, in which its light goes; unused of point
    float range = 0;                ///< [m], > 0; 0: endless. Beyond it there is no light, and
                                    ///< nearer it is dimmed (bake/scene/punctual_light.h)
    float inner_cone = 0;           ///< [rad] from the axis, of spot: all light within
    float outer_cone = 0.785f;      ///< [rad], inner_cone < outer_cone <= pi/2: none outside
};

/// Emitters that are switched, dimmed and coloured as one.
struct EmitterGroup {
    std::string name;                  ///< 1 to 255 bytes without control characters
    std::vector<std::string> members;  ///< names of emitters, none in two groups or twice
};

/// That a primitive repeats another one elsewhere: its arrays are empty, and stand for those of the
/// original with `offset` added to its positions.
struct CopyOf {
    std::uint32_t primitive = kNone;  ///< the original, which is no copy; kNone: it is none itself
    glm::vec3 offset{0};              ///< [m]
};

/// One glTF primitive of one node instance, in the scene's frame (Scene::origin) and metres.
/// Vertices keep the original order: receivers and output rows use this numbering. Where NORMAL is
/// missing and the faces of a vertex differ in their normals, copies of it follow on the last one;
/// `index` says which face has which (formats/gltf/README.md, "Missing normals").
struct Primitive {
    std::uint32_t node = 0, mesh = 0, primitive = 0;  ///< indices in the file, for messages
    std::string name;                                 ///< "node 'Vase' > mesh 3 > primitive 0"
    std::uint32_t material = 0;                       ///< index into Scene::materials, always valid
    std::vector<glm::vec3> position;                  ///< [m] from Scene::origin, finite
    std::vector<glm::vec3> normal;     ///< unit; one per vertex; {0,0,0} where none can be defined
    std::vector<glm::vec2> texcoord;   ///< of the textures, set 0 without any; transform
                                       ///< applied; empty or one per vertex
    std::vector<glm::vec4> tangent;    ///< of a normal map: unit, perpendicular to the normal,
                                       ///< toward growing u; w = 1, or -1 where the image is
                                       ///< mirrored; all 0 where none can be defined. Empty
                                       ///< without a map, else one per vertex
    std::vector<Rgb> color;            ///< COLOR_0, linear; empty or one per vertex
    std::vector<float> alpha;          ///< of COLOR_0; empty or one per vertex, in [0, 1]
    std::vector<std::uint32_t> index;  ///< triangles, 3 per triangle, each < position.size();
                                       ///< counter-clockwise seen from outside
    std::vector<AddedVertex> added;    ///< of the last vertices, so many (bake/refine); those
                                       ///< before them are the file's
    CopyOf copy = {};

    bool is_copy() const { return copy.primitive != kNone; }
};

/// Sum of the areas of its triangles [m^2].
inline double surface_area(const Primitive& primitive) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3) {
        const glm::dvec3 a = primitive.position[primitive.index[i]];
        const glm::dvec3 b = primitive.position[primitive.index[i + 1]];
        const glm::dvec3 c = primitive.position[primitive.index[i + 2]];
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

/// How large a scene is, all instances told apart: known before any of it is built.
struct SceneCounts {
    std::uint64_t primitives = 0, vertices = 0, indices = 0;
};

/// Everything the baker knows about its input. Plain values; links are indices.
struct Scene {
    std::vector<Primitive> primitives;  ///< scene nodes depth-first, then the mesh's primitives:
                                        ///< a primitive's position here is its running number
    std::vector<Material> materials;    ///< never empty
    std::vector<Volume> volumes;        ///< at most kMaxVolumes
    std::vector<CloudLayer> layers;     ///< at most formats::kMaxLayers (opal/clouds.h)
    std::vector<Light> lights;          ///< nodes depth-first
    std::vector<EmitterGroup> emitter_groups;
    /// World position [m] of the origin of the scene's frame: world = origin + position. The
    /// frame's axes are parallel to those of the world. All stages compute in the frame, so float
    /// precision does not depend on the distance between the scene and the world's origin.
    glm::dvec3 origin{0};
    std::vector<Image8> images;        ///< decoded textures that a material uses
    std::vector<Image8> inner_images;  ///< those of variations, which no file keeps
    std::string source;                ///< path as given by the user
    std::string sha256;                ///< of all input bytes, in reading order, lower-case hex
    std::vector<std::filesystem::path> inputs;  ///< files read, for dependency files

    /// World position [m] of a point given in the frame.
    glm::dvec3 to_world(glm::vec3 position) const { return origin + glm::dvec3(position); }
};

}  // namespace opaline::formats
