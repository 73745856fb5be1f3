#pragma once

#include <cstdint>
#include <string>

namespace opaline::bake {

/// What a decision is about. This version has materials alone: their surfaces and what fills them.
struct Subject {
    enum class Kind : std::uint8_t { material, volume, layer, emitter } kind = Kind::material;
    std::uint32_t index = 0;  ///< material: index into Scene::materials
    std::string name;         ///< for messages and reports: "material 'Floor'"
};

}  // namespace opaline::bake
