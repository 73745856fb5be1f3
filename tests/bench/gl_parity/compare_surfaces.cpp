#include <cstdint>
#include <vector>

#include "runtime/picture/camera.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/bench/gl_parity/conditioning.h"
#include "tests/runtime/embed_gl/host/host_surface.h"

namespace opaline::parity {
namespace {

using formats::Vec3;

// Of four floats a receiver the first three.
std::vector<float> three_of_four(const std::vector<float>& values, std::size_t receivers) {
    std::vector<float> three(3 * receivers);
    for (std::size_t i = 0; i < three.size(); ++i)
        three[i] = values[i / 3 * 4 + i % 3];
    return three;
}

std::vector<float> shown_on_cpu(const Case& in, const float* eye) {
    std::vector<float> shown(3 * std::size_t{in.file.receivers()});
    test::require(opaline_shade_from(in.file.asset(), in.file.light(), 0, eye, 0,
                                     in.file.receivers(), shown.data(), shown.size()) == OPALINE_OK,
                  opaline_last_error());
    return shown;
}

// `at` null: each receiver along its own normal, as which no host draws.
void compare_from(const Case& in, const Vec3* at, float moved) {
    const float eye[3] = {at != nullptr ? at->x : 0, at != nullptr ? at->y : 0,
                          at != nullptr ? at->z : 0};
    const float* const from = at != nullptr ? eye : nullptr;
    test::require(opaline_gl_look_from(in.gl, from) == OPALINE_OK, opaline_last_error());
    const auto objects = test::filled<opaline_gl_objects>(opaline_gl_get_objects, in.gl);
    const std::size_t receivers = in.file.receivers();
    const auto compare = [&](Kind kind, const auto& on_cpu, const std::vector<float>& on_gl) {
        const SeenFrom cpu = [&](Vec3 by) {
            const float beside[3] = {eye[0] + by.x, eye[1] + by.y, eye[2] + by.z};
            return on_cpu(at != nullptr ? beside : nullptr);
        };
        compare_values(in.report, {kind, "receiver", 3, {largest_of(on_cpu(from))}, moved}, cpu,
                       three_of_four(on_gl, receivers));
    };
    compare(
        Kind::receivers, [&](const float* e) { return in.file.expected(e); },
        test::read_floats(objects.radiance, 4 * receivers));
    if (at == nullptr) return;
    compare(
        Kind::surfaces, [&](const float* e) { return shown_on_cpu(in, e); },
        test::draw_receivers(in.file.asset(), in.gl, in.api, eye));
}

}  // namespace

void compare_surfaces(const Case& in) {
    if (in.file.receivers() == 0) return;
    const runtime::Camera front = runtime::frame_asset(in.view(), 40, 128, 96);
    // Each direction of a lobe is looked up in the nearest level of the light's maps, and that is
    // found from 1 - n.h, which has lost as many digits where the lobe is narrow.
    const float moved = 1e-5f * length(front.eye - front.target);
    compare_from(in, nullptr, moved);
    for (const float degrees : {0.0f, 150.0f}) {
        const Vec3 at = runtime::orbit(front, degrees).eye;
        compare_from(in, &at, moved);
    }
}

}  // namespace opaline::parity
