#include "bake/lab/compare/relight_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "formats/image/exr.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/file_bytes.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::Image;
using formats::Result;
using formats::Rgb;
using formats::Status;
using formats::Vec3;

constexpr std::string_view kHeader = "primitive,vertex,r,g,b";
constexpr std::string_view kVolumeHeader = "volume,i,j,k,r,g,b";
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::string_view take_line(std::string_view& rest) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

/// The next field, without its comma; nothing is left of `rest` after the last one.
std::string_view take_field(std::string_view& rest) {
    const std::size_t length = std::min(rest.find(','), rest.size());
    const std::string_view field = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    return field;
}

template <class T>
bool parse_number(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// Empty on success, else what is wrong with the line.
std::string parse_row(std::string_view line, RelightRow& row) {
    constexpr std::array<std::string_view, 5> names{"primitive", "vertex", "r", "g", "b"};
    const std::array<float*, 3> bands{&row.radiance.r, &row.radiance.g, &row.radiance.b};
    std::string_view rest = line;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string_view field = take_field(rest);
        const auto fault = [&](const char* expected) {
            return std::string(names[i]) + " is '" + std::string(field.substr(0, 40)) +
                   "', expected " + expected;
        };
        if (i < 2) {
            if (!parse_number(field, i == 0 ? row.primitive : row.vertex)) {
                return fault("a whole number from 0 to 4294967295");
            }
        } else if (!parse_number(field, *bands[i - 2]) || !std::isfinite(*bands[i - 2])) {
            return fault("a finite number in the range of a float");
        }
    }
    return {};
}

/// Collects output and hands it over in large pieces.
struct BufferedFile {
    formats::AtomicFile file;
    std::string buffer;

    Status flush() {
        Status status = file.write(buffer);
        buffer.clear();
        return status;
    }
};

void append_number(std::string& text, float value) {
    std::array<char, 32> digits{};
    // Like %.9g, but in every locale.
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                            std::chars_format::general, 9);
    text.append(digits.data(), end);
}

/// Ends a line: ",r,g,b".
void append_color(std::string& text, Rgb color) {
    for (const float v : {color.r, color.g, color.b}) {
        text += ',';
        append_number(text, v);
    }
    text += '\n';
}

void append_bytes(std::string& bytes, std::array<float, 6> values) {
    for (const float value : values) {
        const auto code = std::bit_cast<std::uint32_t>(value);
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes.push_back(static_cast<char>(code >> shift & 0xff));
        }
    }
}

/// Writes a head, then one record per row.
template <class AppendRecord>
Status write_records(const std::filesystem::path& path, std::string head, std::size_t count,
                     AppendRecord append) {
    Result<formats::AtomicFile> file = formats::AtomicFile::create(path);
    if (!file) return std::move(file).error();
    BufferedFile out{std::move(*file), std::move(head)};
    for (std::size_t i = 0; i < count; ++i) {
        append(out.buffer, i);
        if (out.buffer.size() >= kBufferBytes) {
            if (Status status = out.flush(); !status) return status;
        }
    }
    if (Status status = out.flush(); !status) return status;
    return out.file.commit();
}

}  // namespace

Result<std::vector<RelightRow>> decode_relight_csv(std::span<const std::byte> bytes,
                                                   const std::string& name) {
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto fail = [&](std::size_t line, std::string fault) -> formats::Error {
        return formats::make_error(ErrorKind::bad_input, name, "line " + std::to_string(line),
                                   std::move(fault), "write the table again with relight");
    };
    const std::string_view header = take_line(rest);
    if (!header.starts_with(kHeader) ||
        (header.size() > kHeader.size() && header[kHeader.size()] != ',')) {
        return fail(
            1, "is not the header of a relight table, expected '" + std::string(kHeader) + "'");
    }
    const auto commas = std::count(header.begin(), header.end(), ',');
    std::vector<RelightRow> rows;
    for (std::size_t number = 2; !rest.empty(); ++number) {
        const std::string_view line = take_line(rest);
        if (line.empty() && rest.empty()) break;
        const auto found = std::count(line.begin(), line.end(), ',');
        if (found != commas) {
            return fail(number, "has " + std::to_string(found + 1) + " fields, expected " +
                                    std::to_string(commas + 1));
        }
        RelightRow row;
        if (std::string fault = parse_row(line, row); !fault.empty()) {
            return fail(number, std::move(fault));
        }
        rows.push_back(row);
    }
    return rows;
}

Result<std::vector<RelightRow>> read_relight_csv(const std::filesystem::path& path) {
    Result<formats::FileBytes> file = formats::FileBytes::open(path);
    if (!file) return std::move(file).error();
    return decode_relight_csv(file->bytes(), path.string());
}

Status write_relight_csv(const std::filesystem::path& path, std::span<const RelightRow> rows) {
    return write_records(path, std::string(kHeader) + "\n", rows.size(),
                         [&](std::string& text, std::size_t i) {
                             const RelightRow& row = rows[i];
                             text += std::to_string(row.primitive);
                             text += ',';
                             text += std::to_string(row.vertex);
                             append_color(text, row.radiance);
                         });
}

Status write_volume_csv(const std::filesystem::path& path, std::span<const VolumeRow> rows) {
    return write_records(path, std::string(kVolumeHeader) + "\n", rows.size(),
                         [&](std::string& text, std::size_t i) {
                             const VolumeRow& row = rows[i];
                             text += std::to_string(row.volume);
                             for (const std::int32_t v : row.voxel) {
                                 text += ',';
                                 text += std::to_string(v);
                             }
                             append_color(text, row.radiance);
                         });
}

Status write_relight_ply(const std::filesystem::path& path, std::span<const Vec3> positions,
                         std::span<const RelightRow> rows) {
    assert(positions.size() == rows.size());
    std::string head =
        "ply\nformat binary_little_endian 1.0\ncomment linear Rec. 709 radiance\nelement vertex " +
        std::to_string(rows.size()) + "\n";
    for (const char* property : {"x", "y", "z", "red", "green", "blue"}) {
        head += std::string("property float ") + property + "\n";
    }
    head += "end_header\n";
    return write_records(path, std::move(head), rows.size(),
                         [&](std::string& bytes, std::size_t i) {
                             const Vec3 p = positions[i];
                             const Rgb c = rows[i].radiance;
                             append_bytes(bytes, {p.x, p.y, p.z, c.r, c.g, c.b});
                         });
}

Status write_relight_exr(const std::filesystem::path& path, std::span<const RelightRow> rows) {
    constexpr std::uint32_t kWidth = 1024;
    if (rows.empty()) {
        return formats::make_error(ErrorKind::usage, path.string(), "",
                                   "a table without receivers has no image", "write .csv instead");
    }
    const auto height = static_cast<std::uint32_t>((rows.size() + kWidth - 1) / kWidth);
    Image image{kWidth, height, {}};
    image.pixel.reserve(std::size_t{kWidth} * height);
    for (const RelightRow& row : rows) {
        image.pixel.push_back(row.radiance);
    }
    image.pixel.resize(std::size_t{kWidth} * height);
    return formats::write_exr(path, image);
}

}  // namespace opaline::bake
