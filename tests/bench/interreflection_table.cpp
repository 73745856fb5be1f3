// Bounced light of the bake against an exact final gather, against path tracing, and its cost.
//   opaline_bench interreflection-table gather SCENE RAYS: errors of 160 receivers against 16384
//   rays
//     that read the nearest of as many scatterers as there are, whose light is found with 256 rays
//     each; of each error, the part that rays of other seeds share.
//   ... truth SCENE: a file of production against path tracing of all light.
// SCENE: box (a room open to the front, with a block in it), room (no block), ball (dented, over a
// floor), statue.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "bake/check/check_model.h"
#include "bake/effects/effects.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/scatterers.h"
#include "bake/lab/example/example_scenes.h"
#include "bake/lights/builtin_environment.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/gltf/import_gltf.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/light_vector.h"
#include "tests/bench/bench.h"
#include "tests/support/bake.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMap = kBounceCubemap;
constexpr std::size_t kTexels = 6 * kMap * kMap;

formats::Scene make_open_box(bool has_block) {
    using tests::make_quad;
    constexpr std::uint32_t n = 24;
    formats::Scene scene = tests::make_scene({
        make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n),  // floor, up
        make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n),  // ceiling, down
        make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n),  // back, toward +z
        make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n),  // left, toward +x
        make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n),  // right, toward -x
    });
    if (has_block) {
        scene.primitives.push_back(tests::transformed(tests::make_cube(6, false), glm::mat3(1),
                                                      0.15f, {0.4f, 0.16f, 0.4f}));
        scene.primitives.back().material = 0;
    }
    scene.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    return scene;
}

// The same shapes of four times the triangles: receivers are denser, and so are the scatterers that
// these see.
formats::Scene split(formats::Scene scene) {
    for (formats::Primitive& p : scene.primitives) {
        std::vector<std::uint32_t> index;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            p.position.push_back(0.5f * (p.position[a] + p.position[b]));
            p.normal.push_back(glm::normalize(p.normal[a] + p.normal[b]));
            return static_cast<std::uint32_t>(p.position.size() - 1);
        };
        for (std::size_t t = 0; t < p.index.size(); t += 3) {
            const std::uint32_t a = p.index[t], b = p.index[t + 1], c = p.index[t + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            index.insert(index.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        p.index = index;
    }
    return scene;
}

formats::Scene example(const char* name) {
    const tests::TemporaryFolder folder;
    return formats::import_gltf(write_example(name, folder.path()).value().front()).value().scene;
}

struct World {
    explicit World(formats::Scene made)
        : scene(std::move(made)),
          rays(RayScene::build(scene, 0).value()),
          sky(RayScene::build({}, 1).value()),
          facts(inspect_scene(scene)),
          receivers(make_vertex_receivers(scene)),
          sets(make_vertex_sets(scene, receivers, make_body_points(scene, receivers))),
          layouts(scene.materials.size()),
          bake{all_effects(), scene, facts, rays, sky, sets} {
        for (auto& l : layouts)
            l.constant = true;
    }
    formats::Scene scene;
    RayScene rays, sky;
    SceneFacts facts;
    std::vector<Receiver> receivers;
    std::vector<ReceiverSet> sets;
    std::vector<RowLayout> layouts;
    BakeInputs bake;
    Context context;
};

using Row = std::vector<float>;

Row env_row(const World& w, const DirectionSet& d, const Receiver& at) {
    Row row(kTexels);
    gather_irradiance(w.rays, d, at, row);
    formats::haar_forward_cube(std::span<float>(row), kMap);
    return row;
}

struct Exact {
    std::vector<Scatterer> points;
    std::unique_ptr<BounceTree> tree;
};

Exact exact_light(const World& w, std::size_t count) {
    Exact e;
    std::uint64_t rays = 0;
    Knobs knobs;
    e.points = find_scatterers({w.bake, knobs, w.context, w.layouts, {}, {}}, count, rays);
    const std::size_t n = e.points.size();
    e.tree = std::make_unique<BounceTree>(e.points, w.scene.materials.size(), kTexels);
    const DirectionSet d = make_direction_set(kMap);
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        Row row(kTexels);
        gather_irradiance(w.rays, d, e.points[i].outside, row);
        const std::vector<double> solid = formats::texel_solid_angles(kMap);
        double sum = 0;
        for (std::size_t k = 0; k < kTexels; ++k)
            sum += row[k] * solid[k % solid.size()];
        e.points[i].openness = static_cast<float>(std::clamp(sum / 3.14159265, 0.0, 1.0));
    });
    e.tree = std::make_unique<BounceTree>(e.points, w.scene.materials.size(), kTexels);
    const BounceGrid grid = make_bounce_grid(256);
    std::vector<float> emitted(n * kTexels), sum;
    std::vector<std::vector<NodeWeight>> arrive(n);
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        const Row r = env_row(w, d, e.points[i].outside);
        const float rho = formats::luminance(e.points[i].albedo.sum());
        for (std::size_t k = 0; k < kTexels; ++k)
            emitted[i * kTexels + k] = rho * r[k];
        weigh_bounces({w.scene, w.rays}, *e.tree, e.points[i].outside, grid, 77, arrive[i],
                      LookUp::nearest);
    });
    sum = emitted;
    std::vector<float> last = emitted;
    for (int b = 0; b < 24; ++b) {
        e.tree->set_rows({last, kTexels});
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            Row r(kTexels);
            add_node_rows(*e.tree, arrive[i], r);
            const float rho = formats::luminance(e.points[i].albedo.sum());
            for (std::size_t k = 0; k < kTexels; ++k) {
                last[i * kTexels + k] = rho * r[k];
                sum[i * kTexels + k] += rho * r[k];
            }
        });
    }
    e.tree->set_rows({sum, kTexels});
    return e;
}

