#include "bake/plan/cost_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

std::uint64_t row_bytes(const Knobs& knobs, bool translucent, std::uint64_t bands) {
    const std::uint64_t all = formats::cubemap_texels(knobs.cubemap_size);
    // Of an opaque surface half of all coefficients vanish, below the horizon.
    const std::uint64_t details = knobs.coefficients == kAllCoefficients
                                      ? (translucent ? all : all / 2)
                                      : std::min<std::uint64_t>(knobs.coefficients, all) - 6;
    const std::uint64_t index_bytes = all <= 65536 ? 2 : 4;
    return details * (index_bytes + bands * knobs.code_bits / 8) + bands * (6 * 2 + 8) + 4;
}

// Adds stages up, and what each effect has in them.
class Bill {
  public:
    Bill(const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan)
        : crowding_(threads > 1 ? rates.crowding : 1), threads_(threads), plan_(plan) {
        for (PlanEntry& entry : plan) {
            entry.predicted_seconds = 0;
            entry.predicted_bytes = 0;
        }
    }

    void open(std::string name) { cost.stages.push_back({std::move(name), 0}); }
    /// Into the stage that was opened last; for an effect on a material, or for none.
    void add(const Work& work, std::string_view effect = {}, std::uint32_t material = 0) {
        const double seconds = work.alone + work.shared * crowding_ / threads_;
        cost.stages.back().seconds += seconds;
        cost.seconds += seconds;
        if (PlanEntry* const entry = find(effect, material)) {
            entry->predicted_seconds += seconds;
        } else {
            cost.shared_seconds += seconds;
        }
    }
    void add_bytes(double bytes, std::string_view effect = {}, std::uint32_t material = 0) {
        const auto whole = static_cast<std::uint64_t>(bytes);
        cost.bytes += whole;
        if (PlanEntry* const entry = find(effect, material)) {
            entry->predicted_bytes += whole;
        } else {
            cost.shared_bytes += whole;
        }
    }

    CostPrediction cost;

  private:
    PlanEntry* find(std::string_view effect, std::uint32_t material) {
        for (PlanEntry& entry : plan_) {
            if (entry.on && entry.effect == effect && entry.material == material) {
                return &entry;
            }
        }
        return nullptr;
    }

    double crowding_;
    double threads_;
    std::vector<PlanEntry>& plan_;
};

/// One prediction.
struct Prediction {
    const formats::Scene& scene;
    const Knobs& knobs;
    const Rates& rates;
    const SceneFacts& facts;
    std::vector<RowLayout> layouts;
    CostInput input;
    Bill bill;

    const formats::Medium& medium(std::uint32_t m) const { return *scene.materials[m].medium; }

