#include "bake/reference/path_filter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/physics/path_differentials/bounded_change.h"
#include "bake/physics/path_differentials/surface_shape.h"
#include "bake/reference/glossy_brdf.h"
#include "bake/reference/rough_boundary.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/textured_board.h"

namespace opaline::tests {
namespace {

using bake::PathFilter;
using bake::TextureFiltering;

/// Of the parallelogram that has these moments, in texture coordinates.
double area_of(const bake::UvMoments& m) {
    return std::sqrt(static_cast<double>(m.uu) * m.vv - static_cast<double>(m.uv) * m.uv);
}

void expect_moments(const bake::UvMoments& found, const bake::UvMoments& expected, double rel) {
    EXPECT_GT(expected.uu, 0);
    EXPECT_NEAR(found.uu / expected.uu, 1, rel);
    EXPECT_NEAR(found.vv / expected.vv, 1, rel);
    EXPECT_NEAR((found.uv - expected.uv) / std::sqrt(expected.uu * expected.vv), 0, rel);
}

bake::SurfaceHit hit_at(float distance, glm::vec3 position, glm::vec3 normal) {
    bake::SurfaceHit hit;
    hit.distance = distance;
    hit.position = position;
    hit.flat = hit.smooth = normal;
    return hit;
}

TEST(PathFilter, APixelOnABoardIsItsAngleTimesTheDistance) {
    const Scene scene = textured_board(0);
    const auto fixture = make_fixture(scene, {});
    const TextureFiltering filtering = filtering_of(scene, 16);
    PathFilter filter(filtering, {0.01f, 0, 0}, {0, 0, 0.02f});
    const auto hit = fixture->scene.surfaces.closest_hit({{0.3f, 3, 0.1f}}, {0, -1, 0}, 100);
    ASSERT_TRUE(hit);
    filter.arrive(scene, {0, -1, 0}, *hit);
    // 3 m away, half a texture per metre, steps of 1/4: 0.00375 and 0.0075.
    EXPECT_NEAR(area_of(filter.view().moments), 0.00375 * 0.0075, 1e-9);
}

TEST(PathFilter, AnEventSpreadsItsDensityOverTheSurface) {
    // Area of the footprint = step^2 d^2 / (pdf cosine), of whichever lobe drew the direction.
    const Scene scene = textured_board(0);
    const auto fixture = make_fixture(scene, {});
    const TextureFiltering filtering = filtering_of(scene, 10000);
    bake::OpaqueSurface surface;
    surface.metallic = 1;
    surface.roughness = 0.5f;
    const glm::vec3 in = glm::normalize(glm::vec3(0.3f, 1, 0.2f)), normal(0, -1, 0);
    const bake::GlossyBrdf brdf = bake::make_glossy_brdf(surface, normal, -in);
    bake::RandomStream random(1, 2, 3);
    int checked = 0;
    while (checked < 60) {
        const bool glossy = checked % 2 == 0;
        const bake::SurfaceHit start = hit_at(1, {0, 1, 0}, normal);
        PathFilter filter(filtering, glm::vec3(0), glm::vec3(0));
        filter.arrive(scene, in, start);
        glm::vec3 out;
        double pdf = 0;
        if (glossy) {
            const float u = random.next(), v = random.next();
            const auto sample = bake::sample_mirrored(brdf, u, v);
            if (!sample) continue;
            out = sample->direction;
            pdf = static_cast<double>(sample->pdf);
            filter.scatter_on_facets(in, normal, static_cast<float>(brdf.alpha), out);
        } else {
            const float c = std::sqrt(1 - random.next()), s = std::sqrt(1 - c * c);
            const float phi = 6.2831853f * random.next();
            out = {s * std::cos(phi), -c, s * std::sin(phi)};
            pdf = static_cast<double>(c) / std::numbers::pi;
            filter.scatter_diffusely(normal, out);
        }
        const double cosine = -static_cast<double>(out.y);
        const auto hit = fixture->scene.surfaces.closest_hit({start.position}, out, 100);
        if (!hit || cosine < 0.4) {
            continue;  // beside the board, or near the rim, where a secant replaces the derivative
        }
        filter.arrive(scene, out, *hit);
        const double d2 = 1 / (cosine * cosine);
        const double expected = 1e-4 * d2 / (pdf * cosine) / 4;  // 4 m^2 are the whole texture
        EXPECT_NEAR(area_of(filter.view().moments) / expected, 1, 1e-2) << glossy;
        ++checked;
    }
}

TEST(PathFilter, ARefractingFacetSpreadsItsDensityOverTheSurface) {
    const Scene scene = textured_board(0);
    const auto fixture = make_fixture(scene, {});
    const TextureFiltering filtering = filtering_of(scene, 10000);
    const glm::vec3 in = glm::normalize(glm::vec3(0.3f, -1, 0.2f)), normal(0, 1, 0);
    for (const float ratio : {1.5f, 1 / 1.5f}) {
        bake::RoughBoundary boundary = bake::make_rough_boundary(normal, -in, 0.25f, ratio);
        boundary.reflects = false;
        bake::RandomStream random(1, 2, 3);
        for (int checked = 0; checked < 40;) {
            const float u = random.next(), v = random.next();
            const auto sample = sample_rough_boundary(boundary, u, v, 0);
            if (!sample || sample->direction.y > -0.5f) {
                continue;  // where a secant replaces the derivative
            }
            const bake::SurfaceHit start = hit_at(1, {0, 1, 0}, normal);
            PathFilter filter(filtering, glm::vec3(0), glm::vec3(0));
            filter.arrive(scene, in, start);
            filter.scatter_on_facets(in, normal, 0.25f, sample->direction, ratio);
            const auto hit =
                fixture->scene.surfaces.closest_hit({start.position}, sample->direction, 100);
            if (!hit) {
                continue;  // beside the board
            }
            filter.arrive(scene, sample->direction, *hit);
            const double cosine = -static_cast<double>(sample->direction.y);
            const double expected =
                1e-4 / (static_cast<double>(sample->pdf) * cosine * cosine * cosine) / 4;
            EXPECT_NEAR(area_of(filter.view().moments) / expected, 1, 2e-2) << ratio;
            ++checked;
        }
    }
}

// A facet that is the normal turns with it, so that older columns are those of a smooth boundary.
TEST(PathFilter, AFacetAtTheNormalOfACurvedBoundaryRefractsAsTheBoundaryDoes) {
    Scene scene = textured_board(0, 200);
    scene.primitives.push_back(make_sphere(2, 1, {0, 2, 0}));
    const auto fixture = make_fixture(scene, {});
    const glm::vec3 in = glm::normalize(glm::vec3(0.1f, -1, -0.1f));
    const auto ball = fixture->scene.surfaces.closest_hit({{0.1f, 4, 0.15f}}, in, 100);
    ASSERT_TRUE(ball && ball->primitive == 1);
    for (const float ratio : {1.5f, 1 / 1.2f}) {
        const auto moments_of = [&](bool rough) {
            TextureFiltering filtering = filtering_of(scene, 1);
            PathFilter filter(filtering, {0.01f, 0, 0}, {0, 0.002f, 0.01f});
            filtering.step = 0;  // of the event's own numbers
            filter.arrive(scene, in, *ball);
            const glm::vec3 out = glm::refract(in, ball->smooth, 1 / ratio);
            rough ? filter.scatter_on_facets(in, ball->smooth, 0.3f, out, ratio)
                  : filter.refract(in, ball->smooth, ratio);
            // The board, as if nothing were in between.
            const float distance = -ball->position.y / out.y;
            auto board = hit_at(distance, ball->position + distance * out, {0, 1, 0});
            board.primitive = 0;
            filter.arrive(scene, out, board);
            return filter.view().moments;
        };
        expect_moments(moments_of(true), moments_of(false), 1e-3);
    }
}

// Beside the exact events of path_differentials.
TEST(PathFilter, ACurvedMirrorIsThatOfPathDifferentials) {
    Scene scene = textured_board(0);
    scene.primitives.push_back(make_sphere(2, 1, {0, 2, 0}));
    scene.materials[0].base_color_image = 0;
    const auto fixture = make_fixture(scene, {});
    const TextureFiltering filtering = filtering_of(scene, 1);
    const glm::vec3 right(0.01f, 0, 0), up(0, 0.002f, 0.01f);
    PathFilter filter(filtering, right, up);
    const std::array<glm::dvec3, 2> start{glm::dvec3(right), glm::dvec3(up)};
    // Up to the ball from below, a mirror, down to the board.
    const glm::vec3 in = glm::normalize(glm::vec3(0.1f, 1, -0.1f));
    const auto ball = fixture->scene.surfaces.closest_hit({{0.1f, 0.2f, 0.15f}}, in, 100);
    ASSERT_TRUE(ball && ball->primitive == 1);
    filter.arrive(scene, in, *ball);
    filter.mirror(in, ball->smooth);
    const glm::vec3 out = glm::reflect(in, ball->smooth);
    const auto board =
        fixture->scene.surfaces.closest_hit(bake::leave_surface(*ball, out), out, 100);
    ASSERT_TRUE(board && board->primitive == 0);
    EXPECT_TRUE(filter.arrive(scene, out, *board));

    const Primitive& p = scene.primitives[1];
    std::array<glm::dvec3, 3> corners, normals;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = p.index[3 * std::size_t{ball->triangle} + k];
        corners[k] = glm::dvec3(p.position[corner]);
        normals[k] = glm::dvec3(p.normal[corner]);
    }
    const bake::SurfaceShape shape =
        bake::interpolated_shape(corners, normals, glm::dvec3(ball->position));
    const bake::Mirror mirror = bake::make_mirror(glm::dvec3(in), shape.N);
    bake::UvMoments expected;
    for (const glm::dvec3& dD : start) {
        const glm::dvec3 dP = bake::bounded_transfer(glm::dvec3(in), glm::dvec3(ball->flat),
                                                     ball->distance, glm::dvec3(0), dD);
        const glm::dvec3 dR = mirror.change(dD, shape.dN_dP * dP);
        const glm::dvec3 at = bake::bounded_transfer(glm::dvec3(out), glm::dvec3(board->flat),
                                                     board->distance, dP, dR);
        const glm::vec2 uv(0.5 * at.x, 0.5 * at.z);
        expected.uu += uv.x * uv.x;
        expected.uv += uv.x * uv.y;
        expected.vv += uv.y * uv.y;
    }
    expect_moments(filter.view().moments, expected, 1e-3);
}

// A pane of index 1.5, 0.7 m thick, at normal incidence: a spread a becomes a (d1 + h / 1.5 + d2).
TEST(PathFilter, APaneBringsTheBoardCloser) {
    const Scene scene = textured_board(0);
    const auto fixture = make_fixture(scene, {});
    const TextureFiltering filtering = filtering_of(scene, 1);
    const glm::vec3 up(0, 1, 0);
    PathFilter filter(filtering, {0.01f, 0, 0}, {0, 0, 0.01f});
    filter.arrive(scene, -up, hit_at(2, {0.3f, 1.7f, 0.1f}, up));
    filter.refract(-up, up, 1.5f);
    const bake::SurfaceHit side = hit_at(0.7f, {0.3f, 1, 0.1f}, up);
    filter.arrive(scene, -up, side);
    filter.refract(-up, up, 1 / 1.5f);
    const auto board = fixture->scene.surfaces.closest_hit({side.position}, -up, 100);
    ASSERT_TRUE(board);
    filter.arrive(scene, -up, *board);
    const double expected = 0.5 * 0.01 * (2 + 0.7 / 1.5 + 1);
    EXPECT_NEAR(area_of(filter.view().moments) / (expected * expected), 1, 1e-5);
}

// Everything after a column's birth is linear, so second moments of all columns are the sums of
// those that each event makes by itself, whether columns were merged or not.
TEST(PathFilter, MomentsOfManyScatteringsAreThoseOfEachTogether) {
    Scene scene = textured_board(0, 2000);
    Primitive ceiling = scene.primitives[0];
    for (std::size_t i = 0; i < ceiling.position.size(); ++i) {
        ceiling.position[i].y = 1;
        ceiling.normal[i] = {0, -1, 0};
    }
    std::swap(ceiling.index[1], ceiling.index[2]);
    std::swap(ceiling.index[4], ceiling.index[5]);
    scene.primitives.push_back(ceiling);
    const auto fixture = make_fixture(scene, {});
    constexpr std::size_t kEvents = 5;
    // `only`: the event whose numbers move; kEvents: those of all.
    const auto moments_of = [&](std::size_t only) {
        TextureFiltering filtering = filtering_of(scene, 1);
        filtering.extent = 1e9f;
        const auto step_of = [&](std::size_t i) { return only == kEvents || only == i ? 0.1f : 0; };
        PathFilter filter(filtering, glm::vec3(0), glm::vec3(0));
        bake::RayOrigin from{{0.3f, 0.5f, 0.1f}};
        glm::vec3 d = glm::normalize(glm::vec3(0.4f, 1, -0.2f));
        bake::RandomStream random(1, 1, 1);
        for (std::size_t i = 0; i <= kEvents; ++i) {
            const auto hit = fixture->scene.surfaces.closest_hit(from, d, 1e9f);
            if (!hit) {
                ADD_FAILURE();
                break;
            }
            EXPECT_TRUE(filter.arrive(scene, d, *hit));
            const glm::vec3 normal = d.y > 0 ? glm::vec3(0, -1, 0) : glm::vec3(0, 1, 0);
            const glm::vec3 off(random.next() - 0.5f, 0, random.next() - 0.5f);
            const glm::vec3 drawn =
                glm::normalize(glm::normalize(glm::reflect(d, normal)) + 0.5f * off);
            i % 2 == 0 ? filter.scatter_on_facets(d, normal, 0.3f, drawn)
                       : filter.scatter_diffusely(normal, drawn);
            filtering.step = step_of(i);  // takes effect with the event, at the next hit
            d = drawn;
            from = bake::leave_surface(*hit, d);
        }
        return filter.view().moments;
    };
    bake::UvMoments sum;
    for (std::size_t i = 0; i < kEvents; ++i) {
        const bake::UvMoments one = moments_of(i);
        sum.uu += one.uu;
        sum.uv += one.uv;
        sum.vv += one.vv;
    }
    expect_moments(moments_of(kEvents), sum, 1e-4);
}

// The limit shortens steps over which the density changes, from the second scattering on alone.
TEST(PathFilter, TheGradientLimitHoldsFromTheSecondScatteringOn) {
    const Scene scene = textured_board(0, 2000);
    const auto fixture = make_fixture(scene, {});
    const auto area_after = [&](int scatterings, float limit) {
        TextureFiltering filtering = filtering_of(scene, 4);
        filtering.gradient_limit = limit;
        filtering.extent = 1e9f;
        PathFilter filter(filtering, glm::vec3(0), glm::vec3(0));
        const glm::vec3 out = glm::normalize(glm::vec3(0.5f, 1, 0));
        const bake::SurfaceHit hit = hit_at(1, glm::vec3(0), {0, 1, 0});
        for (int i = 0; i < scatterings; ++i) {
            filter.arrive(scene, -out, hit);
            filter.scatter_on_facets({0, -1, 0}, hit.flat, 0.2f, out);
        }
        const auto board = fixture->scene.surfaces.closest_hit({{0, -1, 0}}, out, 100);
        EXPECT_TRUE(board);
        filter.arrive(scene, out, *board);
        return area_of(filter.view().moments);
    };
    const float none = std::numeric_limits<float>::infinity();
    EXPECT_EQ(area_after(1, 0.1f), area_after(1, none));
    EXPECT_LT(area_after(2, 0.1f), 0.5 * area_after(2, none));
}

}  // namespace
}  // namespace opaline::tests
