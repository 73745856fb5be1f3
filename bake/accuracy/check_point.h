#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
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
};

/// The receivers `drawn` as points: running numbers of the sets.
std::vector<CheckPoint> make_check_points(std::span<const ReceiverSet> sets,
                                          std::span<const std::uint32_t> drawn);

/// Sets `behind` of about half of the points of thin-walled surfaces, by their keys.
void turn_thin_walled(const formats::Scene& scene, std::span<CheckPoint> points);

}  // namespace opaline::bake
