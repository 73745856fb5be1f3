#include "formats/gltf/gltf_buffer.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace opaline::formats {
namespace {

// Values fixed by the glTF 2.0 specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

void append_word(std::string& bytes, std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<char>(word >> shift & 0xffu));
    }
}

void pad_to_words(std::string& bytes, char with) {
    bytes.append((4 - bytes.size() % 4) % 4, with);
}

}  // namespace

std::size_t GltfBuffer::add_view(std::size_t offset, int target) {
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes_.size() - offset}});
    if (target != 0) views_.back()["target"] = target;
    return views_.size() - 1;
}

std::size_t GltfBuffer::add_accessor(int component, const char* type, std::size_t count) {
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return accessors_.size() - 1;
}

template <class T>
std::size_t GltfBuffer::add_vectors(std::span<const T> vectors, Bounds bounds) {
    constexpr std::size_t kComponents = sizeof(T) / sizeof(float);
    constexpr const char* kTypes[] = {"VEC2", "VEC3", "VEC4"};
    using Floats = std::array<float, kComponents>;
    assert(!vectors.empty());
    const std::size_t offset = bytes_.size();
    auto low = std::bit_cast<Floats>(vectors.front()), high = low;
    for (const T& vector : vectors) {
        const auto floats = std::bit_cast<Floats>(vector);
        for (std::size_t i = 0; i < kComponents; ++i) {
            low[i] = std::min(low[i], floats[i]);
            high[i] = std::max(high[i], floats[i]);
            append_word(bytes_, std::bit_cast<std::uint32_t>(floats[i]));
        }
    }
    add_view(offset, kArrayBuffer);
    const std::size_t index = add_accessor(kFloat, kTypes[kComponents - 2], vectors.size());
    if (bounds == Bounds::stated) {
        accessors_[index]["min"] = low;
        accessors_[index]["max"] = high;
    }
    return index;
}

template std::size_t GltfBuffer::add_vectors(std::span<const Float2>, Bounds);
template std::size_t GltfBuffer::add_vectors(std::span<const Vec3>, Bounds);
template std::size_t GltfBuffer::add_vectors(std::span<const Rgb>, Bounds);
template std::size_t GltfBuffer::add_vectors(std::span<const std::array<float, 4>>, Bounds);

std::size_t GltfBuffer::add_indices(std::span<const std::uint32_t> indices) {
    assert(!indices.empty());
    const std::size_t offset = bytes_.size();
    for (const std::uint32_t v : indices) {
        append_word(bytes_, v);
    }
    add_view(offset, kElementArrayBuffer);
    const std::size_t index = add_accessor(kUnsignedInt, "SCALAR", indices.size());
    accessors_[index]["min"] = {std::ranges::min(indices)};
    accessors_[index]["max"] = {std::ranges::max(indices)};
    return index;
}

std::size_t GltfBuffer::add_file(std::string_view file) {
    const std::size_t offset = bytes_.size();
    bytes_ += file;
    const std::size_t index = add_view(offset, 0);
    pad_to_words(bytes_, '\0');
    return index;
}

Error refuse_glb_size(const std::string& name) {
    return make_error(ErrorKind::resource, name, "", "would be a .glb of 4 GiB or more",
                      "bake fewer meshes into one file");
}

Result<std::string> pack_glb(const GltfJson& document, std::string_view buffer,
                             const std::string& name) {
    std::string json = document.dump();
    pad_to_words(json, ' ');
    const std::size_t padding = (4 - buffer.size() % 4) % 4;
    const std::size_t size = 12 + 8 + json.size() + 8 + buffer.size() + padding;
    if (size > kMostGlbBytes) return refuse_glb_size(name);
    std::string glb;
    glb.reserve(size);
    const auto append_chunk = [&](std::uint32_t type, std::string_view chunk, std::size_t pad) {
        append_word(glb, static_cast<std::uint32_t>(chunk.size() + pad));
        append_word(glb, type);
        glb += chunk;
        glb.append(pad, '\0');
    };
    append_word(glb, kGlbMagic);
    append_word(glb, 2);
    append_word(glb, static_cast<std::uint32_t>(size));
    append_chunk(kJsonChunk, json, 0);
    append_chunk(kBinChunk, buffer, padding);
    return glb;
}

}  // namespace opaline::formats
