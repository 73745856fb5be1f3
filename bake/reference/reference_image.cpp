#include "bake/reference/reference_image.h"

#include <utility>

#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

formats::Rgb to_rgb(glm::dvec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
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
    const SurroundingMedia around = surrounding_media(space.scene, eye, {0, 1, 0});
    auto estimate = estimate_pixels(
        camera.width * camera.height, options, context,
        [&](std::uint32_t pixel, RandomStream& random) {
            const double x = pixel % camera.width + static_cast<double>(random.next());
            const double y = pixel / camera.width + static_cast<double>(random.next());
            const formats::Vec3 ray = runtime::view_ray(camera, frame, x, y);
            return trace_ray(space, eye, {ray.x, ray.y, ray.z}, random, around);
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
