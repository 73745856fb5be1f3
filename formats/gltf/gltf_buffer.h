#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::formats {

/// A glTF document that is written: keys stay in the order of writing, as in the specification's
/// examples.
using GltfJson = nlohmann::ordered_json;

/// Whether an accessor states the smallest and largest value of each component.
enum class Bounds { none, stated };

/// The buffer of a glTF file while it grows. Each array has a view of its own, without gaps between
/// its elements; views begin at multiples of four bytes.
class GltfBuffer {
  public:
    /// Adds vectors of 2, 3 or 4 floats as vertex attributes; T: Float2, Vec3, Rgb or
    /// std::array<float, 4>. Returns the accessor's index. Precondition: not empty.
    template <class T>
    std::size_t add_vectors(std::span<const T> vectors, Bounds bounds);

    /// Adds corners of triangles. Returns the accessor's index. Precondition: not empty.
    std::size_t add_indices(std::span<const std::uint32_t> indices);

    /// Adds a file, of an image. Returns the view's index.
    std::size_t add_file(std::string_view file);

    const GltfJson& views() const { return views_; }
    const GltfJson& accessors() const { return accessors_; }
    const std::string& bytes() const { return bytes_; }

  private:
    std::size_t add_view(std::size_t offset, int target);
    std::size_t add_accessor(int component, const char* type, std::size_t count);

    GltfJson views_ = GltfJson::array(), accessors_ = GltfJson::array();
    std::string bytes_;
};

/// The most bytes of a .glb, whose header states them in 32 bits.
inline constexpr std::uint64_t kMostGlbBytes = 0xffffffff;
/// That it would have more. Errors: resource.
Error refuse_glb_size(const std::string& name);

/// A binary glTF file of one document, whose only buffer holds `buffer`. `name` is used in messages
/// only. Errors: resource, for more than kMostGlbBytes.
Result<std::string> pack_glb(const GltfJson& document, std::string_view buffer,
                             const std::string& name);

}  // namespace opaline::formats