// `fine`: the same shapes, whose scatterers the truth reads.
void compare(const World& w, const World& fine, std::uint32_t n) {
    constexpr std::size_t kDense = 65536;
    const Exact exact = exact_light(fine, kDense);
    const DirectionSet d = make_direction_set(kMap);
    std::vector<std::vector<float>> lights;
    for (const char* l : {"white", "studio", "sky:3,35"}) {
        const auto v = runtime::project_environment(make_environment(l).value(), kMap);
        std::vector<float> lum(kTexels);
        for (std::size_t k = 0; k < kTexels; ++k)
            lum[k] = formats::luminance({v.rgba[4 * k], v.rgba[4 * k + 1], v.rgba[4 * k + 2]});
        lights.push_back(lum);
    }
    std::vector<Receiver> at;
    const std::size_t wanted = 160;
    for (std::size_t i = 0; i < wanted; ++i)
        at.push_back(w.receivers[(2 * i + 1) * w.receivers.size() / (2 * wanted)]);
    std::vector<Row> truth(wanted), env(wanted);
    const auto gather = [&](const BounceTree& tree, const Receiver& from, const BounceGrid& grid,
                            LookUp look_up, std::uint64_t seed, Row& row) {
        std::vector<NodeWeight> weights;
        row.assign(kTexels, 0);
        const BounceGather found =
            weigh_bounces({w.scene, w.rays}, tree, from, grid, seed, weights, look_up);
        add_node_rows(tree, weights, row);
        return found.rays;
    };
    tbb::parallel_for(std::size_t{0}, wanted, [&](std::size_t i) {
        gather(*exact.tree, at[i], make_bounce_grid(16384), LookUp::nearest, 99, truth[i]);
        env[i] = env_row(w, d, at[i]);
    });
    double all_norm = 0;
    for (std::size_t i = 0; i < wanted; ++i)
        for (std::size_t k = 0; k < kTexels; ++k)
            all_norm += std::pow(double(truth[i][k]) + env[i][k], 2);
    std::printf(
        "%zu dense scatterers; RMS errors of bounced light in percent of all light (of that, what "
        "other seeds share)\nrays | rows | white | studio | sky\n",
        exact.points.size());
    BakeOptions options;
    options.set(kBounceRays, n);
    options.effects = {"direct", "interreflection"};
    std::uint64_t rays = 0;
    const Knobs knobs = resolve_knobs(options).value();
    const LightInputs asked{w.bake,    knobs, w.context,
                            w.layouts, {},    count_bounce_rays(knobs[kBounceRays])};
    const auto light = solve_exchange(asked, place_exchange(asked, rays), {}, rays);
    // Error, and of that what rays of other seeds share: errors of the look-up and of scatterers.
    constexpr std::uint64_t kSeeds = 8;
    const BounceGrid cut = make_cut_grid(n);
    std::vector<std::vector<Row>> rows(wanted, std::vector<Row>(kSeeds));
    std::vector<std::uint64_t> traced(wanted);
    tbb::parallel_for(std::size_t{0}, wanted, [&](std::size_t i) {
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
            traced[i] += gather(light->tree, at[i], cut, LookUp::kernel, seed, rows[i][seed]);
    });
    double err = 0, bias = 0, le[3]{}, lb[3]{}, la[3]{};
    for (std::size_t i = 0; i < wanted; ++i) {
        const auto add = [&](auto&& of_seed, double& e, double& b) {
            double sum = 0, squares = 0;
            for (std::size_t s = 0; s < kSeeds; ++s) {
                const double off = of_seed(rows[i][s]);
                sum += off;
                squares += off * off;
            }
            e += squares / kSeeds;
            // Without bias of its own: products of different seeds.
            b += (sum * sum - squares) / (kSeeds * (kSeeds - 1));
        };
        for (std::size_t k = 0; k < kTexels; ++k)
            add([&](const Row& r) { return double(r[k]) - truth[i][k]; }, err, bias);
        for (int l = 0; l < 3; ++l) {
            double all = 0;
            for (std::size_t k = 0; k < kTexels; ++k)
                all += (double(truth[i][k]) + env[i][k]) * lights[l][k];
            la[l] += all * all;
            add(
                [&](const Row& r) {
                    double off = 0;
                    for (std::size_t k = 0; k < kTexels; ++k)
                        off += (double(r[k]) - truth[i][k]) * lights[l][k];
                    return off;
                },
                le[l], lb[l]);
        }
    }
    std::uint64_t rays_of_all = 0;
    for (const std::uint64_t r : traced)
        rays_of_all += r;
    const auto percent = [](double a, double b) { return 100 * std::sqrt(std::max(0.0, a) / b); };
    std::printf("%.1f | %.3f (%.3f)", double(rays_of_all) / double(wanted * kSeeds),
                percent(err, all_norm), percent(bias, all_norm));
    for (int l = 0; l < 3; ++l)
        std::printf(" | %.3f (%.3f)", percent(le[l], la[l]), percent(lb[l], la[l]));
    std::printf("\n");
}

