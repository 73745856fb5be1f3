#include "bake/pipeline/cost_model.h"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bake/effects/layers/layer_error.h"
#include "bake/effects/layers/layer_work.h"
#include "bake/effects/layers/plan_layers.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/pipeline/costed_bake.h"
#include "bake/pipeline/emitter_stages.h"
#include "bake/pipeline/filtered_textures.h"
#include "bake/pipeline/predict_memory.h"
#include "bake/pipeline/volume_costs.h"
#include "bake/refine/simplify_scene.h"
#include "bake/scene/shared_rows.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/openness.h"
#include "formats/opal/receiver_errors.h"

namespace opaline::bake {
namespace {

// The stages of add_layers in order.
void bill_layers(const CostRequest& request, Bill& bill) {
    for (std::uint32_t i = 0; i < request.scene.layers.size(); ++i) {
        PlanEntry* const cloud = bill.payer(Subject::Kind::layer, i, kCloud);
        PlanEntry* const often = bill.payer(Subject::Kind::layer, i, kCloudOften);
        if (cloud == nullptr) continue;
        const formats::CloudLayer& layer = request.scene.layers[i];
        const LayerWork once = count_layer_work(layer, {i, true, false, false}, request.knobs);
        const LayerWork all =
            count_layer_work(layer, {i, true, often != nullptr, false}, request.knobs);
        bill.open("droplets of clouds");
        bill.add(droplet_work(once), cloud);
        bill.open("tables of clouds");
        bill.add(table_work(once), cloud);
        bill.add(table_work(all) - table_work(once), often);
        bill.add_bytes(once.bytes, cloud);
        bill.add_bytes(all.bytes - once.bytes, often);
        bill.open("self-check of clouds");
        bill.add({0, check_products() * kRadianceProduct});
    }
}

// Seconds: the rules, shells and the hierarchy of rays, a triangle; a vertex's clearance, and
// whether it is hidden; a ray of refinement; whether a vertex needs a row; all test lights, of
// which the rest is in the user's cache.
constexpr double kPlanTriangle = 6.3e-7, kOrientTriangle = 7.6e-7;
constexpr CostBySize kBuildTriangle{3.2e-7, 3.6e-7}, kPlaceReceiver{5.2e-6, 6.5e-6},
    kProxyRay{9e-8, 1.4e-7};
constexpr double kSimplifyVertex = 5e-5, kTestLights = 5e-3;

double count_vertices(const formats::Scene& scene) {
    double count = 0;
    for (const formats::Primitive& p : scene.primitives) {
        count += static_cast<double>(p.position.size());
    }
    return count;
}

// Mesh and images, compressed to about half.
double mesh_bytes(const formats::Scene& scene, const SceneFacts& facts) {
    constexpr double kCompressed = 0.5;
    const double vertex = scene.images.empty() ? 36 : 44;
    double bytes = count_vertices(scene) * vertex + facts.triangles * 12 +
                   static_cast<double>(facts.slots.slot.size() + facts.slots.vertex.size() +
                                       2 * facts.slots.mix.size()) *
                       4;
    for (const formats::Image8& image : scene.images) {
        bytes += static_cast<double>(image.rgba.size()) * 3 / 4;
    }
    return kCompressed * bytes;
}

bool fills_rows(const EffectDescriptor& effect) {
    return effect.gather.work != nullptr;
}

void bill_placing(const CostedBake& bake, bool has_lamps, Bill& bill) {
    const formats::Scene& scene = bake.request.scene;
    const SceneFacts& facts = bake.request.facts;
    double body_triangles = 0;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        body_triangles += scene.materials[m].medium ? facts.material[m].triangles : 0;
    }
    bill.open("bodies");
    bill.add({body_triangles * kOrientTriangle, 0});
    if (bake.request.refinement_rays > 0) {
        bill.open("refinement");
        bill.add(
            {0, static_cast<double>(bake.request.refinement_rays) * kProxyRay.at(facts.triangles)});
    }
    if (bake.request.knobs.simplify && has_dense_meshes(scene)) {
        bill.open("simplification");
        bill.add({count_vertices(scene) * kSimplifyVertex, 0});
    }
    bill.open("plan");
    bill.add({facts.triangles * kPlanTriangle, 0});
    if (bake.traces_rays) {
        bill.open("hierarchy");
        bill.add({0, facts.triangles * kBuildTriangle.at(facts.triangles)});
    }
    bill.open("receivers");
    bill.add({facts.receivers * kPlaceReceiver.at(facts.triangles), 0});
    std::vector<RowLayout> layouts(scene.materials.size());
    for (const CostedSubject& subject : bake.subjects) {
        layouts[subject.material] = subject.layout;
    }
    if (!filtered_materials(scene, layouts, has_lamps).empty()) {
        bill.open("textures");  // too little to be predicted: tens of nanoseconds a texel
    }
    if (facts.receivers > 0) {
        bill.open("test lights");
        bill.add({0, kTestLights});
    }
}

// As run_step runs it.
void bill_step(const CostedBake& bake, Step step, Bill& bill) {
    const auto& effects = bake.request.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const PreparationStep& own = step_of(effects[e], step);
        bool is_open = false;
        for (const CostedSubject& subject : bake.subjects) {
            const formats::Material& material = bake.request.scene.materials[subject.material];
            if (!subject.acts[e] || own.work == nullptr ||
                !is_taken(effects[e], step, material, subject.layout)) {
                continue;
            }
            if (own.by_subject || !is_open) {
                const std::string stage(own.stage);
                bill.open(stage + (own.by_subject ? " material '" + material.name + "'" : ""),
                          subject.layout.all_orders ? stage + " by walks" : stage);
                is_open = true;
            }
            bill.add(own.work(bake.cost_of(
                         subject, bake.request.facts.material[subject.material].receivers)),
                     bake.payer(subject, e));
        }
    }
}

