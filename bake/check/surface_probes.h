#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A place where the finished file is compared with the truth: a receiver, or a point between
/// three of them.
struct CheckPoint {
    std::uint32_t primitive = 0, material = 0;  ///< index into the scene's
    /// What the runtime mixes there: vertices of the whole asset and their barycentric weights,
    /// which add up to 1.
    std::array<std::uint32_t, 3> vertex{};
    std::array<float, 3> weight{1, 0, 0};
    Receiver receiver;      ///< of opaque materials
    BodyPoint body;         ///< of media
    std::uint32_t key = 0;  ///< of the random numbers of its truth
    bool behind = false;    ///< seen from behind: of thin-walled surfaces alone
    /// Of media: unit, outside, toward the eye; 0: the normal.
    glm::vec3 to_eye{0};

    glm::vec3 view() const { return to_eye == glm::vec3(0) ? body.normal : to_eye; }
};

/// The receivers `drawn` as points: running numbers of the sets, which are slots if there are any.
std::vector<CheckPoint> make_check_points(std::span<const ReceiverSet> sets,
                                          const formats::SlotsView& slots,
                                          std::span<const std::uint32_t> drawn);

/// Sets `behind` of about half of the points of thin-walled surfaces, by their keys.
void turn_thin_walled(const formats::Scene& scene, std::span<CheckPoint> points);

/// Moves points of meshes that copies repeat to one of these or leaves them, each alike, by seed
/// and key: there the file shows the same rows, and the truth may be another one.
void move_to_copies(const formats::Scene& scene, std::uint64_t seed, std::span<CheckPoint> points);

/// Turns the views of three in four points away from the normal, cosine-distributed but for the
/// last 25 degrees above the surface, by seed and key; the others stay. Two points of one key look
/// alike. `normals`: of the asset's vertices; views of which one does not see all of a point's
/// vertices stay as well.
void turn_views(std::span<const glm::vec3> normals, std::uint64_t seed,
                std::span<CheckPoint> points);

struct ProbeOptions {
    std::size_t count = 0;  ///< how many are drawn
    std::uint64_t seed = 0;
    std::uint32_t first_key = 0;  ///< CheckPoint::key of the first
};

/// Random points of the surface, uniform by area over the scene's `primitives`, one in each of
/// `count` parts of equal area. They lie on the triangles; their normals are interpolated, and
/// their rays start where the smooth surface would be (surface_samples.h). Points that
/// hidden_receivers.h calls hidden are left out.
std::vector<CheckPoint> draw_surface_probes(const formats::Scene& scene, const RayScene& rays,
                                            const std::vector<std::uint32_t>& primitives,
                                            const ProbeOptions& options, const Context& context);

}  // namespace opaline::bake
