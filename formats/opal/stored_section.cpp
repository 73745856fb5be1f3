#include "formats/opal/stored_section.h"

#include <xxhash.h>
#include <zstd.h>

#include <cassert>
#include <memory>
#include <utility>

#include "formats/opal/layout.h"

namespace opaline::formats {
namespace {

constexpr std::byte kZeros[kSectionAlignment] = {};

// Makes of `stored` one part, if that is smaller. Part by part, as a copy of the whole section
// would double the memory of large ones.
void compress(StoredSection& stored, int level) {
    const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(),
                                                                          ZSTD_freeCCtx);
    if (!context) return;
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
    ZSTD_CCtx_setPledgedSrcSize(context.get(), stored.entry.size);
    std::vector<std::byte> out;
    const std::size_t step = ZSTD_CStreamOutSize();
    for (std::size_t i = 0; i < stored.parts.size(); ++i) {
        const bool is_last = i + 1 == stored.parts.size();
        ZSTD_inBuffer in{stored.parts[i].data(), stored.parts[i].size(), 0};
        std::size_t unwritten = is_last ? 1 : 0;  // of the frame, which ends with the last part
        while (in.pos < in.size || (is_last && unwritten != 0)) {
            const std::size_t before = out.size();
            out.resize(before + step);
            ZSTD_outBuffer room{out.data() + before, step, 0};
            unwritten = ZSTD_compressStream2(context.get(), &room, &in,
                                             is_last ? ZSTD_e_end : ZSTD_e_continue);
            out.resize(before + room.pos);
            if (ZSTD_isError(unwritten) != 0U || out.size() >= stored.entry.size) return;
        }
    }
    if (stored.entry.size / out.size() >= kMaxCompressionRatio) return;
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

StoredSection store_arrays(std::uint32_t id, int zstd_level,
                           std::span<const std::span<const std::byte>> arrays) {
    StoredSection stored;
    stored.entry.id = id;
    for (const std::span<const std::byte> array : arrays) {
        const std::size_t padding = padding_to(kArrayAlignment, array.size());
        stored.parts.push_back(array);
        stored.parts.push_back(padding_zeros(padding));
        stored.entry.size += array.size() + padding;
    }
    if (zstd_level != kNotCompressed) compress(stored, zstd_level);
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
