#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "bake/check/model_pairs.h"
#include "bake/reference/reference_receivers.h"
#include "tests/support/media_bake.h"

namespace opaline::tests {

/// Light of all lamps at vertices of the first primitive: the file beside path tracing.
inline bake::MeanSquares lamps_beside_paths(const Scene& scene, const bake::BakeResult& result) {
    const auto reference = bake::make_reference_scene(scene, 2);
    EXPECT_TRUE(reference);
    std::vector<bake::ReferenceReceiver> receivers =
        bake::choose_receivers(*reference, 60, 3, std::nullopt);
    std::erase_if(receivers, [](const auto& receiver) { return receiver.primitive != 0; });
    const formats::Environment black;
    const bake::LightSampler sky = bake::make_light_sampler(black, glm::mat3(1.0f));
    const bake::PathSpace space{*reference, sky, {.terms = formats::TermSet::emitters}};
    const formats::AssetView view = result.asset.view();
    const std::vector<formats::Rgb> lit(view.emitters.size(), formats::Rgb{1, 1, 1});
    bake::ModelCheckOptions options;
    options.max_events = 6000000;
    options.noise = 0.02;
    const auto check = bake::check_light(
        {&space, 1}, receivers,
        bake::relight_receivers(
            view, receivers,
            {.vector = make_light("black", view.cubemap_size), .emitters = {.color = lit}}),
        options, {});
    EXPECT_TRUE(check);
    return bake::sum_up(check->pairs);
}

}  // namespace opaline::tests
