#include "bake/volumes/dim_surfaces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/encode/receiver_error.h"
#include "bake/encode/row_sink.h"
#include "bake/encode/share_rows.h"
#include "bake/receivers/other_side.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/density/attenuation.h"
#include "bake/transport/density/density_space.h"
#include "bake/volumes/sent_light.h"
#include "formats/opal/asset.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "formats/opal/rgb.h"
#include "formats/scene.h"

namespace opaline::bake {
namespace {

// What volumes scatter to both sides of a vertex; `back` is that of a sheet, otherwise empty.
struct LitVertex {
    SentIrradiance front, back;

    std::uint64_t rays() const { return front.rays + back.rays; }
};

// Response of a row to the irradiance on either side of its vertex: radiance per irradiance.
struct LitRow {
    float front = 0, back = 0;
};

// Sides of a body's vertex of which less is open answer to light of the sky by chance.
constexpr float kLeastOpen = 0.1f;

float in_band_of(formats::Rgb c, std::uint32_t band, std::uint32_t bands) {
    return bands == 1 ? formats::luminance(c) : std::array<float, 3>{c.r, c.g, c.b}[band];
}

// `set`: with a receiver for each vertex; `shading` that of its primitive.
LitVertex light_vertex(const SentLight& light, const ReceiverSet& set, std::size_t vertex,
                       formats::Shading shading) {
    LitVertex lit;
    lit.front = gather_sent_light(light, set.outside[vertex]);
    if (shading == formats::Shading::sheet) {
        lit.back = gather_sent_light(light, other_side(set.outside[vertex], set.inside[vertex]));
    }
    return lit;
}

// Of term `term` of a sheet's or an opaque surface's vertex in one of `bands` bands.
LitRow answer_of_surface(const formats::Material& material, std::uint32_t term, std::uint32_t band,
                         std::uint32_t bands) {
    constexpr float kShare = std::numbers::inv_pi_v<float>;
    if (!material.sheet) {
        return {kShare, 0};
    }
    const float r = kShare * in_band_of(material.sheet->reflect, band, bands);
    const float t = kShare * in_band_of(material.sheet->transmit, band, bands);
    return term == 0 ? LitRow{r, t} : LitRow{t, r};
}

// Of a medium: the row's response to an even sky per irradiance; `texels` are the row's values
// before volumes dim them, `solid_angles` those of a face of their cube map.
LitRow answer_of_medium(std::span<const float> texels, std::span<const double> solid_angles,
                        float open) {
    double even = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        even += static_cast<double>(texels[i]) * solid_angles[i % solid_angles.size()];
    }
    return {static_cast<float>(even) * std::numbers::inv_pi_v<float> / std::max(open, kLeastOpen),
            0};
}

// Adds that to the texel values of one band of a row, 6 n n.
void add_sent_light(const SentLight& light, const LitVertex& lit, const LitRow& answer,
                    std::uint32_t band, std::uint32_t n, std::span<float> texels) {
    const std::size_t cells = light.cells.size();
    const std::size_t first = light.bands() == 1 ? 0 : band * cells;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const std::size_t cell = first + coarser_texel(i, n, light.cells.n);
        texels[i] += answer.front * lit.front.rows[cell];
        if (!lit.back.rows.empty()) {
            texels[i] += answer.back * lit.back.rows[cell];
        }
    }
}

constexpr std::size_t kVerticesAtOnce = 16;         // vertices that a thread takes at once
constexpr std::uint32_t kFinestTransmittance = 16;  // texels along an edge of a face

// Of one vertex toward each texel of the file's cube map, band after band.
std::vector<float> transmittance(const DensitySpace& space, const LightCells& cells,
                                 glm::vec3 position, std::uint32_t n) {
    const std::size_t bands = space.extinction_bands(), texels = formats::cubemap_texels(n);
    std::vector<float> coarse(bands * cells.size());
    gather_transmittance(space, cells, position, coarse);
    std::vector<float> fine(bands * texels);
    for (std::size_t i = 0; i < fine.size(); ++i) {
        fine[i] = coarse[coarser_texel(i, n, cells.n)];
    }
    return fine;
}

// Texel values of one band of one row.
std::vector<float> decode_texels(const formats::SparseRowsView& rows,
                                 const formats::RowRange& range, std::uint32_t row,
                                 std::uint32_t band) {
    const std::uint32_t n = rows.cubemap_size;
    std::vector<float> dense(formats::cubemap_texels(n));
    formats::decode_row(rows, range, row, band, dense);
    haar_inverse_cube(dense, n);
    return dense;
}

struct DimJob {
    const DensitySpace& space;
    const LightCells& cells;
    const RowEncoder& encoder;
    const formats::SparseRowsView& rows;
    const formats::PrimitiveRecord& record;
    const formats::Primitive& primitive;
    const formats::Material& material;
    std::uint32_t bands;  // of the result
    // What volumes scatter to the vertices; null: nothing.
    const SentLight* sent;
    const ReceiverSet* receivers;
    std::span<const double> solid_angles;  // of a face's texels
};

// Of texel values of a row before they are dimmed.
LitRow answer_of(const DimJob& job, const LitVertex& lit, std::uint32_t term, std::uint32_t band,
                 std::span<const float> texels) {
    return job.record.shading == formats::Shading::translucent
               ? answer_of_medium(texels, job.solid_angles, lit.front.open)
               : answer_of_surface(job.material, term, band, job.bands);
}

// Rows of some vertices, and what encoding them again costs.
struct DimmedBlock {
    formats::SparseRows rows;
    LossMeter losses;
    std::uint64_t rays = 0;
};

