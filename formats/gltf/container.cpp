#include "formats/gltf/container.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

namespace opaline::formats::gltf {

static_assert(std::endian::native == std::endian::little, "glTF data is read in place");

namespace {

constexpr std::uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::optional<Container> split_binary(std::span<const std::byte> bytes, Report& report) {
    const char* again = "copy or export the file again";
    if (bytes.size() < 20) {
        return report.fail("binary header",
                           "the file ends after " + std::to_string(bytes.size()) +
                               " bytes, before its first chunk",
                           again);
    }
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
        return report.fail("binary header",
                           "container version is " + std::to_string(version) + ", expected 2",
                           "export as glTF 2.0");
    }
    const std::size_t length = read_u32(bytes, 8);
    if (length > bytes.size() || length < 20) {
        return report.fail("binary header",
                           "the header says " + std::to_string(length) + " bytes, the file has " +
                               std::to_string(bytes.size()),
                           again);
    }
    if (length < bytes.size()) {
        report.warn("binary header", std::to_string(bytes.size() - length) +
                                         " bytes after the end of the asset are ignored");
    }
    Container container;
    bool first = true;
    for (std::size_t at = 12; at < length;) {
        const std::string where = "chunk at byte " + std::to_string(at);
        if (length - at < 8) return report.fail(where, "its header is cut off", again);
        const std::size_t size = read_u32(bytes, at);
        const std::uint32_t type = read_u32(bytes, at + 4);
        at += 8;
        if (size > length - at) {
            return report.fail(where,
                               "it says " + std::to_string(size) + " bytes, but only " +
                                   std::to_string(length - at) + " remain",
                               again);
        }
        const auto chunk = bytes.subspan(at, size);
        at += size;
        if (first && type != kJsonChunk) {
            return report.fail(where, "the first chunk is not JSON", again);
        }
        if (first) {
            container.json = as_text(chunk);
        } else if (type == kBinChunk && !container.bin) {
            container.bin = chunk;
        }  // the specification tells readers to skip other chunks
        first = false;
    }
    return container;
}

}  // namespace

std::optional<std::vector<std::byte>> read_whole_file(const std::filesystem::path& path,
                                                      const std::string& where, Report& report) {
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (!std::filesystem::is_regular_file(status)) {
        const bool exists = std::filesystem::exists(status);
        return report.fail(where, exists ? "it is not a regular file" : "the file cannot be found",
                           "check the path");
    }
    const auto size = std::filesystem::file_size(path, code);
    if (code) return report.fail(where, "its size cannot be read: " + code.message(), "");
    if (size > kMaxFileBytes) {
        report.over_limit(where,
                          "it has " + std::to_string(size) + " bytes, the limit is " +
                              std::to_string(kMaxFileBytes),
                          "split the asset");
        return std::nullopt;
    }
    std::vector<std::byte> bytes(size);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!stream || static_cast<std::uintmax_t>(stream.gcount()) != size) {
        return report.fail(where, "the file cannot be read", "check its permissions");
    }
    return bytes;
}

std::optional<Container> split_container(std::span<const std::byte> bytes, Report& report) {
    if (bytes.size() >= 4 && read_u32(bytes, 0) == kMagic) return split_binary(bytes, report);
    const std::string_view text = as_text(bytes);
    const std::size_t start = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (start == std::string_view::npos || text[start] != '{') {
        return report.fail("",
                           text.empty()
                               ? "the file is empty"
                               : "this is not glTF: it starts neither with 'glTF' (binary) "
                                 "nor with a JSON object",
                           "give a .gltf or .glb file");
    }
    return Container{text, std::nullopt};
}

}  // namespace opaline::formats::gltf
