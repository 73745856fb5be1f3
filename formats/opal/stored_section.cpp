#include "formats/opal/stored_section.h"

#include <xxhash.h>
#include <zstd.h>

#include <cassert>
#include <memory>

#include "formats/opal/layout.h"

namespace opaline::formats {
namespace {

constexpr int kZstdLevel = 6;
constexpr std::byte kZeros[kSectionAlignment] = {};

// Makes of `stored` one part, if that is smaller.
void compress(StoredSection& stored) {
    std::vector<std::byte> plain;
    plain.reserve(stored.entry.size);
    for (const auto part : stored.parts) {
        plain.insert(plain.end(), part.begin(), part.end());
    }
    std::vector<std::byte> out(ZSTD_compressBound(plain.size()));
    const std::size_t size =
        ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0U || size >= plain.size() ||
        plain.size() / size >= kMaxCompressionRatio) {
        return;
    }
    out.resize(size);
    stored.compressed = std::move(out);
    stored.entry.codec = static_cast<std::uint32_t>(Codec::zstd);
    stored.parts = {stored.compressed};
}

void sum_up(StoredSection& stored) {
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                                XXH3_freeState);
    XXH3_64bits_reset(state.get());
    for (const auto part : stored.parts) {
        XXH3_64bits_update(state.get(), part.data(), part.size());
        stored.entry.stored_size += part.size();
    }
    stored.entry.checksum = XXH3_64bits_digest(state.get());
}

}  // namespace

std::size_t padding_to(std::size_t alignment, std::uint64_t size) {
    return static_cast<std::size_t>((alignment - size % alignment) % alignment);
}

std::span<const std::byte> padding_zeros(std::size_t count) {
    assert(count <= sizeof kZeros);
    return {kZeros, count};
}

StoredSection store_arrays(std::uint32_t id, Codec codec,
                           std::span<const std::span<const std::byte>> arrays) {
    StoredSection stored;
    stored.entry.id = id;
    for (const std::span<const std::byte> array : arrays) {
        const std::size_t padding = padding_to(kArrayAlignment, array.size());
        stored.parts.push_back(array);
        stored.parts.push_back(padding_zeros(padding));
        stored.entry.size += array.size() + padding;
    }
    if (codec == Codec::zstd) compress(stored);
    sum_up(stored);
    return stored;
}

StoredSection store_text(std::uint32_t id, std::span<const char> text) {
    StoredSection stored;
    stored.entry.id = id;
    stored.parts = {std::as_bytes(text)};
    stored.entry.size = text.size();
    sum_up(stored);
    return stored;
}

}  // namespace opaline::formats