// The file against path tracing of all light.
void check(const formats::Scene& scene) {
    BakeOptions options;
    options.effects = {"direct", "interreflection"};
    options.quality = Quality::production;
    const BakeResult baked = run_bake(scene, resolve_knobs(options).value(), {}).value();
    ModelCheckOptions wanted;
    wanted.simulated = held_light(all_effects(), baked.plan);
    wanted.noise = 0.004;
    wanted.max_events = 100000000;
    const auto report = check_model(scene, baked.asset.view(), wanted, {}).value();
    for (const ModelErrorReport::Part& l : report.by_light) {
        std::printf("   %-28s rms %.4f mean %+.4f noise %.4f\n", l.name.c_str(), l.rms_relative,
                    l.bias, l.noise);
    }
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::interreflection_table(int argc, char** argv) {
    using namespace opaline;
    using namespace opaline::bake;
    const std::string what = argc > 1 ? argv[1] : "", name = argc > 2 ? argv[2] : "";
    const bool is_known = name == "box" || name == "room" || name == "ball" || name == "statue";
    const formats::Scene scene = name == "box" || name == "room" ? make_open_box(name == "box")
                                 : name == "ball"                ? tests::make_dented_ball()
                                                                 : example("statue");
    if (is_known && what == "gather" && argc > 3) {
        compare(World(scene), World(name == "ball" ? split(split(scene)) : scene),
                static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)));
    } else if (is_known && what == "truth") {
        check(scene);
    } else {
        std::fprintf(stderr,
                     "opaline_bench interreflection-table gather SCENE RAYS | truth SCENE\n");
        return 2;
    }
    return 0;
}
