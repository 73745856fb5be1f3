#include "bake/accuracy/check_rows.h"

#include <string>
#include <utility>
#include <vector>

#include "bake/accuracy/check_point.h"
#include "bake/accuracy/stored_luminance.h"
#include "bake/accuracy/subject_truth.h"
#include "bake/accuracy/surface_probes.h"
#include "bake/base/ordered_parallel.h"
#include "bake/receivers/used_vertices.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

// Toward the eye inside the medium; 0 along the normal.
glm::vec3 seen_inside(const SubjectTruth& truth, const CheckPoint& point) {
    if (point.to_eye == glm::vec3(0)) {
        return point.to_eye;
    }
    const float eta = truth.parts.front().inputs.medium().eta;
    const float cosine = glm::dot(point.body.normal, point.to_eye);
    const auto inside =
        static_cast<float>(refracted_cosine(static_cast<double>(cosine), static_cast<double>(eta)));
    return glm::normalize((point.to_eye - cosine * point.body.normal) / eta +
                          inside * point.body.normal);
}

// Below index 1 nothing is seen beyond the critical angle.
bool enters_everywhere(const SubjectTruth& truth) {
    return truth.parts.front().inputs.medium().eta >= 1;
}

EffectCheck check_subject(const SubjectTruth& truth, const SubjectState& subject,
                          const formats::AssetView& asset, std::span<const CheckPoint> points,
                          std::span<const TestLight> lights) {
    EffectCheck check;
    check.effect = truth.name();
    check.reference = truth.reference();
    const std::size_t step = truth.is_expensive()
                                 ? (points.size() + kMostExpensiveChecks - 1) / kMostExpensiveChecks
                                 : 1;
    for_each_block_in_order(
        points.size(), 1, truth.parts.front().inputs.context,
        [&](Range range) {
            CheckPoint point = points[range.begin];
            if (!subject.layout.all_orders || !enters_everywhere(truth)) {
                point.to_eye = glm::vec3(0);  // other models look along the normal alone
            }
            CheckedPoint found{point.primitive, {}, 0};
            if (point.material == subject.material && range.begin % step == 0) {
                append_pairs(relight_point(asset, point, subject.layout, lights),
                             eval_truth(truth,
                                        {point.receiver, point.body, point.key, point.behind,
                                         seen_inside(truth, point)},
                                        found.rays),
                             found.pairs);
            }
            return found;
        },
        [&](Range, const CheckedPoint& found) { append_point(found, check); });
    return check;
}

// Primitives that something is simulated for.
std::vector<std::uint32_t> find_lit_primitives(const FinishedBake& bake) {
    std::vector<std::uint32_t> lit;
    for (const ReceiverSet& set : bake.inputs.receivers) {
        if (set.size() > 0 && has_truth(bake.inputs, state_of(bake.subjects, set.material))) {
            lit.push_back(set.primitive);
        }
    }
    return lit;
}

}  // namespace

ErrorReport check_file(const FinishedBake& bake, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced) {
    const std::uint64_t seed = bake.knobs.seed;
    const std::size_t all = count_receivers(bake.inputs.receivers);
    const std::vector<std::uint32_t> used = find_used_vertices(bake.inputs.scene);
    std::vector<std::uint32_t> drawn =
        draw_evenly(used.size(), count_checked(used.size(), bake.knobs.cubemap_size),
                    RandomStage::held_back_receivers, seed);
    for (std::uint32_t& receiver : drawn) {
        receiver = used[receiver];
    }
    std::vector<CheckPoint> receivers = make_check_points(bake.inputs.receivers, drawn);
    std::vector<CheckPoint> between =
        draw_surface_probes(bake.inputs.scene, bake.inputs.rays, find_lit_primitives(bake),
                            {drawn.size(), seed, static_cast<std::uint32_t>(all)}, context);
    turn_thin_walled(bake.inputs.scene, receivers);
    turn_thin_walled(bake.inputs.scene, between);
    std::vector<glm::vec3> normals;
    for (const formats::Primitive& p : bake.inputs.scene.primitives) {
        normals.insert(normals.end(), p.normal.begin(), p.normal.end());
    }
    turn_views(normals, seed, receivers);
    turn_views(normals, seed, between);
    std::vector<EffectCheck> checks;
    for (const SubjectState& subject : bake.subjects) {
        const SubjectTruth truth =
            make_subject_truth(bake.inputs, subject, bake.knobs, {}, bake.lights, context);
        if (truth.parts.empty()) {
            continue;  // black: no error
        }
        for (const auto* points : {&receivers, &between}) {
            EffectCheck check = check_subject(truth, subject, asset, *points, bake.lights);
            check.between = points == &between;
            traced += check.rays;
            checks.push_back(std::move(check));
        }
    }
    std::vector<std::string> names;
    for (const TestLight& light : bake.lights) {
        names.push_back(light.name);
    }
    return summarise_checks(checks, names, seed);
}

}  // namespace opaline::bake
