#include "tests/bake/path_differentials/camera_start.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::Vector;

LensCamera random_camera(tests::RandomInputs& random) {
    LensCamera camera;
    camera.pinhole.eye = random.vector(3);
    camera.pinhole.view = 3.0 * random.unit();
    camera.pinhole.right = random.vector();
    camera.pinhole.up = random.vector();
    camera.lens_x = random.vector(0.2);
    camera.lens_y = random.vector(0.2);
    return camera;
}

TEST(CameraStart, PixelColumnsAreDerivatives) {
    tests::RandomInputs random(1);
    tests::ColumnErrors errors;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const PinholeCamera camera = random_camera(random).pinhole;
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        if (glm::length(camera.view + x * camera.right + y * camera.up) < 0.5) {
            continue;
        }
        const CameraStart start = start_at_pinhole(camera, x, y);
        const auto direction = [&](auto dx, auto dy) {
            using S = decltype(dx + dy);
            return tests::camera_direction<S>(camera.view, camera.right, camera.up, S(x) + dx,
                                              S(y) + dy);
        };
        errors.add([&](auto d) { return direction(d, decltype(d)(0)); }, start.dD_dx);
        errors.add([&](auto d) { return direction(decltype(d)(0), d); }, start.dD_dy);
    }
    tests::expect_derivatives(errors);
}

TEST(CameraStart, LensColumnsAreDerivatives) {
    tests::RandomInputs random(2);
    tests::ColumnErrors positions, directions;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const LensCamera camera = random_camera(random);
        const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5);
        const double u = random.uniform(), v = random.uniform();
        if (tests::is_near_diagonal(u, v)) {
            continue;
        }
        const CameraStart start = start_at_lens(camera, x, y, u, v);
        const auto offset = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            const auto at = tests::concentric_point<S>(S(u) + du, S(v) + dv);
            return at[0] * Vector<S>(camera.lens_x) + at[1] * Vector<S>(camera.lens_y);
        };
        const auto direction = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            const Vector<S> view = Vector<S>(camera.pinhole.view) - offset(du, dv);
            return tests::camera_direction<S>(view, camera.pinhole.right, camera.pinhole.up, S(x),
                                              S(y));
        };
        positions.add([&](auto d) { return offset(d, decltype(d)(0)); }, start.dP_du);
        positions.add([&](auto d) { return offset(decltype(d)(0), d); }, start.dP_dv);
        directions.add([&](auto d) { return direction(d, decltype(d)(0)); }, start.dD_du);
        directions.add([&](auto d) { return direction(decltype(d)(0), d); }, start.dD_dv);
    }
    tests::expect_derivatives(positions);
    tests::expect_derivatives(directions);
}

TEST(CameraStart, DirectionsStayUnit) {
    tests::RandomInputs random(3);
    for (int i = 0; i < 1000; ++i) {
        const CameraStart start = start_at_lens(random_camera(random), random.uniform(),
                                                random.uniform(), random.uniform(), 0.3);
        for (const glm::dvec3& dD : {start.dD_dx, start.dD_dy, start.dD_du, start.dD_dv}) {
            EXPECT_NEAR(glm::dot(start.D, dD), 0, 1e-12 * (1 + glm::length(dD)));
        }
    }
}

// dP + t dD of a lens column is 0 in the plane that is in focus, whatever the aperture.
TEST(CameraStart, LensColumnsVanishInThePlaneInFocus) {
    const LensCamera camera{
        {{0, 0, 0}, {0, 0, -4}, {2, 0, 0}, {0, 2, 0}}, {0.3, 0, 0}, {0, 0.3, 0}};
    const CameraStart start = start_at_lens(camera, 0.2, -0.4, 0.7, 0.4);
    const double t = (-4 - start.P.z) / start.D.z;
    for (const auto& [dP, dD] : {std::pair(start.dP_du, start.dD_du), {start.dP_dv, start.dD_dv}}) {
        const glm::dvec3 w = dP + t * dD;
        const glm::dvec3 on_plane = w - start.D * (w.z / start.D.z);
        EXPECT_LT(glm::length(on_plane), 1e-14);
        EXPECT_GT(glm::length(dP), 0.1);
    }
}

}  // namespace
}  // namespace opaline::bake
