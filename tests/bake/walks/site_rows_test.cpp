#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/effects/multiple/walks/site_row_sum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bake/effects/multiple/sample_transport.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/physics/fresnel.h"
#include "bake/receivers/surface_samples.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

using bake::SurfaceSample;

constexpr std::uint32_t kCubemap = 8;
constexpr std::uint32_t kAll = formats::cubemap_texels(kCubemap);

struct WalkedBall {
    std::unique_ptr<WalkedBody> body;
    std::vector<SurfaceSample> samples;
    bake::SampleTransport transport;
    double eta = 1, escape = 1;
};

WalkedBall make_body(Primitive shape, const formats::Medium& medium, std::uint32_t samples) {
    WalkedBall ball;
    ball.body = make_walked_body(std::move(shape), medium);
    ball.eta = static_cast<double>(ball.body->space.eta);
    ball.samples = bake::sample_surface(ball.body->scene, {0}, samples, 0, {});
    const auto sky = bake::RayScene::build({}, 1).value();
    ball.transport =
        bake::bake_sample_transport(sky, ball.samples, {kCubemap, kAll, ball.eta, true}, {});
    ball.escape = 1 - bake::fresnel_moments(ball.eta).external;
    return ball;
}

WalkedBall make_ball(float sigma_t, float albedo, float eta = 1.3f) {
    return make_body(make_sphere(3), make_forward_medium(sigma_t, albedo, 0, eta), 1500);
}

bake::ExitLight light_of(const WalkedBall& ball, bool has_cells = false) {
    std::optional<bake::ExitCells> cells;
    if (has_cells) cells.emplace(ball.samples, kCubemap, bake::make_exit_lobe(ball.eta));
    return {ball.samples, ball.transport.rows, std::move(cells), ball.escape};
}

bake::WalkStageOptions rows_within(double radius, double walks, std::uint32_t views) {
    return {.radius = radius,
            .walks = walks,
            .views = views,
            .rows = {.cubemap_size = kCubemap, .kept = kAll, .bands = 1, .seed = 0, .orders = {1}}};
}

// Of the row under white light, over 4 pi.
double white(std::span<const float> haar_row) {
    std::vector<double> light;
    for (int face = 0; face < 6; ++face) {
        const auto own = formats::texel_solid_angles(kCubemap);
        light.insert(light.end(), own.begin(), own.end());
    }
    formats::haar_forward_cube(std::span(light), kCubemap);
    double sum = 0;
    for (std::size_t k = 0; k < light.size(); ++k) {
        sum += light[k] * static_cast<double>(haar_row[k]) / (4 * std::numbers::pi);
    }
    return sum;
}

bake::BodyPoint body_point(const SurfaceSample& at) {
    return {at.position, at.normal, at.position - 1e-5f * at.geometric_normal, 0};
}

// T_0 of a receiver, one band, and its rows by view one after the other.
void add_rows(const bake::WalkStage& stage, const bake::BodyPoint& point, std::span<float> row,
              std::span<float> views) {
    if (stage.inner.empty()) {
        bake::add_walked_rows(stage, point, 1, row, views);
        return;
    }
    const auto count = static_cast<std::uint32_t>(1 + views.size() / row.size());
    const bake::SiteRowSum sum = bake::sum_inner_rows(stage, point, row.size(), count);
    std::vector<float> all(count * row.size());
    std::vector<bake::SiteRowSum::Share> shares(count);
    for (std::uint32_t r = 0; r < count; ++r) {
        shares[r].term = r;
        shares[r].of_row[r] = 1;
    }
    sum.add_to(shares, {all, kCubemap, count, 1});
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(row.size());
    std::copy(all.begin(), end, row.begin());
    std::copy(end, all.end(), views.begin());
}

// A ball of albedo 1 in an even sky shows the sky's radiance, whatever row it is.
TEST(SiteRows, BallOfAlbedoOneInAnEvenSkyShowsTheSky) {
    const WalkedBall ball = make_ball(20, 1);
    for (const bool inside : {false, true}) {
        const auto sites = bake::place_sites(ball.body->space, {300, 0.4, false}, 0, {});
        bake::WalkStageOptions options = rows_within(0.4, 30000, 1);
        options.is_inside = inside;
        options.rows.kept = 200;
        const bake::WalkStage stage =
            bake::take_walks(ball.body->space, light_of(ball, true), sites, options, {}, {});
        double sum = 0;
        constexpr int kPoints = 50;
        for (int i = 0; i < kPoints; ++i) {
            std::vector<float> row(kAll);
            add_rows(stage, body_point(ball.samples[static_cast<std::size_t>(i * 29)]), row, {});
            sum += 4 * std::numbers::pi * white(row) / kPoints;
        }
        // An even cube is no even sky, and light-free rows err by the truncated entries: a few per
        // cent.
        EXPECT_NEAR(sum, 1, 0.03) << inside;
        EXPECT_EQ(stage.counts.walks, 30000u);
        EXPECT_LT(stage.counts.lost, 3u);
    }
}

