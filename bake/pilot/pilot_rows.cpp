#include "bake/pilot/pilot_rows.h"

#include <array>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/stored_luminance.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// Rows of one receiver before selection, and with what they are seen.
struct DenseRows {
    std::vector<float> values;
    std::vector<float> h;
    std::uint32_t bands = 1;
};

DenseRows gather_direct_row(const PilotScene& pilot, const DirectionSet& directions,
                            const PilotReceiver& receiver) {
    DenseRows dense{std::vector<float>(directions.inverse_solid_angle.size()), {1.0f}, 1};
    gather_irradiance(pilot.rays_of(receiver.material), directions,
                      pilot.receivers[receiver.vertex], dense.values);
    for (float& value : dense.values) {
        value *= std::numbers::inv_pi_v<float>;
    }
    formats::haar_forward_cube(std::span<float>(dense.values), directions.cubemap_size);
    return dense;
}

// As the finished rows would say it.
Luminance relight_encoded(const DenseRows& dense, const Selector& selector, std::uint32_t code_bits,
                          std::span<const TestLight> lights) {
    formats::SparseRows rows = formats::make_sparse_rows(selector.cubemap_size, code_bits);
    const auto terms = static_cast<std::uint32_t>(dense.h.size());
    const std::size_t row_size = dense.values.size() / terms;
    for (std::uint32_t k = 0; k < terms; ++k) {
        formats::append_row(
            rows,
            select_coefficients(selector, std::span(dense.values).subspan(k * row_size, row_size),
                                dense.bands));
    }
    return relight_rows(rows.view(), {0, terms, dense.bands, 0, 0}, 0, dense.h, lights);
}

}  // namespace

PilotSingles gather_pilot_single(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                                 const RowSetting& setting, const Context& context) {
    PilotSingles singles;
    std::map<std::uint32_t, std::vector<BodyPoint>> points;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const std::uint32_t m = receivers[i].material;
        if (pilot.layouts[m].single_terms > 0 && !pilot.layouts[m].local) {
            PilotSingle& single = singles[m];
            single.place.resize(receivers.size());
            single.place[i] = points[m].size();
            points[m].push_back(pilot.points[receivers[i].vertex]);
        }
    }
    for (auto& [m, single] : singles) {
        single.stage =
            prepare_single(pilot.scene, pilot.rays, m,
                           {setting.single_cubemap, setting.depth_samples,
                            pilot.layouts[m].single_terms, true, pilot.layouts[m].bands()},
                           context);
        Context quiet = context;
        quiet.on_progress = nullptr;
        single.batch = gather_single_batch(single.stage, pilot.rays, points[m], quiet);
    }
    return singles;
}

std::vector<std::vector<CheckedPair>> measure_rows(
    const PilotScene& pilot, std::span<const PilotReceiver> receivers, const MediaStages& media,
    const PilotSingles& singles, const RowSetting& setting, std::uint32_t cubemap_size,
    std::span<const Encoding> encodings, std::span<const TestLight> lights,
    const Context& context) {
    const DirectionSet directions = make_direction_set(cubemap_size);
    std::vector<Selector> selectors;
    for (const Encoding& encoding : encodings) {
        selectors.push_back(make_selector(cubemap_size, encoding.coefficients));
    }
    const auto gather = [&](std::size_t i) {
        const PilotReceiver& r = receivers[i];
        const auto medium = media.find(r.material);
        if (medium == media.end()) {
            return gather_direct_row(pilot, directions, r);
        }
        TranslucentRecipe recipe = medium->second.recipe;
        recipe.gather.tolerance = setting.tolerance;
        recipe.selector.cubemap_size = cubemap_size;  // all that is used of it before selection
        const auto single = singles.find(r.material);
        const bool once = single != singles.end();
        recipe.single = once ? &single->second.stage : nullptr;
        const BodyPoint& point = pilot.points[r.vertex];
        DenseRows dense{{}, view_of_rows(recipe.layout, point.normal), recipe.layout.bands()};
        dense.values.resize(dense.h.size() * dense.bands * formats::cubemap_texels(cubemap_size));
        assemble_rows(recipe, pilot.rays, pilot.vertices[r.vertex], point,
                      once ? &single->second.batch : nullptr, once ? single->second.place[i] : 0,
                      dense.values);
        return dense;
    };
    using Pairs = std::vector<std::vector<CheckedPair>>;
    Pairs pairs(encodings.size());
    for_each_block_in_order(
        receivers.size(), 1, context,
        [&](Range range) {
            const DenseRows dense = gather(range.begin);
            Pairs own(encodings.size());
            for (std::size_t e = 0; e < encodings.size(); ++e) {
                append_pairs(relight_encoded(dense, selectors[e], encodings[e].code_bits, lights),
                             receivers[range.begin].truth, own[e]);
            }
            return own;
        },
        [&](Range, const Pairs& own) {
            for (std::size_t e = 0; e < own.size(); ++e) {
                pairs[e].insert(pairs[e].end(), own[e].begin(), own[e].end());
            }
        });
    return pairs;
}

}  // namespace opaline::bake
