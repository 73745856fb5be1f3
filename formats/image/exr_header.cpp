#include "formats/image/exr_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

#include "formats/image/image_kind.h"

namespace opaline::formats {
namespace {

constexpr std::uint32_t kTiledFlag = 0x200, kLongNamesFlag = 0x400, kDeepFlag = 0x800,
                        kPartsFlag = 0x1000;
constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1} << 28;  // uncompressed, all channels
constexpr std::size_t kMaxChannels = 1024, kMaxParts = 256;

/// A fault: what was found and expected, and what to do.
struct Fault {
    std::string what;
    std::string remedy = "the file is damaged: export it again";
};

/// Reads little-endian values; once past the end everything is 0 and `ok` is false.
struct ByteReader {
    std::string_view bytes;
    std::size_t position = 0;
    bool ok = true;

    template <class T>
    T read() {
        T value{};
        if (bytes.size() - position < sizeof(T)) {
            ok = false;
            return value;
        }
        std::memcpy(&value, bytes.data() + position, sizeof(T));
        position += sizeof(T);
        return value;
    }

    /// Zero-terminated, at most `longest` characters; empty at the end of a list and on failure.
    std::string_view read_name(std::size_t longest) {
        const std::string_view rest = bytes.substr(position, longest + 1);
        const std::size_t length = rest.find('\0');
        if (length == std::string_view::npos) {
            ok = false;
            return {};
        }
        position += length + 1;
        return rest.substr(0, length);
    }
};

struct TileDescription {
    std::uint32_t width = 0, height = 0;
    std::uint8_t mode = 0;
};

struct Parsed {
    ExrHeader header;
    std::array<std::int32_t, 4> window{};
    bool has_channels = false, has_window = false, has_compression = false;
    std::uint8_t compression = 0;
    std::uint64_t bytes_per_pixel = 0;
    std::optional<TileDescription> tiles;
    bool is_tiled = false;
    std::uint64_t chunks = 0;
};

std::optional<Fault> read_channels(ByteReader in, std::size_t longest_name, Parsed& parsed) {
    parsed.has_channels = true;
    while (true) {
        const std::string_view name = in.read_name(longest_name);
        if (!in.ok) break;
        if (name.empty()) {
            if (in.position != in.bytes.size()) break;
            return std::nullopt;
        }
        const auto type = in.read<std::uint32_t>();
        in.read<std::uint32_t>();  // linearity flag and padding
        const auto x_sampling = in.read<std::int32_t>(), y_sampling = in.read<std::int32_t>();
        if (!in.ok || type > 2 || x_sampling < 1 || y_sampling < 1) break;
        parsed.bytes_per_pixel += type == 1 ? 2 : 4;
        const bool is_full = x_sampling == 1 && y_sampling == 1;
        (is_full ? parsed.header.full_size : parsed.header.subsampled).emplace_back(name);
        if (parsed.header.full_size.size() + parsed.header.subsampled.size() > kMaxChannels) {
            return Fault{"has more than " + std::to_string(kMaxChannels) + " channels",
                         "keep the colour channels only"};
        }
    }
    return Fault{"its channel list is malformed"};
}

/// Takes one attribute in; `keep` becomes true if OpenEXR needs to see it too.
std::optional<Fault> read_attribute(std::string_view name, std::string_view type, ByteReader in,
                                    std::size_t longest_name, Parsed& parsed, bool& keep) {
    const std::size_t size = in.bytes.size();
    struct Known {
        std::string_view name, type;
        std::size_t size;  ///< 0: any
    };
    constexpr std::array<Known, 9> known{{{"channels", "chlist", 0},
                                          {"compression", "compression", 1},
                                          {"dataWindow", "box2i", 16},
                                          {"displayWindow", "box2i", 16},
                                          {"lineOrder", "lineOrder", 1},
                                          {"pixelAspectRatio", "float", 4},
                                          {"screenWindowCenter", "v2f", 8},
                                          {"screenWindowWidth", "float", 4},
                                          {"tiles", "tiledesc", 9}}};
    const auto* const match =
        std::find_if(known.begin(), known.end(), [&](const Known& k) { return k.name == name; });
    keep = match != known.end();
    if (keep && (match->type != type || (match->size != 0 && match->size != size))) {
        return Fault{"its attribute '" + std::string(name) + "' has the wrong type or size"};
    }
    if (name == "channels") return read_channels(in, longest_name, parsed);
    if (name == "dataWindow") {
        parsed.has_window = true;
        parsed.window = in.read<std::array<std::int32_t, 4>>();
    } else if (name == "compression") {
        parsed.has_compression = true;
        parsed.compression = in.read<std::uint8_t>();
    } else if (name == "tiles") {
        const auto width = in.read<std::uint32_t>(), height = in.read<std::uint32_t>();
        parsed.tiles = TileDescription{width, height, in.read<std::uint8_t>()};
    } else if (name == "chromaticities" && type == "chromaticities" && size == 32) {
        parsed.header.chromaticities = in.read<Chromaticities>();
    } else if (name == "envmap" && type == "envmap" && size == 1) {
        const auto value = in.read<std::uint8_t>();
        if (value > 1) return Fault{"its envmap attribute is neither lat-long nor cube"};
        parsed.header.envmap = value == 0 ? Envmap::lat_long : Envmap::cube;
    }
    return std::nullopt;
}

/// Chunks of a tiled image over all its levels; stops counting above `limit`.
std::uint64_t count_tiles(const TileDescription& tiles, std::uint64_t width, std::uint64_t height,
                          std::uint64_t limit) {
    const bool round_up = (tiles.mode >> 4) == 1;
    const auto level_size = [&](std::uint64_t size, int level) {
        const std::uint64_t scale = std::uint64_t{1} << level;
        return std::max<std::uint64_t>(1, (round_up ? size + scale - 1 : size) / scale);
    };
    const auto tiles_along = [](std::uint64_t size, std::uint64_t tile) {
        return (size + tile - 1) / tile;
    };
    const int levels = 28;  // images of at most 2^27 pixels
    const int kind = tiles.mode & 15;
    std::uint64_t count = 0;
    for (int y = 0; y < levels && count <= limit; ++y) {
        for (int x = 0; x < levels; ++x) {
            if ((kind == 0 && (x > 0 || y > 0)) || (kind == 1 && x != y)) continue;
            const std::uint64_t w = level_size(width, x), h = level_size(height, y);
            // Past the level of size 1 the same tile would be counted again and again.
            const bool past_end = (x > 0 && level_size(width, x - 1) == 1 &&
                                   (kind == 2 || y == 0 || level_size(height, y - 1) == 1)) ||
                                  (kind == 2 && y > 0 && level_size(height, y - 1) == 1);
            if (past_end) continue;
            count += tiles_along(w, tiles.width) * tiles_along(h, tiles.height);
        }
    }
    return count;
}

std::optional<Fault> check_sizes(Parsed& parsed, std::uint64_t file_bytes) {
    if (!parsed.has_channels || !parsed.has_window || !parsed.has_compression) {
        return Fault{"its header lacks channels, dataWindow or compression"};
    }
    const auto [x0, y0, x1, y1] = parsed.window;
    const std::int64_t width = std::int64_t{x1} - x0 + 1, height = std::int64_t{y1} - y0 + 1;
    constexpr std::int64_t kFarthest = 1 << 28;  // keeps OpenEXR's own pointer sums in range
    const bool is_near = std::min(x0, y0) > -kFarthest && std::max(x1, y1) < kFarthest;
    if (!is_near || width < 1 || height < 1 ||
        !is_plausible_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                           file_bytes)) {
        return Fault{
            "claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels in " +
                std::to_string(file_bytes) + " bytes",
            "at most 16384 x 8192 pixels; above 16 million, at most 16 of them a byte of the file"};
    }
    parsed.header.min_x = x0;
    parsed.header.min_y = y0;
    parsed.header.width = static_cast<std::uint32_t>(width);
    parsed.header.height = static_cast<std::uint32_t>(height);