// Light of which every exit sees 1 in each band, and nothing else.
bake::SparseVectors make_unit_light(const WalkedBall& ball) {
    bake::SparseVectors light;
    for (const SurfaceSample& s : ball.samples) {
        if (light.size() % bake::SparseVectors::kPerBlock == 0) {
            light.blocks.emplace_back();
        }
        bake::SparseVectors::Block& block = light.blocks.back();
        block.index.push_back(0);
        block.value.push_back(std::numbers::pi_v<float> * static_cast<float>(ball.escape) * s.area);
        block.offset.push_back(static_cast<std::uint32_t>(block.index.size()));
    }
    return light;
}

// Sixteen walks, bands that fly apart, and sites on the surface or inside: what leaves, what
// crosses and what is absorbed add up to 1 at every site, so that nothing is won where nothing is
// absorbed.
TEST(SiteRows, OfEverySiteAndBandAddUpToAllLightLessWhatIsAbsorbed) {
    for (const float sigma_a : {0.0f, 3.0f}) {
        WalkedBall ball = make_ball(20, 1);
        ball.body->scene.materials[0].medium =
            make_coloured_medium({20, 40, 90}, {sigma_a, sigma_a, 0});
        ball.body->space = bake::make_walk_space(ball.body->scene, *ball.body->triangles, 0, false);
        ASSERT_EQ(ball.body->space.bands.size(), 3u);
        const bake::SparseVectors unit = make_unit_light(ball);
        const bake::ExitLight light(ball.samples, unit, std::nullopt, ball.escape);
        for (const bool inside : {false, true}) {
            const auto sites = bake::place_sites(ball.body->space, {200, 0.4, false}, 0, {});
            bake::WalkStageOptions options = rows_within(0.4, 200.0 * 3 * 16, 1);
            options.is_inside = inside;
            options.rows.bands = 3;
            options.rows.orders.fills_crossed = true;
            const bake::WalkStage stage =
                bake::take_walks(ball.body->space, light, sites, options, {}, {});
            std::array<double, 3> mean{};
            for (std::size_t site = 0; site < sites.size(); ++site) {
                std::vector<float> row(4 * kAll);
                bake::add_site_row(stage.rows, site, 0, glm::vec3(1), row);
                for (std::size_t b = 0; b < 3; ++b) {
                    mean[b] += static_cast<double>(row[b]) / static_cast<double>(sites.size());
                    if (sigma_a == 0 || b == 2) {
                        EXPECT_NEAR(row[b], 1, 1e-5f) << inside << " " << site << " " << b;
                    } else {
                        EXPECT_LT(row[b], 1) << inside << " " << site << " " << b;
                    }
                }
            }
            for (std::size_t b = 0; b < 3; ++b) {
                const double left = stage.counts.ends.left[b] / stage.counts.ends.finished(b);
                EXPECT_NEAR(mean[b] / left, 1, 0.02) << inside << " " << b;
            }
        }
    }
}

// Walks begin where some receiver reads their row; the rows of receivers are the same, bit by bit.
TEST(SiteRows, SitesThatNoReceiverReadsTakeNoWalks) {
    const WalkedBall ball = make_ball(20, 0.9f);
    const bake::ExitLight light = light_of(ball);
    constexpr std::uint32_t kSites = 2000;
    const auto sites = bake::place_sites(ball.body->space, {kSites, 0.1, false}, 0, {});
    const std::vector<bake::BodyPoint> served{body_point(ball.samples[3]),
                                              body_point(ball.samples[700])};
    bake::WalkStageOptions options = rows_within(0.1, 4 * kSites, 4);
    const bake::WalkStage all = bake::take_walks(ball.body->space, light, sites, options, {}, {});
    options.served = served;
    const bake::WalkStage some = bake::take_walks(ball.body->space, light, sites, options, {}, {});
    // Two discs of twice the radius, which rows by view are fitted over, on a ball of radius 1.
    EXPECT_EQ(all.counts.walks, 4u * sites.size());
    EXPECT_LT(some.counts.walks, all.counts.walks / 20);
    EXPECT_GT(some.counts.walks, all.counts.walks / 200);
    for (const bake::BodyPoint& point : served) {
        std::array<std::vector<float>, 2> row, views;
        for (const std::size_t i : {0u, 1u}) {
            row[i].resize(kAll);
            views[i].resize(std::size_t{3} * kAll);
            bake::add_walked_rows(i == 0 ? all : some, point, 1, row[i], views[i]);
        }
        EXPECT_EQ(row[0], row[1]);
        EXPECT_EQ(views[0], views[1]);
    }
}

