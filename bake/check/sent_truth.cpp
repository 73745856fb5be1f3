#include "bake/check/sent_truth.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "bake/receivers/other_side.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// The first of the published lights is even, of radiance 1.
constexpr std::size_t kEven = 1;

SentLight finer(const SentLight& light, std::uint64_t number) {
    SentLight own = light;
    own.side *= 2;
    own.seed += number;
    return own;
}

// Radiance [W m^-2 sr^-1] per unit of light from each cell, as luminance; `even`: of a medium.
std::vector<float> answer_cells(const SentTruth& truth, const SentLight& light,
                                const TruthReceiver& at, double even, std::uint64_t& rays) {
    const std::size_t cells = light.cells.size();
    const SentIrradiance front = gather_sent_light(light, at.outside);
    SentIrradiance back;
    rays += front.rays;
    if (truth.material.sheet) {
        back = gather_sent_light(light, other_side(at.outside, at.inside));
        rays += back.rays;
    }
    const auto in_band = [&](std::uint32_t band, std::size_t cell) {
        const auto bands = static_cast<std::uint32_t>(light.bands());
        const AnswerToSent answer =
            truth.even ? answer_of_medium(even, front.open, even)
                       : answer_of_surface(truth.material, at.behind ? 1 : 0, band, bands);
        const std::size_t i = (bands == 1 ? 0 : band * cells) + cell;
        return answer.front * front.rows[i] + (back.rows.empty() ? 0 : answer.back * back.rows[i]);
    };
    std::vector<float> luminance(cells);
    for (std::size_t c = 0; c < cells; ++c) {
        luminance[c] = light.bands() == 1
                           ? in_band(0, c)
                           : formats::luminance({in_band(0, c), in_band(1, c), in_band(2, c)});
    }
    return luminance;
}

}  // namespace

SentTruth make_sent_truth(const FinishedBake& bake, const SentLight& light,
                          const SubjectState& subject, const Context& context) {
    SentTruth truth{{finer(light, 1), finer(light, 2)},
                    bake.inputs.scene.materials[subject.material],
                    bake.knobs.cubemap_size,
                    std::nullopt};
    if (subject.layout.translucent) {
        truth.even = make_subject_truth(bake.inputs, subject, bake.knobs, {},
                                        bake.lights.first(kEven), context);
    }
    return truth;
}

std::uint64_t add_sent_truth(const SentTruth& truth, const TruthReceiver& at,
                             std::span<const TestLight> lights, TwoEstimates& luminance) {
    std::uint64_t rays = 0;
    double even = 0;
    if (truth.even) {
        const TwoEstimates seen = eval_truth(*truth.even, at, rays);
        even = 0.5 * (seen.first.front() + seen.second.front());
    }
    for (const std::size_t i : {0u, 1u}) {
        const SentLight& light = truth.light[i];
        const std::vector<float> row = transform_cells(answer_cells(truth, light, at, even, rays),
                                                       light.cells.n, truth.cubemap_size);
        Luminance& to = i == 0 ? luminance.first : luminance.second;
        for (std::size_t l = 0; l < lights.size(); ++l) {
            to[l] += relit(row, lights[l].coarse);
        }
    }
    return rays;
}

}  // namespace opaline::bake
