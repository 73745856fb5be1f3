#include "bake/volumes/seen_surfaces.h"

#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/plan/medium_exitance.h"
#include "bake/plan/surface_albedo.h"
#include "bake/transport/density/attenuation.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kSeenAtOnce = 16;  // vertices that a thread takes at once

// Factors of a vertex's rows in the exitance of one of its sides, without the base colour.
std::vector<float> weigh_rows(const ShownSurfaces& shown, const formats::PrimitiveRecord& record,
                              std::size_t primitive, std::size_t vertex, std::size_t side) {
    std::vector<float> weight(record.terms);
    if (record.shading != formats::Shading::translucent) {
        weight[side] = 1;
        return weight;
    }
    const glm::vec3 normal = shown.receivers[primitive].inside[vertex].normal;
    if (normal == glm::vec3(0)) return weight;
    weight = weigh_rows_of_medium(shown.layouts[shown.scene.primitives[primitive].material],
                                  record.eta, normal);
    for (float& w : weight) {
        w *= std::numbers::inv_pi_v<float>;  // radiosity to radiance
    }
    return weight;
}

std::size_t count_sides(const formats::PrimitiveRecord& record) {
    return record.shading == formats::Shading::sheet ? 2 : 1;
}

// A row as weighed, in cells.
std::vector<float> read_cells(const formats::SparseRowsView& rows, const formats::RowRange& range,
                              std::span<const float> weight, std::size_t vertex, std::uint32_t band,
                              std::uint32_t cells) {
    const std::uint32_t n = rows.cubemap_size;
    std::vector<float> sum(formats::cubemap_texels(n)), row(sum.size());
    for (std::uint32_t k = 0; k < weight.size(); ++k) {
        if (weight[k] == 0) continue;
        formats::decode_row(rows, range, static_cast<std::uint32_t>(vertex * weight.size()) + k,
                            band, row);
        for (std::size_t i = 0; i < row.size(); ++i) {
            sum[i] += weight[k] * row[i];
        }
    }
    haar_inverse_cube(sum, n);
    return reduce_cells(sum, n, cells);
}

// Whether a side that a walk meets has a row; `normal`: of the vertex.
bool is_seen(const formats::Material& material, bool behind, float along_normal) {
    if (material.sheet) return true;
    // Triangles of double-sided surfaces may be wound against their normals.
    return material.double_sided && !material.medium ? along_normal < 0 : !behind;
}

// What a row is multiplied by for the light that arrives, of which a lobe mirrors its share. Rows
// of a thin wall hold shares of the light of both sides, which are taken to be alike.
float share_of_rows(const formats::Material& material) {
    if (!material.sheet) return 1;
    const float both = formats::luminance(material.sheet->reflect + material.sheet->transmit);
    return both > 0 ? 1 / both : 0;
}

}  // namespace

double seen_surfaces_bytes(const ShownSurfaces& shown, std::size_t bands, std::size_t cells) {
    double sides = 0;
    for (const formats::PrimitiveRecord& record : shown.asset.primitives) {
        sides +=
            static_cast<double>(record.vertex_count) * static_cast<double>(count_sides(record));
    }
    return sizeof(std::int16_t) * sides * static_cast<double>(bands) * static_cast<double>(cells);
}

SeenSurfaces find_seen_surfaces(const ShownSurfaces& shown, const DensitySpace& space,
                                const LightCells& cells, std::size_t bands,
                                const Context& context) {
    SeenSurfaces seen{shown.scene, shown.layouts, bands, {}, {}};
    std::size_t count = 0, done = 0;
    for (const formats::PrimitiveRecord& record : shown.asset.primitives) {
        seen.primitive.push_back({count, count_sides(record)});
        count += record.vertex_count * count_sides(record);
    }
    seen.rows = CodedRows(count * bands, cells.size());
    for (std::size_t p = 0; p < shown.asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& record = shown.asset.primitives[p];
        const SeenSurfaces::Rows own_rows = seen.primitive[p];
        for_each_block_in_order(
            record.vertex_count, kSeenAtOnce, context,
            [&](Range range) {
                for (std::size_t v = range.begin; v < range.end; ++v) {
                    std::vector<float> through(space.extinction_bands() * cells.size());
                    gather_transmittance(space, cells, shown.scene.primitives[p].position[v],
                                         through);
                    for (std::size_t side = 0; side < own_rows.sides; ++side) {
                        const std::vector<float> weight = weigh_rows(shown, record, p, v, side);
                        for (std::uint32_t band = 0; band < bands; ++band) {
                            std::vector<float> row =
                                read_cells(shown.asset.transport, record.rows(), weight, v,
                                           record.bands == 1 ? 0 : band, cells.n);
                            const std::size_t own = space.is_grey ? 0 : band * cells.size();
                            for (std::size_t i = 0; i < row.size(); ++i) {
                                row[i] *= through[own + i];
                            }
                            seen.rows.set(
                                (own_rows.first + v * own_rows.sides + side) * bands + band, row);
                        }
                    }
                }
                return true;
            },
            [&](Range range, bool) {
                done += range.end - range.begin;
                if (context.on_progress) {
                    context.on_progress(
                        {"surfaces that volumes see", done, shown.asset.position.size()});
                }
            });
    }
    return seen;
}

void add_seen_surface(const SeenSurfaces& seen, const MetSurface& met, glm::vec3 direction,
                      const std::array<float, 3>& weight, std::size_t first, std::size_t end,
                      float random, std::span<float> sum) {
    const formats::Primitive& primitive = seen.scene.primitives[met.primitive];
    const formats::Material& material = seen.scene.materials[primitive.material];
    SurfacePoint point;
    point.primitive = met.primitive;
    point.first_index = met.first_index;
    point.barycentric = {1 - met.u - met.v, met.u, met.v};
    const std::size_t corner = random < point.barycentric.x ? 0 : random < 1 - met.v ? 1 : 2;
    const std::size_t vertex = primitive.index[met.first_index + corner];
    if (!is_seen(material, met.behind, glm::dot(direction, primitive.normal[vertex]))) return;
    const SurfaceAlbedo albedo =
        eval_surface_albedo(seen.scene, seen.layouts[primitive.material], point);
    const formats::Rgb color = albedo.diffuse + share_of_rows(material) * albedo.mirrored;
    const std::array<float, 3> tint = seen.bands == 1
                                          ? std::array<float, 3>{formats::luminance(color), 0, 0}
                                          : std::array<float, 3>{color.r, color.g, color.b};
    const SeenSurfaces::Rows& own = seen.primitive[met.primitive];
    const std::size_t side = own.sides == 2 && met.behind ? 1 : 0, cells = seen.rows.size();
    const std::size_t row = (own.first + vertex * own.sides + side) * seen.bands;
    for (std::size_t band = first; band < end; ++band) {
        seen.rows.add(row + band, weight[band] * tint[band], sum.subspan(band * cells, cells));
    }
}

}  // namespace opaline::bake
