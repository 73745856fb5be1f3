// What filtering textures over the footprints of paths saves the reference, and what it costs. A
// glossy squashed ball over a board of 512 x 512 texels (a checkerboard and sines, 128 to the
// metre), 64 x 64 pixels; the board lit evenly through its back, so that the texture is all that
// varies. Pixels count whose mirrored ray meets the board. Lobes as wide as a power S around the
// mirrored direction: alpha = sqrt(2 / (4 S + 2)).
//
//   opaline_bench texture-filter
//
// Prints, over 8 seeds, RMSE at 4 samples a pixel, of that its noise and bias; how often lower it
// is than without a filter, on the mean and on the worst seed; and the same at equal time: than
// without a filter at so many samples as take at least as long. Time is the processor's, the median
// of 31 runs, all in turns; `columns`: of a filter whose footprints are below a texel, the share
// that following them takes. `two mirrors`: the board seen in one rough mirror in another; `glass`:
// through a lens of rough glass over it, which refracts twice. There the gradient limit acts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "bake/reference/path_filter.h"
#include "bake/reference/reference_receivers.h"
#include "tests/bench/bench.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr float kIndex = 1.5f;
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

float roughness_of(double exponent) {
    return static_cast<float>(std::pow(2 / (4 * exponent + 2), 0.25));
}

formats::Material mirror_of(double exponent) {
    formats::Material mirror;
    mirror.gloss.metallic = mirror.gloss.specular = 1;
    mirror.gloss.roughness = roughness_of(exponent);
    return mirror;
}

formats::Material glass_of(double exponent) {
    formats::Material glass;
    formats::Medium& inside = glass.medium.emplace();
    inside.sigma_s = {0, 0, 0};
    inside.sigma_a = {1e-9f, 1e-9f, 1e-9f};
    inside.eta = kIndex;
    inside.roughness = roughness_of(exponent);
    return glass;
}

/// What a pixel shows the board by.
enum class View { ball, two_mirrors, glass };

std::uint32_t events_of(View view) {
    return view == View::ball ? 1 : 2;
}

