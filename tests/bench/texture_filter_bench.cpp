// What filtering textures over the footprints of paths saves the reference, and what it costs. A
// glossy squashed ball over a board of 512 x 512 texels (a checkerboard and sines, 128 to the
// metre), 64 x 64 pixels; the board lit evenly through its back, so that the texture is all that
// varies. Pixels count whose mirrored ray meets the board. Lobes as wide as a power S around the
// mirrored direction: alpha = sqrt(2 / (4 S + 2)).
//
//   opaline_bench_texture_filter
//
// Prints, over 8 seeds, RMSE at 4 samples a pixel, of that its noise and bias; how often lower it
// is than without a filter, on the mean and on the worst seed; and the same at equal time (error as
// samples^(-1/2)). Time is the processor's, the least of 40 runs, all in turns; `columns`: of a
// filter whose footprints are below a texel, the share that following them takes. `two mirrors`:
// the board seen in one rough mirror in another, where the gradient limit acts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "bake/reference/path_filter.h"
#include "bake/reference/reference_image.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSide = 64, kTexels = 512, kSamples = 4, kSeeds = 8, kTruth = 2048;

formats::Image8 board_image() {
    formats::Image8 image{kTexels, kTexels, {}};
    image.rgba.reserve(4 * std::size_t{kTexels} * kTexels);
    for (std::uint32_t y = 0; y < kTexels; ++y) {
        for (std::uint32_t x = 0; x < kTexels; ++x) {
            const double wave = 0.25 * (2 + std::sin(0.37 * x) + std::sin(0.23 * y));
            const bool bright = (x / 32 + y / 32) % 2 == 0;
            const auto code =
                static_cast<std::uint8_t>(255 * (bright ? 0.5 + 0.5 * wave : 0.4 * wave));
            image.rgba.insert(image.rgba.end(), {code, code, code, 255});
        }
    }
    return image;
}

formats::Material mirror_of(double exponent) {
    formats::Material mirror;
    mirror.gloss.metallic = mirror.gloss.specular = 1;
    mirror.gloss.roughness = static_cast<float>(std::pow(2 / (4 * exponent + 2), 0.25));
    return mirror;
}

struct Bench {
    formats::Scene input;
    formats::Environment dark;
    std::unique_ptr<ReferenceScene> scene;
    LightSampler light;
    PathOptions paths;
    runtime::Camera camera;
    std::vector<bool> counts;  ///< by pixel

    Estimate run(std::uint32_t samples, std::uint64_t seed,
                 const TextureFiltering* filtering) const {
        EstimateOptions options;
        options.samples = samples;
        options.seed = seed;
        Context context;
        context.threads = 1;
        auto image = estimate_image({*scene, light, paths, filtering}, camera, options, context);
        return std::move(image->estimate);
    }
};

// Whether the ray that `events` mirrors reflect from the middle of a pixel shows the board.
bool shows_board(const Bench& bench, std::uint32_t pixel, std::uint32_t events) {
    const runtime::CameraFrame frame = runtime::camera_frame(bench.camera);
    const formats::Vec3 ray =
        runtime::view_ray(bench.camera, frame, pixel % kSide + 0.5, pixel / kSide + 0.5);
    RayOrigin from{{bench.camera.eye.x, bench.camera.eye.y, bench.camera.eye.z}};
    glm::vec3 d(ray.x, ray.y, ray.z);
    for (std::uint32_t i = 0; i <= events; ++i) {
        const auto hit = bench.scene->surfaces.closest_hit(from, d, 1e9f);
        // Far enough down that the whole lobe meets the board.
        constexpr float kSteep = 0.8f;
        if (!hit || (hit->primitive == 0) != (i == events) || (i == events && d.y > -kSteep)) {
            return false;
        }
        d = glm::reflect(d, hit->smooth);
        from = leave_surface(*hit, d);
    }
    return true;
}

