#include "bake/plan/cost_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/plan/accuracy_costs.h"
#include "bake/plan/bill.h"
#include "bake/plan/predict_memory.h"
#include "bake/plan/row_layout.h"
#include "bake/plan/stage_costs.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/openness.h"

namespace opaline::bake {
namespace {

// Mesh and images, which are compressed to about a half.
double mesh_bytes(const formats::Scene& scene, const SceneFacts& facts) {
    constexpr double kCompressed = 0.5;
    const double vertex = scene.images.empty() ? 36 : 44;
    double bytes = facts.receivers * vertex + facts.triangles * 12;
    for (const formats::Image8& image : scene.images) {
        bytes += static_cast<double>(image.rgba.size()) * 3 / 4;
    }
    return kCompressed * bytes;
}

// What the stages cost that make the file.
struct Making {
    const CostedBake& bake;
    Bill& bill;
    const formats::Scene& scene = bake.scene;
    const SceneFacts& facts = bake.facts;
    const CostInput& input = bake.input;
    const std::vector<RowLayout>& layouts = bake.layouts;

    void prepare() {
        double body_triangles = 0;
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            body_triangles += scene.materials[m].medium ? facts.material[m].triangles : 0;
        }
        bill.open("bodies");
        bill.add({body_triangles * input.rates.orient_triangle, 0});
        bill.open("plan");
        bill.add({facts.triangles * input.rates.plan_triangle, 0});
        if (needs_hierarchy(layouts)) {
            bill.open("hierarchy");
            bill.add({0, facts.triangles * input.rates.build_triangle.at(facts.triangles)});
        }
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].direct && scene.materials[m].medium) {
                open_once("albedos of media");
                bill.add(albedo_work(input, bake.medium(m)), "direct", m);
            }
        }
        bill.open("receivers");
        bill.add({facts.receivers * input.rates.place_receiver.at(facts.triangles), 0});
        bill.open("test lights");
        bill.add({0, input.rates.test_lights});
        bill.open("profiles");
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].translucent && layouts[m].multiple) {
                bill.add(profile_work(input, bake.medium(m)), "multiple", m);
            }
        }
    }

    void open_once(const char* name) {
        if (bill.cost.stages.back().name != name) {
            bill.open(name);
        }
    }

    void take_samples() {
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].translucent && layouts[m].multiple && !layouts[m].local) {
                bill.open("samples of material '" + scene.materials[m].name + "'");
                bill.add(
                    samples_work(input, bake.medium(m), facts.material[m], layouts[m].occluded),
                    "multiple", m);
            }
        }
    }

    void make_light_maps() {
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].translucent && layouts[m].single_terms > 0 && !layouts[m].local) {
                bill.open("light maps of material '" + scene.materials[m].name + "'");
                bill.add(light_maps_work(input, facts.material[m]), "single", m);
            }
        }
    }

    void make_rows() {
        for (const formats::Primitive& p : scene.primitives) {
            const RowLayout& layout = layouts[p.material];
            const MaterialFacts& own = facts.material[p.material];
            const auto receivers = static_cast<double>(p.position.size());
            bill.open("rows of '" + p.name + "'");
            if (!layout.translucent) {
                if (layout.direct) {
                    bill.add(direct_rows_work(input, receivers, layout.occluded), "direct",
                             p.material);
                }
                bill.add(encode_work(input, 1, 1, receivers), "direct", p.material);
                bill.add_bytes(receivers * static_cast<double>(row_bytes(input.knobs, false, 1)),
                               "direct", p.material);
                continue;
            }
            if (layout.local) {
                bill.add(direct_rows_work(input, receivers, layout.occluded),
                         layout.multiple ? "multiple" : "single", p.material);
            }
            const std::uint32_t bands = layout.bands();
            if (layout.multiple && !layout.local) {
                bill.add(multiple_rows_work(input, bake.medium(p.material), own, bands, receivers),
                         "multiple", p.material);
            }
            if (layout.single_terms > 0 && !layout.local) {
                const Work one = single_rows_work(input, own, 1, bands, receivers);
                const Work all =
                    single_rows_work(input, own, layout.single_terms, bands, receivers);
                bill.add(one, "single", p.material);
                bill.add({all.alone - one.alone, all.shared - one.shared}, "single.terms",
                         p.material);
            }
            // The first row is that of multiple scattering, where there is any.
            const std::uint32_t first = layout.multiple ? 1 : 0;
            const std::uint32_t beyond = std::max(layout.single_terms, 1u) - 1;
            const auto bytes = receivers * static_cast<double>(row_bytes(input.knobs, true, bands));
            for (const auto& [effect, count] : {std::pair{"multiple", first},
                                                {"single", layout.terms() - first - beyond},
                                                {"single.terms", beyond}}) {
                bill.add(encode_work(input, count, bands, receivers), effect, p.material);
                bill.add_bytes(count * bytes, effect, p.material);
            }
        }
    }

    void make_openness() {
        if (!is_any_glossy()) {
            return;
        }
        bill.open("openness");
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].glossy) {
                bill.add(openness_work(input, facts.material[m].receivers, layouts[m].occluded),
                         "specular", m);
                bill.add_bytes(facts.material[m].receivers * sizeof(formats::Openness), "specular",
                               m);
            }
        }
    }

    bool is_any_glossy() const {
        return std::any_of(layouts.begin(), layouts.end(),
                           [](const RowLayout& l) { return l.glossy; });
    }
};

}  // namespace

std::uint64_t row_bytes(const Knobs& knobs, bool translucent, std::uint64_t bands) {
    const std::uint64_t all = formats::cubemap_texels(knobs.cubemap_size);
    // Of an opaque surface half of all coefficients vanish, below the horizon.
    const std::uint64_t details = knobs.coefficients == kAllCoefficients
                                      ? (translucent ? all : all / 2)
                                      : std::min<std::uint64_t>(knobs.coefficients, all) - 6;
    const std::uint64_t index_bytes = all <= 65536 ? 2 : 4;
    return details * (index_bytes + bands * knobs.code_bits / 8) + bands * (6 * 2 + 8) + 4;
}

CostPrediction predict_costs(const formats::Scene& scene, const SceneFacts& facts,
                             const Knobs& knobs, const Rates& rates, unsigned threads,
                             std::vector<PlanEntry>& plan) {
    const CostedBake bake{scene,
                          facts,
                          layout_rows(scene, plan, knobs),
                          {rates, knobs, facts.triangles, facts.receivers}};
    Bill bill(rates, threads, plan);
    Making making{bake, bill};
    making.prepare();
    if (knobs.error_target > 0) {
        bill_pilot_truth(bake, bill);
        bill_opaque_trials(bake, bill);
        making.take_samples();
        bill_media_trials(bake, bill);
    } else {
        making.take_samples();
    }
    making.make_light_maps();
    making.make_rows();
    making.make_openness();
    bill_self_check(bake, bill);
    bill.add_bytes(mesh_bytes(scene, facts));
    bill.cost.memory_bytes = static_cast<std::uint64_t>(
        predict_memory(count_memory(scene, knobs), knobs, threads).bytes());
    bill.cost.receivers = static_cast<std::uint64_t>(facts.receivers);
    return std::move(bill.cost);
}

}  // namespace opaline::bake
