#pragma once

#include <cstddef>
#include <cstdint>

namespace opaline::formats::gltf {

/// Limits for untrusted files: far above any asset that can be baked, and low enough that a few
/// hostile bytes cannot exhaust the machine.
inline constexpr std::uint64_t kMaxFileBytes = 8ull << 30;    ///< one file
inline constexpr std::uint64_t kMaxTotalBytes = 16ull << 30;  ///< all buffers together
inline constexpr std::size_t kMaxJsonBytes = 256u << 20;
inline constexpr std::size_t kMaxJsonValues = 4'000'000;
inline constexpr std::size_t kMaxJsonObjects = 1'000'000;
inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::uint64_t kMaxWorldVertices = 200'000'000;  ///< over all instances
inline constexpr std::uint64_t kMaxWorldIndices = 1'200'000'000;
inline constexpr std::size_t kMaxWorldPrimitives = 1u << 20;
inline constexpr std::size_t kMaxWorldLights = 4096;
inline constexpr std::size_t kMaxWorldJoints = 1u << 20;          ///< of all skinned meshes
inline constexpr std::uint64_t kMaxImplicitElements = 4'000'000;  ///< accessor without buffer view
inline constexpr std::uint32_t kMaxImageSide = 16384;
inline constexpr std::uint64_t kMaxImagePixels = 1ull << 27;
inline constexpr std::size_t kMaxDiagnostics = 64;

}  // namespace opaline::formats::gltf
