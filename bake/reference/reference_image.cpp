#include "bake/reference/reference_image.h"

#include <utility>

#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

formats::Rgb to_rgb(glm::dvec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

glm::vec3 to_vec3(formats::Vec3 v) {
    return {v.x, v.y, v.z};
}

// D = h / |h|, h = x right + y up - backward with a unit `backward` across both: 1 / |h| is the
// cosine to the view axis.
struct PixelAxes {
    glm::vec3 right, up, ahead;

    RaySpread spread(glm::vec3 direction) const {
        const float cosine = glm::dot(direction, ahead);
        return {cosine * (right - direction * glm::dot(direction, right)),
                cosine * (up - direction * glm::dot(direction, up))};
    }
};

PixelAxes pixel_axes(const runtime::Camera& camera, const runtime::CameraFrame& frame) {
    return {static_cast<float>(2 * frame.tan_half_x / camera.width) * to_vec3(frame.right),
            static_cast<float>(2 * frame.tan_half_y / camera.height) * to_vec3(frame.up),
            -to_vec3(frame.backward)};
}

// One path from each receiver; `keep` maps its radiance to the estimated quantity.
template <class Keep>
formats::Result<Estimate> estimate_each(const PathSpace& space,
                                        std::span<const ReferenceReceiver> receivers,
                                        const EstimateOptions& options, const Context& context,
                                        Keep&& keep) {
    return estimate_pixels(static_cast<std::uint32_t>(receivers.size()), options, context,
                           [&](std::uint32_t i, RandomStream& random) {
                               PathSample sample = trace_receiver(space, receivers[i], random);
                               sample.radiance = keep(sample.radiance);
                               return sample;
                           });
}

}  // namespace

formats::Result<ReferenceImage> estimate_image(const PathSpace& space,
                                               const runtime::Camera& camera,
                                               const EstimateOptions& options,
                                               const Context& context) {
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    const glm::vec3 eye(glm::dvec3(camera.eye.x, camera.eye.y, camera.eye.z) -
                        space.scene.surfaces.scene().origin);
    const PixelAxes axes = pixel_axes(camera, frame);
    const SurroundingMedia around = surrounding_media(space.scene, eye, {0, 1, 0});
    auto estimate =
        estimate_pixels(camera.width * camera.height, options, context,
                        [&](std::uint32_t pixel, RandomStream& random) {
                            random.start_event();
                            const glm::dvec2 within(random.next_pair());
                            const double x = pixel % camera.width + within.x;
                            const double y = pixel / camera.width + within.y;
                            const glm::vec3 ray = to_vec3(runtime::view_ray(camera, frame, x, y));
                            return trace_ray(space, eye, ray, random, around, axes.spread(ray));
                        });
    if (!estimate) {
        return std::move(estimate).error();
    }
    ReferenceImage image{{camera.width, camera.height, {}}, {camera.width, camera.height, {}}, {}};
    for (const Moments& m : estimate->pixel) {
        image.mean.pixel.push_back(to_rgb(m.mean));
        image.variance.pixel.push_back(to_rgb(m.variance_of_mean()));
    }
    image.estimate = std::move(*estimate);
    return image;
}

formats::Result<Estimate> estimate_receivers(const PathSpace& space,
                                             std::span<const ReferenceReceiver> receivers,
                                             const EstimateOptions& options,
                                             const Context& context) {
    return estimate_each(space, receivers, options, context, [](glm::vec3 c) { return c; });
}

formats::Result<Estimate> estimate_luminance(const PathSpace& space,
                                             std::span<const ReferenceReceiver> receivers,
                                             const EstimateOptions& options,
                                             const Context& context) {
    return estimate_each(space, receivers, options, context, [](glm::vec3 c) {
        return glm::vec3(formats::luminance({c.x, c.y, c.z}));
    });
}

}  // namespace opaline::bake
