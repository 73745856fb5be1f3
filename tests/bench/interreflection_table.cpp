// Bounced light of the bake against an exact final gather, against path tracing, and its cost.
//   opaline_interreflection_table gather SCENE RAYS: errors of 160 receivers against 16384 rays
//     that read the nearest of as many scatterers as there are, whose light is found with 256 rays
//     each.
//   ... truth SCENE: a file of production against path tracing of all light.
//   ... cost SCENE: seconds and rays of stages without and with interreflection.
// SCENE: box (a room open to the front, with a block in it), detailed (the same, of checkers),
// ball (dented, over a floor), statue; dense (the box of a mesh so fine that receivers read sites).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>
#include <memory>
#include "bake/accuracy/check_model.h"
#include "bake/effects/effects.h"
#include "bake/effects/interreflection/add_bounced.h"
#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/bounce_light.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/effects/interreflection/scatterers.h"
#include "bake/environment/builtin_environment.h"
#include "bake/example/example_scenes.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/gltf/import_gltf.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/light_vector.h"
#include "tests/bench/visible_footprint.h"
#include "tests/support/bake.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMap = kBounceCubemap;
constexpr std::size_t kTexels = 6 * kMap * kMap;

formats::Scene make_open_box(bool detailed, std::uint32_t n) {
    using tests::make_quad;
    formats::Scene scene = tests::make_scene({
        make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n),  // floor, up
        make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n),  // ceiling, down
        make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n),  // back, toward +z
        make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n),  // left, toward +x
        make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n),  // right, toward -x
    });
    auto block =
        tests::transformed(tests::make_cube(6, false), glm::mat3(1), 0.15f, {0.4f, 0.16f, 0.4f});
    scene.primitives.push_back(block);
    scene.primitives.back().material = 0;
    scene.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    if (detailed) {
        for (auto& p : scene.primitives) {
            for (std::size_t v = 0; v < p.position.size(); ++v) {
                const glm::vec3 x = p.position[v];
                const int c =
                    static_cast<int>(std::floor(x.x * 12 + .01f) + std::floor(x.y * 12 + .01f) +
                                     std::floor(x.z * 12 + .01f));
                const float a = c & 1 ? 1.2f : 0.15f;
                p.color.push_back({a, a, a});
            }
        }
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
        const float rho = formats::luminance(e.points[i].albedo);
        for (std::size_t k = 0; k < kTexels; ++k)
            emitted[i * kTexels + k] = rho * r[k];
        weigh_bounces(w.scene, w.rays, *e.tree, e.points[i].outside, grid, 77, arrive[i],
                      LookUp::nearest);
    });
    sum = emitted;
    std::vector<float> last = emitted;
    for (int b = 0; b < 24; ++b) {
        e.tree->set_rows({last, kTexels});
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            Row r(kTexels);
            add_node_rows(*e.tree, arrive[i], r);
            const float rho = formats::luminance(e.points[i].albedo);
            for (std::size_t k = 0; k < kTexels; ++k) {
                last[i * kTexels + k] = rho * r[k];
                sum[i * kTexels + k] += rho * r[k];
            }
        });
    }
    e.tree->set_rows({sum, kTexels});
    return e;
}