// As find_shared_light runs: rows of media at coarse knobs, and what the effect does itself.
// Returns whether an effect does.
bool bill_shared_light(const CostedBake& bake, Bill& bill) {
    bool is_made = false;
    const CostRequest& request = bake.request;
    const auto& effects = request.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const auto concerned = std::ranges::find_if(
            bake.subjects, [&](const CostedSubject& subject) { return subject.acts[e]; });
        if (effects[e].light_work == nullptr || concerned == bake.subjects.end()) continue;
        is_made = true;
        PlanEntry* const payer = bake.payer(*concerned, e);
        const LightWork light = effects[e].light_work(bake.input);
        const std::string name(effects[e].name);
        bill.open(name, bake.kind_of(name, bake.subjects, fills_rows));
        bill.add(light.work, payer);
        const Knobs coarse = coarse_knobs(request.effects, request.knobs, light.cubemap_size);
        for (const CostedSubject& subject : bake.subjects) {
            if (subject.layout.translucent) {
                bill.add(work_of_points(bake, subject, coarse,
                                        light.points / static_cast<double>(bake.subjects.size()),
                                        [e](std::size_t f) { return f != e; }),
                         payer);
            }
        }
    }
    return is_made;
}

// What the plan makes of the scene.
MemoryCounts count_planned_memory(const CostedBake& bake) {
    const CostRequest& request = bake.request;
    MemoryCounts counts =
        count_memory(request.effects, request.scene, request.facts.slots.view(), request.knobs);
    const auto& effects = request.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        if (effects[e].light_work != nullptr &&
            std::ranges::any_of(bake.subjects,
                                [e](const CostedSubject& s) -> bool { return s.acts[e]; })) {
            counts.light_bytes += effects[e].light_work(bake.input).bytes;
        }
    }
    for (const CostedSubject& subject : bake.subjects) {
        if (!subject.layout.translucent) {
            counts.opaque_bands =
                std::max(counts.opaque_bands, static_cast<double>(subject.layout.bands()));
        }
    }
    return counts;
}