// The dense rows of one vertex, dimmed and lit. Adds to `rays`.
std::vector<float> dim_vertex(const DimJob& job, std::size_t vertex, std::uint64_t& rays) {
    const std::uint32_t n = job.rows.cubemap_size;
    const std::size_t texels = formats::cubemap_texels(n);
    const std::vector<float> through =
        transmittance(job.space, job.cells, job.primitive.position[vertex], n);
    const formats::RowRange range = job.record.rows();
    LitVertex lit;
    if (job.sent != nullptr) {
        lit = light_vertex(*job.sent, *job.receivers, vertex, job.record.shading);
        rays += lit.rays();
    }
    std::vector<float> values;
    for (std::uint32_t k = 0; k < job.record.terms; ++k) {
        const auto row = static_cast<std::uint32_t>(vertex) * job.record.terms + k;
        for (std::uint32_t band = 0; band < job.bands; ++band) {
            const std::uint32_t from = job.record.bands == 1 ? 0 : band;
            std::vector<float> dense = decode_texels(job.rows, range, row, from);
            const LitRow answer =
                job.sent != nullptr ? answer_of(job, lit, k, band, dense) : LitRow{};
            const float* const share =
                through.data() + (through.size() == texels ? 0 : band * texels);
            for (std::size_t i = 0; i < texels; ++i) {
                dense[i] *= share[i];
            }
            if (job.sent != nullptr) {
                add_sent_light(*job.sent, lit, answer, band, n, dense);
            }
            formats::haar_forward_cube(std::span<float>(dense), n);
            values.insert(values.end(), dense.begin(), dense.end());
        }
    }
    return values;
}

DimmedBlock dim_block(const DimJob& job, Range range) {
    DimmedBlock block{empty_rows(job.encoder), {job.encoder, {job.record.terms, job.bands}}};
    for (std::size_t v = range.begin; v < range.end; ++v) {
        std::vector<float> values = dim_vertex(job, v, block.rays);
        const DenseRow row{values, job.rows.cubemap_size, job.record.terms, job.bands};
        encode_receiver(job.encoder, row, block.rows);
        block.losses.add(row);
    }
    return block;
}

}  // namespace

formats::Result<DimmedError> dim_surfaces(const formats::Scene& scene, const Knobs& knobs,
                                          const VertexLight* sent, const Context& context,
                                          formats::Asset& asset, std::uint64_t& rays) {
    const DensitySpace space = make_density_space(scene);
    const bool is_grey = space.is_grey && (sent == nullptr || sent->light.bands() == 1);
    const std::vector<double> solid_angles = formats::texel_solid_angles(knobs.cubemap_size);
    const std::uint32_t n = knobs.cubemap_size;
    const LightCells cells = make_light_cells(std::min(n, kFinestTransmittance));
    RowSink sink = make_row_sink(make_row_encoder(n, knobs.coefficients, knobs.code_bits));
    const RowEncoder wide = widen(sink.encoder);
    const formats::SparseRowsView given = asset.transport.view();
    std::vector<formats::PrimitiveRecord> records = asset.primitives;
    std::uint32_t band_rows = 0;
    std::uint64_t codes = 0, done = 0;
    bool fits = true;
    RowLoss loss;
    DimmedError found;
    for (std::size_t p = 0; p < records.size(); ++p) {
        formats::PrimitiveRecord& record = records[p];
        record.bands = is_grey ? record.bands : 3;
        record.first_band_row = band_rows;
        record.first_code = codes;
        const std::size_t before = sink.rows.row_offset.back();
        const formats::Primitive& primitive = scene.primitives[p];
        const bool is_lit = sent != nullptr && sent->receivers[p].size() > 0;
        const DimJob job{space,
                         cells,
                         wide,
                         given,
                         asset.primitives[p],
                         primitive,
                         scene.materials[primitive.material],
                         record.bands,
                         is_lit ? &sent->light : nullptr,
                         is_lit ? &sent->receivers[p] : nullptr,
                         solid_angles};
        formats::SparseRows rows = empty_rows(wide);
        const RowShape shape{record.terms, record.bands};
        LossMeter meter(wide, shape);
        for_each_block_in_order(
            record.vertex_count, kVerticesAtOnce, context,
            [&](Range range) { return dim_block(job, range); },
            [&](Range range, DimmedBlock&& block) {
                rays += block.rays;
                meter.append(block.losses);
                fits = fits && formats::append_rows(rows, block.rows);
                done += range.end - range.begin;
                if (context.on_progress) {
                    context.on_progress({"shadows of volumes", done, asset.position.size()});
                }
            });
        rows = share_rows(std::move(rows), shape, sink.encoder);
        if (context.cancelled()) break;
        for (const RowLoss& own : meter.losses(rows)) {
            loss.lost += own.lost;
            loss.all += own.all;
            found.receivers.push_back(own.error());
        }
        fits = fits && take_rows(sink, std::move(rows));
        band_rows += record.vertex_count * record.terms * record.bands;
        codes += (sink.rows.row_offset.back() - before) * record.bands;
    }
    if (!fits) {
        return formats::make_error(formats::ErrorKind::resource, "", "transport",
                                   "more than 2^32 coefficients do not fit into one file",
                                   "lower --coefficients, or split the scene");
    }
    asset.primitives = std::move(records);
    asset.transport = std::move(sink.rows);
    found.rms_relative = static_cast<double>(loss.error());
    return found;
}

}  // namespace opaline::bake