void compare(const World& w, std::uint32_t n) {
    constexpr std::size_t kDense = 65536;
    const Exact exact = exact_light(w, kDense);
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
    const auto gather = [&](const BounceTree& tree, std::size_t i, std::uint32_t count,
                            LookUp look_up, std::uint64_t seed) {
        std::vector<NodeWeight> weights;
        weigh_bounces(w.scene, w.rays, tree, at[i], make_bounce_grid(count), seed, weights,
                      look_up);
        Row r(kTexels);
        add_node_rows(tree, weights, r);
        return r;
    };
    tbb::parallel_for(std::size_t{0}, wanted, [&](std::size_t i) {
        truth[i] = gather(*exact.tree, i, 16384, LookUp::nearest, 99);
        env[i] = env_row(w, d, at[i]);
    });
    double bounced_norm = 0, all_norm = 0;
    for (std::size_t i = 0; i < wanted; ++i)
        for (std::size_t k = 0; k < kTexels; ++k) {
            bounced_norm += double(truth[i][k]) * truth[i][k];
            all_norm += std::pow(double(truth[i][k]) + env[i][k], 2);
        }
    std::printf(
        "%zu dense scatterers; errors of bounced light, and relative to all: rows, white, "
        "studio, sky; mean\n",
        exact.points.size());
    const auto report = [&](const char* what, auto&& own) {
        std::vector<Row> rows(wanted);
        tbb::parallel_for(std::size_t{0}, wanted, [&](std::size_t i) { rows[i] = own(i); });
        double err = 0;
        double le[3]{}, lb[3]{}, la[3]{}, mean = 0, tm = 0;
        for (std::size_t i = 0; i < wanted; ++i) {
            for (std::size_t k = 0; k < kTexels; ++k)
                err += std::pow(double(rows[i][k]) - truth[i][k], 2);
            for (int l = 0; l < 3; ++l) {
                double a = 0, t = 0, e = 0;
                for (std::size_t k = 0; k < kTexels; ++k) {
                    a += double(rows[i][k]) * lights[l][k];
                    t += double(truth[i][k]) * lights[l][k];
                    e += double(env[i][k]) * lights[l][k];
                }
                le[l] += (a - t) * (a - t);
                lb[l] += t * t;
                la[l] += (t + e) * (t + e);
                if (l == 0) {
                    mean += a - t;
                    tm += t;
                }
            }
        }
        std::printf("%-26s | %.4f %.4f %.4f %.4f | %.4f %.4f %.4f %.4f | %+.4f\n", what,
                    std::sqrt(err / bounced_norm), std::sqrt(le[0] / lb[0]),
                    std::sqrt(le[1] / lb[1]), std::sqrt(le[2] / lb[2]), std::sqrt(err / all_norm),
                    std::sqrt(le[0] / la[0]), std::sqrt(le[1] / la[1]), std::sqrt(le[2] / la[2]),
                    mean / tm);
        std::fflush(stdout);
    };
    BakeOptions options;
    options.set(kBounceRays, n);
    options.effects = {"direct", "interreflection"};
    std::uint64_t rays = 0;
    const auto light = find_bounce_light(
        {w.bake, resolve_knobs(options).value(), w.context, w.layouts, {}, {}}, rays);
    const auto with = [&](const BounceTree& tree, LookUp look_up) {
        return
            [&tree, &gather, n, look_up](std::size_t i) { return gather(tree, i, n, look_up, 0); };
    };
    report("nearest scatterer", with(light->tree, LookUp::nearest));
    report("node", with(light->tree, LookUp::node));
    report("kernel", with(light->tree, LookUp::kernel));
    std::vector<HiddenNodes> nodes(wanted);
    for (const bool only_seen : {false, true}) {
        report(only_seen ? "kernel, seen nodes" : "kernel without tilt", [&](std::size_t i) {
            std::vector<NodeWeight> weights;
            nodes[i] = weigh_seen_nodes(w.scene, w.rays, light->tree, at[i], make_bounce_grid(n), 0,
                                        only_seen, weights);
            Row r(kTexels);
            add_node_rows(light->tree, weights, r);
            return r;
        });
    }
    HiddenNodes all;
    for (const HiddenNodes& own : nodes) {
        all.looked_at += own.looked_at;
        all.hidden += own.hidden;
    }
    std::printf("%.1f rays to nodes a receiver, %.1f %% hidden\n",
                static_cast<double>(all.looked_at) / static_cast<double>(wanted),
                100.0 * static_cast<double>(all.hidden) /
                    static_cast<double>(std::max<std::uint64_t>(all.looked_at, 1)));
    std::vector<std::uint64_t> traced(wanted);
    report("as baked", [&](std::size_t i) {
        Row r(kTexels * light->bands);
        traced[i] = add_bounced(*light, {at[i]}, kMap, r);
        r.resize(kTexels);
        return r;
    });
    {
        double part[2]{};
        for (std::size_t i = 0; i < wanted; ++i) {
            Row r(kTexels * light->bands);
            add_bounced(*light, {at[i]}, kMap, r);
            for (std::size_t k = 0; k < kTexels; ++k)
                part[traced[i] > 0] += std::pow(double(r[k]) - truth[i][k], 2);
        }
        std::printf("of rows: fitted %.4f, own rays %.4f\n", std::sqrt(part[0] / all_norm),
                    std::sqrt(part[1] / all_norm));
    }
    std::printf("%.1f %% of receivers trace rays of their own\n",
                100.0 *
                    static_cast<double>(
                        std::ranges::count_if(traced, [](std::uint64_t r) { return r > 0; })) /
                    static_cast<double>(wanted));
    report("exact vectors, same rays", with(*exact.tree, LookUp::nearest));
    report("kernel, dense scatterers", with(*exact.tree, LookUp::kernel));
}

// Prints stages; rays of a stage do not depend on what else the machine does.
BakeResult bake_and_print(const formats::Scene& scene, Quality quality,
                          std::vector<std::string> effects) {
    BakeOptions options;
    options.effects = std::move(effects);
    options.quality = quality;
    BakeResult baked = run_bake(scene, resolve_knobs(options).value(), {}).value();
    for (const StageReport& stage : baked.stages) {
        std::printf("   %-36s %8.2f s %12.0f rays\n", stage.name.c_str(), stage.seconds,
                    static_cast<double>(stage.rays));
    }
    std::printf("   numerical error %.4f, %.1f s\n", baked.error.rms_relative, baked.seconds_total);
    std::fflush(stdout);
    return baked;
}

// The file against path tracing of all light.
void check(const formats::Scene& scene, Quality quality) {
    const BakeResult baked = bake_and_print(scene, quality, {"direct", "interreflection"});
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

int main(int argc, char** argv) {
    using namespace opaline;
    using namespace opaline::bake;
    const std::string what = argc > 1 ? argv[1] : "", name = argc > 2 ? argv[2] : "";
    const bool is_known = name == "box" || name == "detailed" || name == "dense" ||
                          name == "ball" || name == "statue";
    const formats::Scene scene = name == "box"        ? make_open_box(false, 24)
                                 : name == "detailed" ? make_open_box(true, 24)
                                 : name == "dense"    ? make_open_box(false, 64)
                                 : name == "ball"     ? tests::make_dented_ball()
                                                      : example("statue");
    if (is_known && what == "gather" && argc > 3) {
        compare(World(scene), static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)));
    } else if (is_known && what == "truth") {
        check(scene, Quality::production);
    } else if (is_known && what == "cost") {
        for (const Quality quality : {Quality::draft, Quality::production}) {
            bake_and_print(scene, quality, {"direct"});
            bake_and_print(scene, quality, {"direct", "interreflection"});
        }
    } else {
        std::fprintf(
            stderr, "opaline_interreflection_table gather SCENE RAYS | truth SCENE | cost SCENE\n");
        return 2;
    }
    return 0;
}