void bill_row_stages(const CostedBake& bake, const CostedVolumes& volumes, Bill& bill) {
    const formats::Scene& scene = bake.request.scene;
    for (std::size_t number = 0; number < scene.primitives.size(); ++number) {
        const formats::Primitive& p = scene.primitives[number];
        const auto subject = std::ranges::find(bake.subjects, p.material, &CostedSubject::material);
        const auto own = std::span(bake.subjects)
                             .subspan(static_cast<std::size_t>(subject - bake.subjects.begin()),
                                      subject == bake.subjects.end() ? 0 : 1);
        bill.open("rows of '" + p.name + "'", bake.kind_of("rows", own, fills_rows));
        if (!own.empty()) {
            const double receivers =
                count_receivers_of(scene, bake.request.facts.slots.view(), number);
            bill_rows(bake, *subject, receivers, bill);
            bill_encoding(bake, *subject, receivers, bill);
            bill_completion(bake.request, volumes, receivers,
                            receivers * subject->layout.terms() * subject->layout.bands(), bill);
        }
    }
}

void bill_openness(const CostedBake& bake, Bill& bill) {
    const auto& effects = bake.request.effects.effects;
    bool is_open = false;
    for (const CostedSubject& subject : bake.subjects) {
        if (!subject.layout.mirrors) continue;
        if (!is_open) {
            bill.open("openness");
            is_open = true;
        }
        std::size_t reader = 0;
        while (reader + 1 < effects.size() &&
               !(effects[reader].reads_openness && subject.acts[reader])) {
            ++reader;
        }
        PlanEntry* const payer = bake.payer(subject, reader);
        const double receivers = bake.request.facts.material[subject.material].receivers;
        bill.add(openness_work(bake.input, receivers, subject.layout.occluded), payer);
        bill.add_bytes(receivers * sizeof(formats::Openness), payer);
    }
}

}  // namespace

std::uint64_t row_bytes(const Knobs& knobs, bool translucent, std::uint64_t bands) {
    const std::uint64_t all = formats::cubemap_texels(knobs.cubemap_size);
    // On an opaque surface half of the coefficients vanish, below the horizon.
    const std::uint64_t details = knobs.coefficients == kAllCoefficients
                                      ? (translucent ? all : all / 2)
                                      : std::min<std::uint64_t>(knobs.coefficients, all) - 6;
    const std::uint64_t index_bytes = all <= 65536 ? 2 : 4;
    return details * (index_bytes + bands * knobs.code_bits / 8) + bands * (6 * 2 + 8) + 4;
}

CostPrediction predict_costs(const CostRequest& request, std::vector<PlanEntry>& plan) {
    Bill bill(request.rates, request.threads, plan);
    CostedBake bake = make_costed_bake(request, plan);
    const CostedVolumes volumes = make_costed_volumes(request);
    bake.traces_rays = bake.traces_rays || (!volumes.empty() && request.facts.triangles > 0);
    bill_placing(bake, is_on(plan, Subject::Kind::emitter), bill);
    bill_step(bake, Step::study, bill);
    if (!bill_shared_light(bake, bill) && sees_surfaces(volumes.layouts)) {
        bill_surface_light(request, volumes, bill);
    }
    if (request.knobs.error_target > 0) {
        bill_pilot_truth(bake, bill);
        bill_fixed_trials(bake, bill);
        bill_step(bake, Step::samples, bill);
        bill_other_trials(bake, bill);
        bill_volumes(request, volumes, bill);
    } else {
        bill_volumes(request, volumes, bill);
        bill_step(bake, Step::samples, bill);
    }
    bill_step(bake, Step::prepare, bill);
    bill_row_stages(bake, volumes, bill);
    bill_openness(bake, bill);
    bill_self_check(bake, bill);
    bill_layers(request, bill);
    bill_lamps(bake, plan, bill);
    bill.add_bytes(mesh_bytes(request.scene, request.facts));
    if (request.receiver_errors) {
        bill.add_bytes(sizeof(formats::ReceiverErrorsHead) +
                       sizeof(float) * count_vertices(request.scene));
    }
    bill.cost.memory_bytes = static_cast<std::uint64_t>(
        predict_memory(request.effects, count_planned_memory(bake), request.knobs, request.threads)
            .bytes());
    bill.cost.vertices = static_cast<std::uint64_t>(count_vertices(request.scene));
    bill.cost.receivers = static_cast<std::uint64_t>(request.facts.receivers);
    return std::move(bill.cost);
}

}  // namespace opaline::bake
