#include "bake/effects/interreflection/site_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/effects/effects.h"
#include "bake/effects/interreflection/add_bounced.h"
#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/interreflection/bounce_support.h"

namespace opaline::bake {
namespace {

// A room open to the front.
formats::Scene make_open_room() {
    using tests::make_quad;
    formats::Scene room = tests::make_scene({
        make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 32),  // floor
        make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 32),  // ceiling
        make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 32),  // back
        make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 32),  // left
        make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 32),  // right
    });
    room.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    return room;
}

// Most points of a room need no rays of their own, and their light is that of very many rays, row
// by row.
TEST(SiteLight, PointsBetweenSitesHaveTheLightOfManyRays) {
    const formats::Scene scene = make_open_room();
    const RayScene rays = RayScene::build(scene, 1).value(), sky = RayScene::build({}, 1).value();
    const SceneFacts facts = inspect_scene(scene);
    const std::vector<Receiver> receivers = make_vertex_receivers(scene);
    const std::vector<ReceiverSet> sets =
        make_vertex_sets(scene, receivers, make_body_points(scene, receivers));
    std::vector<RowLayout> layouts(scene.materials.size());
    layouts[0].constant = true;
    const BakeInputs bake{all_effects(), scene, facts, rays, sky, sets};
    BakeOptions options;
    options.set(kBounceRays, 64);
    options.effects = {"direct", "interreflection"};
    std::uint64_t traced = 0;
    const auto light =
        find_bounce_light({bake, resolve_knobs(options).value(), {}, layouts, {}, {}}, traced);
    ASSERT_NE(light, nullptr);
    const std::size_t size = light->tree.row_size();
    const BounceGrid many = make_bounce_grid(4096);
    double squares = 0, norm = 0;
    std::size_t without = 0, all = 0;
    for (std::size_t i = 3; i < receivers.size(); i += 53, ++all) {
        std::vector<float> own(size), truth(size);
        if (add_bounced(*light, {receivers[i]}, light->cubemap_size, own) > 0) {
            continue;
        }
        ++without;
        std::vector<NodeWeight> weights;
        weigh_bounces(scene, rays, light->tree, receivers[i], many, 1, weights);
        add_node_rows(light->tree, weights, truth);
        for (std::size_t k = 0; k < size; ++k) {
            squares += std::pow(static_cast<double>(own[k]) - static_cast<double>(truth[k]), 2);
            norm += std::pow(static_cast<double>(truth[k]), 2);
        }
    }
    EXPECT_GT(2 * without, all);
    // 64 rays of their own have a noise of 8 %, the 16 of a site twice as much.
    EXPECT_LT(std::sqrt(squares / norm), 0.05);
}

}  // namespace
}  // namespace opaline::bake
