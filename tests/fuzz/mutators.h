#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace opaline::fuzz {

using Blob = std::vector<std::uint8_t>;

/// libFuzzer's own mutation of some bytes, to at most `most` of them.
Blob mutate_bytes(const Blob& bytes, std::size_t most);

/// Of JSON: a value replaced, copied to another place, taken away, or bytes of the text changed.
std::string mutate_json(const std::string& text, unsigned seed, std::size_t most);

/// Each changes one thing, and lengths and checksums around it so that readers come to it; the
/// bytes as they are mutated where they are no such file. Nothing: too long. Of `.opal` files: a
/// section's content, its entry in the table, or whether it is there.
Blob mutate_opal(const Blob& bytes, unsigned seed, std::size_t most);
/// Of binary glTF: the JSON, or the buffer.
Blob mutate_glb(const Blob& bytes, unsigned seed, std::size_t most);

}  // namespace opaline::fuzz