    constexpr std::array<std::uint32_t, 10> lines_per_chunk{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    if (parsed.compression >= lines_per_chunk.size()) {
        return Fault{"its compression " + std::to_string(parsed.compression) + " is unknown",
                     "save it with ZIP compression"};
    }
    std::uint64_t chunk_pixels = 0;
    if (parsed.is_tiled) {
        const TileDescription tiles = parsed.tiles.value_or(TileDescription{});
        if (tiles.width == 0 || tiles.height == 0 || tiles.width > 16384 || tiles.height > 16384 ||
            (tiles.mode & 15) > 2 || (tiles.mode >> 4) > 1) {
            return Fault{"its tile description is missing or malformed"};
        }
        // A row of tiles is decoded at a time.
        const std::uint64_t row = std::max<std::uint64_t>(parsed.header.width, tiles.width);
        chunk_pixels = row * tiles.height;
        parsed.chunks = count_tiles(tiles, parsed.header.width, parsed.header.height, file_bytes);
    } else {
        const std::uint32_t lines = lines_per_chunk[parsed.compression];
        chunk_pixels = std::uint64_t{parsed.header.width} * lines;
        parsed.chunks = (parsed.header.height + lines - 1) / lines;
    }
    if (chunk_pixels * parsed.bytes_per_pixel > kMaxChunkBytes) {
        return Fault{"one of its chunks would take " +
                         std::to_string(chunk_pixels * parsed.bytes_per_pixel) + " bytes",
                     "keep the colour channels only, with smaller tiles"};
    }
    return std::nullopt;
}

/// The type of a part of several, as its attribute states it.
std::optional<Fault> read_part_type(std::string_view type, Parsed& parsed) {
    const bool is_deep = type == "deepscanline" || type == "deeptile";
    if (!is_deep && type != "scanlineimage" && type != "tiledimage") {
        return Fault{"has a part of the type '" + std::string(type.substr(0, 60)) + "'",
                     "save it as a single flat image"};
    }
    parsed.header.is_deep = is_deep;
    parsed.is_tiled = type == "tiledimage" || type == "deeptile";
    return std::nullopt;
}

/// Parses one header at `in`, up to and with the zero that ends it. Attributes that OpenEXR need
/// not see become opaque in `bytes`, which `in` views.
std::optional<Fault> read_header(std::string& bytes, ByteReader& in, std::uint32_t version,
                                 Parsed& parsed) {
    const std::size_t longest_name = (version & kLongNamesFlag) != 0 ? 255 : 31;
    const bool has_parts = (version & kPartsFlag) != 0;
    parsed.is_tiled = (version & kTiledFlag) != 0;
    while (true) {
        const std::size_t name_at = in.position;
        const std::string_view attribute = in.read_name(longest_name);
        if (!in.ok) return Fault{"is cut off or damaged within its header"};
        if (attribute.empty()) break;
        const std::size_t type_at = in.position;
        const std::string_view type = in.read_name(longest_name);
        const auto size = in.read<std::uint32_t>();
        if (!in.ok || type.empty() || size > bytes.size() - in.position) {
            return Fault{"is cut off or damaged within its header"};
        }
        bool keep = false;
        const std::string_view value = in.bytes.substr(in.position, size);
        if (auto fault =
                read_attribute(attribute, type, ByteReader{value}, longest_name, parsed, keep)) {
            return fault;
        }
        if (has_parts && attribute == "type") {
            if (auto fault = read_part_type(value, parsed)) return fault;
        }
        // Parts are told apart by these.
        keep = keep || (has_parts && ((attribute == "type" && type == "string") ||
                                      (attribute == "name" && type == "string") ||
                                      (attribute == "chunkCount" && type == "int" && size == 4)));
        if (!keep) {
            if (attribute == "type") bytes[name_at] = '~';  // OpenEXR adds its own
            std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(type_at),
                      bytes.begin() + static_cast<std::ptrdiff_t>(type_at + type.size()), '~');
        }
        in.position += size;
    }
    return check_sizes(parsed, bytes.size());
}

}  // namespace