// Where light is the same everywhere no view differs, however few the walks: without the mean of
// their lobes taken out, sixteen would leave 0.9 of the first degree and more of the second.
TEST(SiteRows, NoViewDiffersInAnEvenSkyWhereNothingIsAbsorbed) {
    const WalkedBall ball = make_ball(100, 1, 1);
    const bake::ExitLight light = light_of(ball);
    constexpr std::size_t kSites = 100;
    const auto sites = bake::place_sites(ball.body->space, {kSites, 0.4, false}, 0, {});
    const bake::WalkStage stage =
        bake::take_walks(ball.body->space, light, sites, rows_within(0.4, 16 * kSites, 9), {}, {});
    const auto rms = [&](std::uint32_t first, std::uint32_t end) {
        double sum = 0;
        for (std::size_t site = 0; site < kSites; ++site) {
            for (std::uint32_t view = first; view < end; ++view) {
                std::vector<float> row(kAll);
                bake::add_site_row(stage.rows, site, view, glm::vec3(1), row);
                sum += std::pow(4 * std::numbers::pi * white(row), 2) / kSites;
            }
        }
        return std::sqrt(sum);
    };
    EXPECT_LT(rms(1, 4), 0.2);
    EXPECT_LT(rms(4, 9), 1);
}

// All sites of a ball see the same: what their rows differ by is noise. Walks that are independent
// of one another leave 0.40 of it, these 0.35.
TEST(SiteRows, OfWalksThatAreSpreadEvenlyHaveLessNoise) {
    const WalkedBall ball = make_ball(100, 0.5f, 1);
    const bake::ExitLight light = light_of(ball);
    constexpr std::size_t kSites = 200;
    const auto sites = bake::place_sites(ball.body->space, {kSites, 0.4, false}, 0, {});
    const bake::WalkStage stage =
        bake::take_walks(ball.body->space, light, sites, rows_within(0.4, 16 * kSites, 1), {}, {});
    double sum = 0, squares = 0;
    for (std::size_t site = 0; site < kSites; ++site) {
        std::vector<float> row(kAll);
        bake::add_site_row(stage.rows, site, 0, glm::vec3(1), row);
        const double radiance = 4 * std::numbers::pi * white(row);
        sum += radiance / kSites;
        squares += radiance * radiance / kSites;
    }
    EXPECT_LT(std::sqrt(squares - sum * sum) / sum, 0.37);
}

// A blade .4 mean free paths thick: its edge shows light that was scattered along the blade, its
// sides light that crossed it. Rows shared over the surface mix both; flights of the receiver's own
// tell them apart. Views along the normal come from the same rows.
TEST(SiteRows, OfSitesInsideShowTheEdgeOfAThinBladeAsItsOwnWalksDo) {
    constexpr float kThickness = 0.4f;
    Primitive blade = make_cube(8, false);
    for (glm::vec3& p : blade.position) {
        p *= glm::vec3(0.5f * kThickness, 3, 3);
    }
    const WalkedBall body =
        make_body(std::move(blade), make_forward_medium(1, 0.95f, 0, 1.3f), 4000);
    const bake::ExitLight light = light_of(body);
    const auto sites = bake::place_sites(body.body->space, {1500, 1, false}, 0, {});
    bake::WalkStageOptions options = rows_within(1, 1.5e6, 4);
    options.is_inside = true;
    const bake::WalkStage stage = bake::take_walks(body.body->space, light, sites, options, {}, {});
    // The cube map's own error: what an exit's light is under white, instead of 1.
    double unit = 0;
    for (std::uint32_t j = 0; j < body.samples.size(); ++j) {
        std::vector<float> rgbx(4 * kAll), row(kAll);
        bake::WalkExit exit;
        exit.weight = {1, 1, 1};
        bake::ExitCells::Sums sums{};
        bake::ExitCells::Cells cells{};
        light.add_exit(j, exit, 1, sums);
        light.add(j, sums, {rgbx, 4}, cells);
        for (std::size_t k = 0; k < row.size(); ++k) {
            row[k] = rgbx[4 * k];
        }
        unit += 4 * std::numbers::pi * white(row) / static_cast<double>(body.samples.size());
    }
    EXPECT_NEAR(unit, 1, 0.05);
    for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)}) {
        const glm::vec3 at = normal * glm::vec3(0.5f * kThickness, 3, 3);
        const bake::WalkStart start = start_below(at, normal);
        std::vector<float> row(kAll), views(3 * kAll);
        add_rows(stage, {at, normal, start.position, 0}, row, views);
        constexpr std::uint32_t kWalks = 200000;
        const Leaving truth = walk_from(body.body->space, start, 1, kWalks);
        const double mean = 4 * std::numbers::pi * white(row) / unit;
        EXPECT_NEAR(mean / truth.all, 1, 0.025) << normal.y;
        // Seen along the normal: T_0 + (1 - m) n . R.
        double along = mean;
        for (int axis = 0; axis < 3; ++axis) {
            along += 4 * std::numbers::pi / unit * (1 - stage.view_fit.mean) *
                     static_cast<double>(normal[axis]) *
                     white(std::span(views).subspan(static_cast<std::size_t>(axis) * kAll, kAll));
        }
        bake::WalkStart straight = start;
        straight.seen = straight.normal;
        const Leaving seen = walk_from(body.body->space, straight, 1, kWalks);
        EXPECT_NEAR(along / seen.all, 1, 0.03) << normal.y;
    }
}

