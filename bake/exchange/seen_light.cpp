#include "bake/exchange/seen_light.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/scatterers.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// Radiance of a node in one of `bands` bands, in cells.
std::vector<float> cells_of(const BounceLight& light, std::span<const float> row, std::size_t band,
                            std::size_t bands, std::uint32_t n) {
    const std::uint32_t m = light.cubemap_size;
    const std::size_t texels = formats::cubemap_texels(m);
    std::vector<float> own(texels);
    if (bands == 1 && light.bands == 3) {
        for (std::size_t t = 0; t < texels; ++t) {
            own[t] = formats::luminance({row[t], row[texels + t], row[2 * texels + t]});
        }
    } else {
        std::ranges::copy(row.subspan(light.bands == 1 ? 0 : band * texels, texels), own.begin());
    }
    haar_inverse_cube(own, m);
    std::ranges::for_each(own, [](float& v) { v *= std::numbers::inv_pi_v<float>; });
    if (n <= m) return reduce_cells(own, m, n);
    std::vector<float> fine(formats::cubemap_texels(n));
    for (std::size_t i = 0; i < fine.size(); ++i) {
        fine[i] = own[coarser_texel(i, n, m)];
    }
    return fine;
}

// B of a leaf with what a narrow lobe mirrors there as if diffuse: rays of volumes do not follow
// it.
std::vector<float> sent_to_all_sides(const BounceLight& light, std::uint32_t leaf) {
    std::vector<float> row = light.tree.rows().row(leaf);
    const std::uint32_t irradiance = light.tree.irradiance_node(leaf);
    if (irradiance == formats::kNone) return row;
    const formats::Rgb& c =
        light.transfer.scatterers[light.tree.scatterer_of(leaf)].albedo.mirrored;
    const BandColour mirrored = in_bands({c.r, c.g, c.b}, light.bands);
    const std::size_t plane = row.size() / light.bands;
    for (std::size_t b = 0; b < light.bands; ++b) {
        light.tree.rows().add_part(irradiance, b * plane, mirrored[b],
                                   std::span(row).subspan(b * plane, plane));
    }
    return row;
}

}  // namespace

SeenLight see_surfaces(const BounceLight& light, const DensitySpace& space, const LightCells& cells,
                       std::size_t bands, const Context& context) {
    constexpr std::size_t kSeenAtOnce = 16;
    const std::vector<std::uint32_t> leaves = light.tree.leaves();
    SeenLight seen{light, bands, CodedRows(leaves.size() * bands, cells.size())};
    for_each_block_in_order(
        leaves.size(), kSeenAtOnce, context,
        [&](Range range) {
            std::vector<float> through(space.extinction_bands() * cells.size());
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const std::uint32_t node = leaves[i];
                gather_transmittance(space, cells, light.tree.centre(node), through);
                const std::vector<float> sent = sent_to_all_sides(light, node);
                for (std::size_t band = 0; band < bands; ++band) {
                    std::vector<float> row = cells_of(light, sent, band, bands, cells.n);
                    const std::size_t own = space.is_grey ? 0 : band * cells.size();
                    for (std::size_t k = 0; k < row.size(); ++k) {
                        row[k] *= through[own + k];
                    }
                    seen.rows.set(light.tree.scatterer_of(node) * bands + band, row);
                }
            }
            return true;
        },
        [&](Range range, bool) {
            if (context.on_progress) {
                context.on_progress({"surfaces that volumes see", range.end, leaves.size()});
            }
        });
    return seen;
}

void add_seen(const SeenLight& seen, const MetPlace& met, const std::array<float, 3>& weight,
              std::size_t first, std::size_t end, std::span<float> sum) {
    const formats::Material& material = seen.light.scene.materials[met.material];
    const SeenSide side = side_of(material, met.normal, met.cosine);
    if (!side.is_seen) return;
    const std::uint32_t node =
        seen.light.tree.find(met.position, {met.material, side.behind, side.normal}, 0);
    if (node == formats::kNone) return;
    const std::size_t row = seen.light.tree.scatterer_of(node) * seen.bands;
    const std::size_t cells = seen.rows.size();
    for (std::size_t band = first; band < end; ++band) {
        seen.rows.add(row + band, weight[band], sum.subspan(band * cells, cells));
    }
}

}  // namespace opaline::bake
