#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What is switched, dimmed and coloured as one: an emitter of the file.
struct Lamp {
    std::string name = {};                       ///< of the node, of the light, or of the group
    std::vector<std::uint32_t> primitives = {};  ///< that glow: all of one node, or of several
    std::vector<std::uint32_t> lights = {};      ///< into Scene::lights
    /// Or a volume that glows: into Scene::volumes, and its number among those that are baked.
    std::uint32_t volume = formats::kNone, glow = formats::kNone;
};

/// Nodes whose surfaces glow, in the order of the scene, then lights that are not black. Names are
/// unique: "Lamp", "Lamp (2)". Those of a group are one, in the place of its first one.
std::vector<Lamp> list_lamps(const formats::Scene& scene);

/// A name as a file takes it that differs from those that are taken: "fire", "fire (2)".
std::string free_emitter_name(const std::string& wanted, std::span<const std::string> taken);

std::vector<std::string> names_of(std::span<const Lamp> lamps);

/// Emitters of a file with these lamps, where `glowing` volumes are emitters, some of them lamps.
std::size_t count_emitters(std::span<const Lamp> lamps, std::size_t glowing);

/// bad_input where there are more lamps than a file holds, formats::kMaxEmitters, where a group
/// names one that there is not, and where two emitters would have the same name. `effect`: what an
/// error names that leaves them out.
formats::Status check_lamps(const formats::Scene& scene, std::size_t lamps,
                            std::string_view effect);

}  // namespace opaline::bake