struct Bench {
    formats::Scene input;
    formats::Environment sky;
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

// Whether the ray that smooth mirrors or smooth glass would make of the middle of a pixel shows the
// board.
bool shows_board(const Bench& bench, std::uint32_t pixel, View view) {
    const runtime::CameraFrame frame = runtime::camera_frame(bench.camera);
    const formats::Vec3 ray =
        runtime::view_ray(bench.camera, frame, pixel % kSide + 0.5, pixel / kSide + 0.5);
    RayOrigin from{{bench.camera.eye.x, bench.camera.eye.y, bench.camera.eye.z}};
    glm::vec3 d(ray.x, ray.y, ray.z);
    const std::uint32_t events = events_of(view);
    for (std::uint32_t i = 0; i <= events; ++i) {
        const auto hit = bench.scene->surfaces.closest_hit(from, d, 1e9f);
        // Far enough down that the whole lobe meets the board.
        constexpr float kSteep = 0.8f;
        if (!hit || (hit->primitive == 0) != (i == events) || (i == events && d.y > -kSteep)) {
            return false;
        }
        const float side = glm::dot(d, hit->smooth) < 0 ? 1.0f : -1.0f;
        d = view == View::glass
                ? glm::refract(d, side * hit->smooth, side > 0 ? 1 / kIndex : kIndex)
                : glm::reflect(d, hit->smooth);
        if (d == glm::vec3(0)) return false;
        from = leave_surface(*hit, d);
    }
    return true;
}

// A ball of level 5, squashed.
tests::Primitive squashed_ball(glm::vec3 radii, glm::vec3 centre) {
    tests::Primitive ball = tests::make_sphere(5);
    for (std::size_t i = 0; i < ball.position.size(); ++i) {
        ball.normal[i] = glm::normalize(ball.position[i] / radii);
        ball.position[i] = ball.position[i] * radii + centre;
    }
    return ball;
}

// The mean of the board's light from above, so that what glass mirrors adds little noise.
formats::Environment even_sky() {
    formats::Environment sky;
    sky.width = 2;
    sky.height = 512;
    for (std::uint32_t row = 0; row < sky.height; ++row) {
        const float value = row < sky.height / 2 ? 0.38f : 0;
        sky.pixel.insert(sky.pixel.end(), 2, {value, value, value});
    }
    return sky;
}

std::unique_ptr<Bench> make_bench(double exponent, View view) {
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
    scene.materials.push_back(view == View::glass ? glass_of(exponent) : mirror_of(exponent));
    formats::Light& sun = scene.lights.emplace_back();
    sun.type = formats::Light::Type::directional;
    sun.direction = {0, 1, 0};
    const float pi = std::numbers::pi_v<float>;
    sun.intensity = {pi, pi, pi};
    if (view == View::glass) {
        scene.primitives.push_back(squashed_ball({0.9f, 0.3f, 0.9f}, {0, 0.7f, 0}));
        bench->sky = even_sky();
        bench->camera.eye = {0, 2.6f, 0.5f};
        bench->camera.target = {0, 0.7f, 0};
        bench->camera.fov_y = 46;
    } else if (view == View::ball) {
        scene.primitives.push_back(squashed_ball({1, 0.7f, 1}, {0, 1.2f, 0}));
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
    bench->light = make_light_sampler(bench->sky, glm::mat3(1.0f));
    bench->paths.max_depth = events_of(view) + 1;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        bench->counts.push_back(shows_board(*bench, i, view));
    }
    return bench;
}

/// Over the pixels that count.
struct Errors {
    double rmse = 0, noise = 0, bias = 0;
    std::array<double, kSeeds> seed{};
};
Errors measure_errors(const Bench& bench, const Estimate& truth, std::uint32_t samples,
                      const TextureFiltering* way) {
    Errors errors;
    std::vector<double> sum(kSide * kSide), squares(kSide * kSide);
    double pixels = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Estimate image = bench.run(samples, seed, way);
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

/// One way to make a picture, and the median time of it.
struct Way {
    const char* name;
    std::uint32_t samples;
    const TextureFiltering* filtering;
    double seconds = 0;
};

void measure_seconds(const Bench& bench, std::span<Way> ways) {
    constexpr std::size_t kRepeats = 31;
    std::vector<std::vector<double>> taken(ways.size());
    for (std::size_t repeat = 0; repeat < kRepeats; ++repeat) {
        for (std::size_t i = 0; i < ways.size(); ++i) {
            const std::clock_t start = std::clock();
            bench.run(ways[i].samples, 99, ways[i].filtering);
            taken[i].push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
        std::sort(taken[i].begin(), taken[i].end());
        ways[i].seconds = taken[i][kRepeats / 2];
    }
}

struct Gain {
    double mean = 0, worst = 1e9;
};
Gain gain_of(const Errors& own, const Errors& other) {
    Gain gain{other.rmse / own.rmse};
    for (std::size_t seed = 0; seed < kSeeds; ++seed) {
        gain.worst = std::min(gain.worst, other.seed[seed] / own.seed[seed]);
    }
    return gain;
}

void compare(const char* name, double exponent, View view) {
    const auto bench = make_bench(exponent, view);
    const Estimate truth = bench->run(kTruth, 1000, nullptr);
    const float extent = 2 * glm::length(bench->scene->surfaces.half_size());
    const TextureFiltering local{make_scene_pyramids(bench->input),
                                 1 / std::sqrt(static_cast<float>(kSamples)),
                                 std::numeric_limits<float>::infinity(), extent};
    TextureFiltering limited = local, thin = local;
    limited.gradient_limit = 0.7f;
    thin.step = 1e-6f;
    std::vector<Way> ways{
        {"local", kSamples, &local}, {"limited", kSamples, &limited}, {"columns", kSamples, &thin}};
    for (std::uint32_t more = 0; more < 4; ++more) {
        ways.push_back({"without", kSamples + more, nullptr});
    }
    measure_seconds(*bench, ways);
    const std::span<const Way> unfiltered = std::span(ways).subspan(3);
    std::vector<Errors> plain;
    for (const Way& way : unfiltered) {
        plain.push_back(measure_errors(*bench, truth, way.samples, nullptr));
    }
    const auto overhead = [&](const Way& way) {
        return 100 * (way.seconds / unfiltered[0].seconds - 1);
    };
    std::printf("%s: %td pixels, without a filter RMSE %.4f (noise %.4f), columns %+.1f %%\n", name,
                std::count(bench->counts.begin(), bench->counts.end(), true), plain[0].rmse,
                plain[0].noise, overhead(ways[2]));
    for (const Way& way : std::span(ways).first(2)) {
        const Errors own = measure_errors(*bench, truth, kSamples, way.filtering);
        std::size_t equal = 0;
        while (equal + 1 < unfiltered.size() && unfiltered[equal].seconds < way.seconds) {
            ++equal;
        }
        const Gain samples = gain_of(own, plain[0]), time = gain_of(own, plain[equal]);
        std::printf(
            "  %-8s RMSE %.4f (noise %.4f, bias %.4f)  %.2fx, worst seed %.2fx; time %+.1f %%, at "
            "equal time (%u samples, %+.1f %%) %.2fx, worst seed %.2fx\n",
            way.name, own.rmse, own.noise, own.bias, samples.mean, samples.worst, overhead(way),
            unfiltered[equal].samples, overhead(unfiltered[equal]), time.mean, time.worst);
    }
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::texture_filter(int, char**) {
    using opaline::bake::View;
    opaline::bake::compare("S = 40", 40, View::ball);
    opaline::bake::compare("S = 400", 400, View::ball);
    opaline::bake::compare("S = 40, two mirrors", 40, View::two_mirrors);
    opaline::bake::compare("S = 400, two mirrors", 400, View::two_mirrors);
    opaline::bake::compare("S = 40, glass", 40, View::glass);
    opaline::bake::compare("S = 400, glass", 400, View::glass);
    return 0;
}