Result<std::vector<ExrHeader>> check_exr_headers(std::string& bytes, const std::string& name) {
    const auto fail = [&](const Fault& fault) -> Error {
        return make_error(ErrorKind::bad_input, name, "", fault.what, fault.remedy);
    };
    ByteReader in{bytes};
    const auto magic = in.read<std::uint32_t>(), version = in.read<std::uint32_t>();
    if (!in.ok || magic != 20000630u) {
        return fail({"is not an OpenEXR file", "give an OpenEXR image"});
    }
    const bool has_parts = (version & kPartsFlag) != 0;
    const std::uint32_t known = kLongNamesFlag | (has_parts ? kPartsFlag | kDeepFlag : kTiledFlag);
    if ((version & 0xff) != 2 || (version & ~(0xffu | known)) != 0) {
        return fail({"is an OpenEXR file of deep data, or of a later version",
                     "save it as a single flat image"});
    }
    std::vector<ExrHeader> parts;
    std::uint64_t chunks = 0;
    do {
        Parsed parsed;
        if (auto fault = read_header(bytes, in, version, parsed)) return fail(*fault);
        chunks += parsed.chunks;
        parts.push_back(std::move(parsed.header));
        if (parts.size() > kMaxParts) {
            return fail({"has more than " + std::to_string(kMaxParts) + " parts",
                         "keep the part with the colours only"});
        }
    } while (has_parts && in.position < bytes.size() && bytes[in.position] != '\0');
    if (chunks > (bytes.size() - in.position) / 8) {
        return fail({"is cut off: its table of " + std::to_string(chunks) +
                     " chunks does not fit in the file"});
    }
    return parts;
}

}  // namespace opaline::formats
