#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/fault.h"
#include "formats/opal/vec3.h"

namespace opaline::formats {

struct AssetView;

/// That a primitive repeats an earlier or later one elsewhere: it has the same triangles, vertices
/// and rows, its positions moved by `offset`. Fixed size, stored as is; formats/README.md, `COPY`.
struct CopyRecord {
    std::uint32_t primitive = 0, original = 0;  ///< the original is no copy; of diffuse shading
    Vec3 offset;                                ///< [m], finite
    std::uint32_t reserved = 0;
};
static_assert(sizeof(CopyRecord) == 24);

/// What vertices and indices of copies take at most once they are restored [bytes].
std::uint64_t bytes_of_copies(std::uint64_t vertices, std::uint64_t indices);

/// What all copies of a file may take, besides kMaxCompressionRatio times the file [bytes].
inline constexpr std::uint64_t kMostBytesOfCopies = std::uint64_t{1} << 31;

/// What is wrong with the copies of a view as it stands in a file, whose copies have no vertices,
/// indices or slots. `file_size` [bytes].
Fault find_copies_fault(const AssetView& stored, std::uint64_t file_size);

/// Bytes that restore_copies makes. Precondition: find_copies_fault finds none.
std::size_t size_with_copies(const AssetView& stored);

/// Gives the copies of such a view vertices, indices and slots of their own; their rows are the
/// originals'. The arrays lie in `bytes` of the size above, aligned to 8. Precondition:
/// find_copies_fault finds none.
void restore_copies(AssetView& view, std::span<std::byte> bytes);

/// Vertices that a view as it stands in a file will have once it is restored.
std::uint64_t count_restored_vertices(const AssetView& stored);

/// Vertices of a restored view that stand in its file: all but those of copies.
std::uint32_t count_stored_vertices(const AssetView& restored);

/// Numbers of those vertices, as of all vertices of the restored view.
std::vector<float> spread_to_copies(const AssetView& restored, std::span<const float> stored);

}  // namespace opaline::formats