// The far end of an absorbing ball that is lit from one half of the sphere: light comes to it
// over the horizon, leaves again after few scatterings, and exits that forget all of their
// direction but a slope see .73 of it.
TEST(SiteRows, OfAnAbsorbingBallsDarkEndSeeTheLightOverItsHorizon) {
    const WalkedBall ball = make_body(make_sphere(4, 5), make_forward_medium(1, 0.5f, 0, 1), 8000);
    const auto sites = bake::place_sites(ball.body->space, {8000, 0.8, false}, 0, {});
    bake::WalkStageOptions options = rows_within(0.8, 4e5, 1);
    options.is_inside = true;
    const bake::WalkStage stage =
        bake::take_walks(ball.body->space, light_of(ball, true), sites, options, {}, {});
    const std::vector<double> solid_angle = formats::texel_solid_angles(kCubemap);
    std::vector<double> above;
    for (std::uint32_t k = 0; k < kAll; ++k) {
        const std::uint32_t face = k / (kCubemap * kCubemap), texel = k % (kCubemap * kCubemap);
        const bool is_lit =
            formats::texel_direction(kCubemap, face, texel / kCubemap, texel % kCubemap).y > 0;
        above.push_back(is_lit ? solid_angle[texel] : 0);
    }
    formats::haar_forward_cube(std::span(above), kCubemap);
    double shown = 0, truth = 0;
    for (int i = 0; i < 8; ++i) {
        const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 4;
        const glm::vec3 normal =
            glm::normalize(glm::vec3(0.1f * std::cos(angle), -1, 0.1f * std::sin(angle)));
        std::vector<float> row(kAll);
        add_rows(stage, {4.99f * normal, normal, 4.98f * normal, 0}, row, {});
        for (std::size_t k = 0; k < kAll; ++k) {
            shown += above[k] * static_cast<double>(row[k]);
        }
        bake::WalkCounts counts;
        std::vector<bake::WalkExit> exits;
        constexpr std::uint32_t kWalks = 100000;
        for (std::uint32_t w = 0; w < kWalks; ++w) {
            bake::WalkRandom random(
                {5, bake::RandomStage::body_walk, static_cast<std::uint32_t>(i), w});
            exits.clear();
            bake::follow_walk(ball.body->space, {}, {4.98f * normal, normal, normal, 1}, {1},
                              random, exits, counts);
            for (const bake::WalkExit& exit : exits) {
                truth += exit.direction.y > 0 ? static_cast<double>(exit.weight[0]) / kWalks : 0;
            }
        }
    }
    EXPECT_NEAR(shown / truth, 1, 0.05);
}

// What is subtracted before truncation is missing from the rows.
TEST(SiteRows, SubtractedRowsAreLeftOut) {
    const WalkedBall ball = make_ball(5, 0.9f);
    const bake::ExitLight light = light_of(ball);
    const auto sites = bake::place_sites(ball.body->space, {50, 0.4, false}, 0, {});
    bake::WalkStageOptions options = rows_within(0.4, 500, 1);
    options.rows.kept = 400;
    options.rows.orders = {};
    const auto take = [&](float share) {
        return bake::take_walks(ball.body->space, light, sites, options,
                                [share](std::size_t, std::span<float> rgbx) {
                                    for (float& value : rgbx) {
                                        value *= share;
                                    }
                                },
                                {});
    };
    const bake::WalkStage whole = take(1), half = take(0.5f);
    ASSERT_FALSE(whole.rows.blocks.empty());
    std::vector<float> a(kAll), b(kAll);
    bake::add_site_row(whole.rows, 7, 0, glm::vec3(0.5f), a);
    bake::add_site_row(half.rows, 7, 0, glm::vec3(1), b);
    EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace opaline::tests