    void prepare() {
        double body_triangles = 0;
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            body_triangles += scene.materials[m].medium ? facts.material[m].triangles : 0;
        }
        bill.open("bodies");
        bill.add({body_triangles * rates.orient_triangle, 0});
        bill.open("plan");
        bill.add({facts.triangles * rates.plan_triangle, 0});
        if (needs_hierarchy(layouts)) {
            bill.open("hierarchy");
            bill.add({0, facts.triangles * rates.build_triangle.at(facts.triangles)});
        }
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].direct && scene.materials[m].medium) {
                open_once("albedos of media");
                bill.add(albedo_work(input, medium(m)), "direct", m);
            }
        }
        bill.open("receivers");
        bill.add({facts.receivers * rates.place_receiver.at(facts.triangles), 0});
        bill.open("test lights");
        bill.add({0, rates.test_lights});
        bill.open("profiles");
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (layouts[m].translucent && layouts[m].multiple) {
                bill.add(profile_work(input, medium(m)), "multiple", m);
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
                bill.add(samples_work(input, medium(m), facts.material[m], layouts[m].occluded),
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
                bill.add_bytes(receivers * static_cast<double>(row_bytes(knobs, false, 1)),
                               "direct", p.material);
                continue;
            }
            if (layout.local) {
                bill.add(direct_rows_work(input, receivers, layout.occluded),
                         layout.multiple ? "multiple" : "single", p.material);
            }
            const std::uint32_t bands = layout.bands();
            if (layout.multiple && !layout.local) {
                bill.add(multiple_rows_work(input, medium(p.material), own, bands, receivers),
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
            const auto bytes = receivers * static_cast<double>(row_bytes(knobs, true, bands));
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

    // As check_rows does it.
    void check() {
        constexpr double kMostChecked = 256;
        bill.open("self-check");
        const double drawn =
            std::min(facts.receivers, std::clamp(facts.receivers / 40, 16.0, 1024.0));
        find_truth(drawn, drawn / std::ceil(drawn / kMostChecked),
                   {1024, 2.0 * knobs.depth_samples});
    }

    // As choose_knobs does it, if the first choice is met.
    void find_pilot_truth() {
        constexpr double kMostTranslucent = 192;
        bill.open("pilot truth");
        const double drawn = pilot_receivers();
        const double target = knobs.error_target;
        find_truth(drawn, std::min(drawn, kMostTranslucent),
                   {target >= 0.03    ? 256.0
                    : target >= 0.015 ? 512.0
                                      : 1024.0,
                    target >= 0.03 ? 8.0 : 16.0});
    }
    static constexpr std::uint32_t kEncodings = 26;
    // Rows of its opaque receivers, under all encodings.
    void measure_opaque() {
        bill.open("pilot");
        const double opaque = opaque_share() * pilot_receivers();
        bill.add(direct_rows_work(input, opaque, needs_hierarchy(layouts)));
        bill.add(encode_work(input, kEncodings, 1, opaque));
    }
    // Rows of those in media, once for each of some values of the knobs, and once for all
    // encodings; single scattering by rays.
    void try_knobs() {
        constexpr double kRounds = 4, kMostTranslucent = 192, kDepthSamples = 10;
        bill.open("pilot");
        const double translucent = std::min(pilot_receivers(), kMostTranslucent);
        Knobs by_rays = knobs;
        by_rays.exact_rays = true;
        by_rays.depth_samples = kDepthSamples;
        const CostInput traced{rates, by_rays, facts.triangles, facts.receivers};
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            const double own = translucent * facts.material[m].receivers / facts.receivers;
            if (!layouts[m].translucent) {
                continue;
            }
            if (layouts[m].multiple) {
                bill.add(multiple_rows_work(input, medium(m), facts.material[m], layouts[m].bands(),
                                            kRounds * own));
            }
            if (layouts[m].single_terms > 0) {
                bill.add(single_rows_work(traced, facts.material[m], layouts[m].single_terms,
                                          layouts[m].bands(), own));
            }
            bill.add(encode_work(input, kEncodings * layouts[m].terms(), layouts[m].bands(), own));
        }
    }
    double opaque_share() const {
        double direct = 0;
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            direct += layouts[m].direct ? facts.material[m].receivers : 0;
        }
        return direct / facts.receivers;
    }
    double pilot_receivers() const {
        return std::min(facts.receivers, std::clamp(facts.receivers / 40, 64.0, 1024.0));
    }

    // Of `opaque` receivers out of all materials', and of media as if `translucent` were.
    void find_truth(double opaque, double translucent, const TruthEffort& effort) {
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            const double share =
                facts.receivers > 0 ? facts.material[m].receivers / facts.receivers : 0;
            if (layouts[m].direct) {
                bill.add(direct_check_work(input, share * opaque, needs_hierarchy(layouts)));
            } else if (layouts[m].translucent) {
                bill.add(medium_check_work(input, facts.material[m], layouts[m],
                                           share * translucent, effort));
            }
        }
    }

    bool is_any_glossy() const {
        return std::any_of(layouts.begin(), layouts.end(),
                           [](const RowLayout& l) { return l.glossy; });
    }
};

}  // namespace

CostPrediction predict_costs(const formats::Scene& scene, const SceneFacts& facts,
                             const Knobs& knobs, const Rates& rates, unsigned threads,
                             std::vector<PlanEntry>& plan) {
    Prediction prediction{scene,
                          knobs,
                          rates,
                          facts,
                          layout_rows(scene, plan, knobs),
                          {rates, knobs, facts.triangles, facts.receivers},
                          Bill(rates, threads, plan)};
    prediction.prepare();
    if (knobs.error_target > 0) {
        prediction.find_pilot_truth();
        prediction.measure_opaque();
        prediction.take_samples();
        prediction.try_knobs();
    } else {
        prediction.take_samples();
    }
    prediction.make_light_maps();
    prediction.make_rows();
    prediction.make_openness();
    prediction.check();
    prediction.bill.add_bytes(mesh_bytes(scene, facts));
    CostPrediction& cost = prediction.bill.cost;
    cost.receivers = static_cast<std::uint64_t>(facts.receivers);
    return cost;
}

}  // namespace opaline::bake
