#pragma once

#include <cstdint>
#include <string>

namespace opaline::bake {

/// What a decision is about. A material stands for its surfaces and what fills them.
struct Subject {
    enum class Kind : std::uint8_t { material, volume, layer, emitter } kind = Kind::material;
    std::uint32_t index = 0;  ///< into Scene::materials, volumes or layers
    std::string name;         ///< for messages and reports: "material 'Floor'"
};

}  // namespace opaline::bake
