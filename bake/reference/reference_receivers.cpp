#include "bake/reference/reference_receivers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "bake/base/rng.h"
#include "bake/receivers/used_vertices.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/contacts.h"
#include "bake/trace/touching_triangles.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// One from each of `wanted` equal runs, so none is drawn twice.
std::vector<std::uint64_t> draw(std::uint64_t count, std::uint64_t wanted, std::uint64_t seed) {
    std::vector<std::uint64_t> drawn;
    wanted = std::min(wanted, count);
    for (std::uint64_t i = 0; i < wanted; ++i) {
        const std::uint64_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const double u =
            static_cast<double>(random_uniform(seed, RandomStage::reference_receivers, i)[0]);
        drawn.push_back(begin + static_cast<std::uint64_t>(u * static_cast<double>(end - begin)));
    }
    return drawn;
}

glm::vec3 direction_to(glm::dvec3 from, glm::dvec3 to, glm::vec3 otherwise) {
    const glm::dvec3 way = to - from;
    const double length = glm::length(way);
    return length > 0 ? glm::vec3(way / length) : otherwise;
}

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

void append_number(std::string& text, double value) {
    std::array<char, 32> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value),
                      std::chars_format::general, 9);
    text += ',';
    text.append(digits.data(), end);
}

}  // namespace

std::vector<ReferenceReceiver> choose_receivers(const ReferenceScene& scene, std::uint32_t wanted,
                                                std::uint64_t seed,
                                                const std::optional<glm::vec3>& eye) {
    const formats::Scene& input = scene.surfaces.scene();
    // Ray origins as in the bake: in front of all triangles that meet at the vertex.
    const std::vector<Receiver> origins = make_vertex_receivers(input);
    std::vector<ReferenceReceiver> receivers;
    std::uint64_t first = 0;
    std::uint32_t primitive = 0;
    const std::vector<std::uint32_t> used = find_used_vertices(input);
    std::vector<std::uint32_t> numbers;
    for (const std::uint64_t drawn : draw(used.size(), wanted, seed)) {
        numbers.push_back(used[drawn]);
    }
    const std::vector<Contact> contacts =
        find_contacts(scene.surfaces.hierarchy(), input, numbers, {});
    auto contact = contacts.begin();
    for (const std::uint32_t number : numbers) {
        while (number >= first + input.primitives[primitive].position.size()) {
            first += input.primitives[primitive++].position.size();
        }
        const formats::Primitive& p = input.primitives[primitive];
        ReferenceReceiver receiver;
        receiver.primitive = primitive;
        receiver.vertex = static_cast<std::uint32_t>(number - first);
        const glm::vec3 position = p.position[receiver.vertex];
        receiver.position = position;
        receiver.outside =
            leave_touching_triangles(scene.surfaces.hierarchy(), input, position, origins[number])
                .origin;
        receiver.inside = position - (receiver.outside - position);
        if (contact != contacts.end() && contact->vertex == number) {
            receiver.outside = contact->place + contact->lift;
            receiver.inside = contact->place - contact->lift;
            ++contact;
        }
        receiver.normal = p.normal[receiver.vertex];
        receiver.to_eye =
            eye ? direction_to(input.to_world(position), *eye, receiver.normal) : receiver.normal;
        receiver.base_color = base_color_at_vertex(input, primitive, receiver.vertex);
        receiver.medium = scene.medium_of[p.material];
        if (receiver.normal != glm::vec3(0)) {
            receiver.around = surrounding_media(scene, receiver.outside, receiver.normal);
            if (receiver.medium != formats::kNone) {
                receiver.within = surrounding_media(scene, receiver.inside, -receiver.normal);
                if (!receiver.within.contains(receiver.medium)) {
                    receiver.within = {};
                    receiver.within.enter(receiver.medium);
                }
            }
        }
        receivers.push_back(receiver);
    }
    return receivers;
}

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
    if (!estimate) return std::move(estimate).error();
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

formats::Status write_receiver_csv(const std::filesystem::path& path,
                                   std::span<const ReferenceReceiver> receivers,
                                   const Estimate& estimate) {
    std::string text = "primitive,vertex,r,g,b,se_r,se_g,se_b\n";
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        text += std::to_string(receivers[i].primitive) + ',' + std::to_string(receivers[i].vertex);
        const Moments& m = estimate.pixel[i];
        const glm::dvec3 error = glm::sqrt(m.variance_of_mean());
        for (const glm::dvec3& value : {m.mean, error}) {
            for (int c = 0; c < 3; ++c) {
                append_number(text, value[c]);
            }
        }
        text += '\n';
    }
    return formats::write_file_atomically(path, text);
}

}  // namespace opaline::bake
