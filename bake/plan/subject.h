#pragma once

#include <cstdint>
#include <string>

namespace opaline::bake {

/// The subject of a decision. A material represents its surfaces and the medium inside.
struct Subject {
    enum class Kind : std::uint8_t { material, volume, layer, emitter } kind = Kind::material;
    std::uint32_t index = 0;  ///< into Scene::materials, volumes or layers
    std::string name;         ///< for messages and reports: "material 'Floor'"
};

}  // namespace opaline::bake
