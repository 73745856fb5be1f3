#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "tests/support/sky_maps.h"

namespace opaline::test {

/// Mesh of one primitive, before it is put into an asset.
struct TestMesh {
    std::vector<formats::Vec3> position, normal;
    std::vector<formats::Rgb> base_color;
    std::vector<formats::Float2> texcoord;
    std::vector<std::uint32_t> index;
};

/// Latitude-longitude sphere; base colour red at the top, blue at the bottom.
TestMesh make_sphere(formats::Vec3 centre, float radius, std::uint32_t slices,
                     std::uint32_t stacks);

/// Rectangle centre + s a + t b for s, t in [-1, 1], cells x cells quads; texcoord 0 to `repeats`.
TestMesh make_sheet(formats::Vec3 centre, formats::Vec3 a, formats::Vec3 b, std::uint32_t cells,
                    float repeats);

/// How a mesh becomes a primitive.
struct TestPrimitive {
    std::uint32_t bands = 1;
    std::uint32_t details = 64;  ///< largest wavelet details kept of each row
    std::uint32_t image = formats::kNoImage;
    formats::Wrap wrap_u = formats::Wrap::repeat, wrap_v = formats::Wrap::repeat;
    float eta = 0;  ///< above 0: translucent, with `terms` rows a vertex
    std::uint32_t terms = 1;
    bool is_double_sided = false;
    bool is_separate = false;  ///< translucent: PrimitiveRecord::kSeparate
    bool is_sheet = false;     ///< thin-walled: two rows a vertex
};

/// Empty asset over a cube map of n x n texels.
formats::Asset make_asset(std::uint32_t n, std::uint32_t code_bits);

/// Adds a primitive whose rows are those of an unoccluded surface, max(0, n.w) / pi; with three
/// bands, green and blue see a wider and a narrower lobe. Further rows of a translucent vertex are
/// of the same kind about tilted normals and of either sign, but for the first of single scattering
/// in rows of its own.
void add_primitive(formats::Asset& asset, const TestMesh& mesh, const TestPrimitive& options);

/// Adds a primitive without transport details or averages: for tests that bring own radiance.
void add_bare_primitive(formats::Asset& asset, const TestMesh& mesh);

/// Gives a primitive a normal map. Tangents: `along` without its part along the vertex's normal,
/// and `sign`, 0 for none.
void add_normal_map(formats::Asset& asset, formats::NormalMapRecord map, formats::Vec3 along,
                    float sign);

/// A normal map with one normal everywhere; unit, z > 0.
formats::PreviewImageData make_even_normals(formats::Vec3 normal);
/// The normal that its codes stand for, unit.
formats::Vec3 coded_normal(const formats::PreviewImageData& even);

/// Colourful noise, so that a mirrored or shifted image shows.
formats::PreviewImageData make_noise_image(std::uint32_t width, std::uint32_t height);

/// A smooth sky with a warm light from +X and a cool one from behind, different everywhere.
formats::Rgb two_lights(formats::Vec3 direction);

}  // namespace opaline::test