std::unique_ptr<Bench> make_bench(double exponent, std::uint32_t events) {
    auto bench = std::make_unique<Bench>();
    tests::Scene scene =
        tests::make_scene({tests::make_quad({-100, 0, 100}, {200, 0, 0}, {0, 0, -200})});
    for (const glm::vec3& p : scene.primitives[0].position) {
        scene.primitives[0].texcoord.emplace_back(p.x / 4, p.z / 4);
    }
    scene.images = {board_image()};
    scene.materials[0].base_color_image = 0;
    scene.materials[0].double_sided = true;
    scene.materials[0].sheet = formats::Sheet{{0, 0, 0}, {1, 1, 1}};
    scene.materials.push_back(mirror_of(exponent));
    formats::Light& sun = scene.lights.emplace_back();
    sun.type = formats::Light::Type::directional;
    sun.direction = {0, 1, 0};
    const float pi = std::numbers::pi_v<float>;
    sun.intensity = {pi, pi, pi};
    if (events == 1) {
        tests::Primitive ball = tests::make_sphere(5);
        for (std::size_t i = 0; i < ball.position.size(); ++i) {
            ball.normal[i] = glm::normalize(ball.position[i] / glm::vec3(1, 0.7f, 1));
            ball.position[i] = ball.position[i] * glm::vec3(1, 0.7f, 1) + glm::vec3(0, 1.2f, 0);
        }
        scene.primitives.push_back(std::move(ball));
        bench->camera.eye = {0, 0.1f, 2};
        bench->camera.target = {0, 0.9f, 0};
        bench->camera.fov_y = 32;
    } else {
        // Up from a plate that leans back to one that faces down, and on to the board.
        const float lean = 0.7f, sine = std::sin(lean), cosine = std::cos(lean);
        const glm::vec3 right(1, 0, 0), up(0, cosine, -sine);
        scene.primitives.push_back(
            tests::make_quad(glm::vec3(0, 1, 0) - 0.8f * right - 0.5f * up, 1.6f * right, up));
        scene.primitives.push_back(tests::make_quad({-3, 2.5f, -3}, {6, 0, 0}, {0, 0, 6}));
        scene.primitives[2].material = 1;
        bench->camera.eye = {0, 1, 3};
        bench->camera.target = {0, 1, 0};
        bench->camera.fov_y = 20;
    }
    scene.primitives[1].material = 1;
    bench->camera.width = bench->camera.height = kSide;
    bench->input = std::move(scene);
    bench->scene = std::make_unique<ReferenceScene>(make_reference_scene(bench->input, 1).value());
    bench->light = make_light_sampler(bench->dark, glm::mat3(1.0f));
    bench->paths.max_depth = events + 1;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        bench->counts.push_back(shows_board(*bench, i, events));
    }
    return bench;
}

/// Over the pixels that count.
struct Errors {
    double rmse = 0, noise = 0, bias = 0;
    std::array<double, kSeeds> seed{};
};
Errors measure_errors(const Bench& bench, const Estimate& truth, const TextureFiltering* way) {
    Errors errors;
    std::vector<double> sum(kSide * kSide), squares(kSide * kSide);
    double pixels = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Estimate image = bench.run(kSamples, seed, way);
        double total = 0;
        pixels = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            if (bench.counts[i]) {
                const double off = image.pixel[i].mean.y - truth.pixel[i].mean.y;
                sum[i] += off;
                squares[i] += off * off;
                total += off * off;
                pixels += 1;
            }
        }
        errors.seed[seed] = std::sqrt(total / pixels);
        errors.rmse += errors.seed[seed] / kSeeds;
    }
    double noise = 0, all = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        noise += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
        all += squares[i] / kSeeds;
    }
    errors.noise = std::sqrt(noise / pixels);
    errors.bias = std::sqrt(std::max(0.0, all - noise) / pixels);
    return errors;
}

double seconds_of(const Bench& bench, const TextureFiltering* way) {
    const std::clock_t start = std::clock();
    bench.run(2 * kSamples, 99, way);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void compare(const char* name, double exponent, std::uint32_t events) {
    const auto bench = make_bench(exponent, events);
    const Estimate truth = bench->run(kTruth, 1000, nullptr);
    const float extent = 2 * glm::length(bench->scene->surfaces.half_size());
    const TextureFiltering local{make_scene_pyramids(bench->input),
                                 1 / std::sqrt(static_cast<float>(kSamples)),
                                 std::numeric_limits<float>::infinity(), extent};
    TextureFiltering limited = local, thin = local;
    limited.gradient_limit = 0.7f;
    thin.step = 1e-6f;
    const std::array<const TextureFiltering*, 4> ways{nullptr, &local, &limited, &thin};
    std::array<double, 4> seconds;
    seconds.fill(1e9);
    for (int repeat = 0; repeat < 40; ++repeat) {
        for (std::size_t way = 0; way < ways.size(); ++way) {
            seconds[way] = std::min(seconds[way], seconds_of(*bench, ways[way]));
        }
    }
    const Errors plain = measure_errors(*bench, truth, nullptr);
    std::printf("%s: %td pixels, without a filter RMSE %.4f (noise %.4f), columns %+.1f %%\n", name,
                std::count(bench->counts.begin(), bench->counts.end(), true), plain.rmse,
                plain.noise, 100 * (seconds[3] / seconds[0] - 1));
    const std::array<const char*, 3> names{"", "local", "limited"};
    for (std::size_t way = 1; way < 3; ++way) {
        const Errors own = measure_errors(*bench, truth, ways[way]);
        double worst = 1e9;
        for (std::size_t seed = 0; seed < kSeeds; ++seed) {
            worst = std::min(worst, plain.seed[seed] / own.seed[seed]);
        }
        const double ratio = plain.rmse / own.rmse, time = seconds[way] / seconds[0];
        std::printf(
            "  %-8s RMSE %.4f (noise %.4f, bias %.4f)  %.2fx, worst seed %.2fx; time "
            "%+.1f %%, at equal time %.2fx\n",
            names[way], own.rmse, own.noise, own.bias, ratio, worst, 100 * (time - 1),
            ratio / std::sqrt(time));
    }
}

}  // namespace
}  // namespace opaline::bake

int main() {
    opaline::bake::compare("S = 40", 40, 1);
    opaline::bake::compare("S = 400", 400, 1);
    opaline::bake::compare("S = 40, two mirrors", 40, 2);
    opaline::bake::compare("S = 400, two mirrors", 400, 2);
}
