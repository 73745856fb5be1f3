#include "formats/image/hdr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <string_view>

#include "formats/image/image_kind.h"

namespace opaline::formats {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr double kLargest = std::numeric_limits<float>::max();

using Rgbe = std::array<std::uint8_t, 4>;

struct Header {
    std::uint64_t width = 0, height = 0;
    bool is_column_wise = false;  ///< a scan line is a column of the picture
    bool is_mirrored = false;     ///< from right to left
    bool is_upside_down = false;  ///< from the bottom up
    double exposure = 1;
    std::vector<std::string> ignored;  ///< header lines that change colours, not applied
};

/// The rest of the file; lines and bytes are taken from its front.
struct Input {
    std::string_view rest;

    /// False if there is no further complete line.
    bool take_line(std::string_view& line) {
        const std::size_t length = rest.substr(0, kLongestLine).find('\n');
        if (length == std::string_view::npos) return false;
        line = rest.substr(0, length);
        if (line.ends_with('\r')) line.remove_suffix(1);
        rest.remove_prefix(length + 1);
        return true;
    }

    bool take(std::span<std::uint8_t> bytes) {
        if (rest.size() < bytes.size()) return false;
        std::copy_n(rest.begin(), bytes.size(), bytes.begin());
        rest.remove_prefix(bytes.size());
        return true;
    }
};

bool parse_size(std::string_view text, std::uint64_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value > 0;
}

/// "-Y 512 +X 1024": the scan lines, then the pixels of each, of which axis, and whether it grows
/// (+) or falls (-). Y grows upwards, X to the right. Empty on success, else what is wrong.
std::string parse_resolution(std::string_view line, Header& header) {
    const std::string fault = "has the size line '" + std::string(line.substr(0, 60)) +
                              "', expected '-Y height +X width', or X before Y, or another sign";
    const std::size_t space = line.find(' ', 3);
    if (space == std::string_view::npos) return fault;
    const std::string_view outer = line.substr(0, 3), inner = line.substr(space, 4);
    const auto is_axis = [](std::string_view text, char axis) {
        return text == std::string{'+', axis, ' '} || text == std::string{'-', axis, ' '};
    };
    header.is_column_wise = is_axis(outer, 'X');
    const char across = header.is_column_wise ? 'Y' : 'X';
    std::uint64_t lines = 0, pixels = 0;
    if ((!header.is_column_wise && !is_axis(outer, 'Y')) || inner.empty() ||
        !is_axis(inner.substr(1), across) || !parse_size(line.substr(3, space - 3), lines) ||
        !parse_size(line.substr(space + 4), pixels)) {
        return fault;
    }
    const char outer_sign = outer[0], inner_sign = inner[1];
    header.is_mirrored = (header.is_column_wise ? outer_sign : inner_sign) == '-';
    header.is_upside_down = (header.is_column_wise ? inner_sign : outer_sign) == '+';
    header.width = header.is_column_wise ? lines : pixels;
    header.height = header.is_column_wise ? pixels : lines;
    return {};
}

std::string parse_header(Input& in, Header& header) {
    std::string_view line;
    if (!in.take_line(line)) return "is cut off within its header";
    while (in.take_line(line)) {
        if (line.empty()) {
            if (!in.take_line(line)) break;
            return parse_resolution(line, header);
        }
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
            return "has the format '" + std::string(line.substr(7, 60)) +
                   "', expected 32-bit_rle_rgbe";
        }
        if (line.starts_with("EXPOSURE=")) {
            std::string_view text = line.substr(9);
            text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
            double value = 0;
            std::from_chars(text.data(), text.data() + text.size(), value);
            header.exposure *= value;
            if (!(header.exposure > 1e-12 && header.exposure < 1e12)) {
                return "has an EXPOSURE that is not a positive number";
            }
        }
        if (line.starts_with("COLORCORR=") || line.starts_with("PRIMARIES=")) {
            header.ignored.emplace_back(line.substr(0, 9));
        }
    }
    return "is cut off within its header";
}

/// New run-length encoding: the four components one after the other, runs of up to 127.
bool read_component(Input& in, std::size_t component, std::span<Rgbe> row) {
    for (std::size_t x = 0; x < row.size();) {
        std::array<std::uint8_t, 1> code{}, value{};
        if (!in.take(code)) return false;
        const bool is_run = code[0] > 128;
        const std::size_t count = is_run ? code[0] - 128u : code[0];
        if (count == 0 || count > row.size() - x) return false;
        for (std::size_t i = 0; i < count; ++i) {
            if ((!is_run || i == 0) && !in.take(value)) return false;
            row[x++][component] = value[0];
        }
    }
    return true;
}

/// Flat pixels, and the old run-length encoding in which (1, 1, 1, n) repeats the previous pixel
/// n times, n shifted by 8 bits for each marker that follows another.
bool read_old_row(Input& in, Rgbe first, std::span<Rgbe> row) {
    int shift = 0;
    Rgbe pixel = first;
    for (std::size_t x = 0; x < row.size();) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            if (x == 0 || shift > 16) return false;
            const std::size_t count = std::size_t{pixel[3]} << shift;
            if (count > row.size() - x) return false;
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
            x += count;
            shift += 8;
        } else {
            row[x++] = pixel;
            shift = 0;
        }
        if (x < row.size() && !in.take(pixel)) return false;
    }
    return true;
}

bool read_row(Input& in, std::span<Rgbe> row) {
    Rgbe first{};
    if (!in.take(first)) return false;
    const bool is_new =
        row.size() >= 8 && row.size() < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!is_new) return read_old_row(in, first, row);
    if ((std::size_t{first[2]} << 8 | first[3]) != row.size()) return false;
    for (std::size_t component = 0; component < 4; ++component) {
        if (!read_component(in, component, row)) return false;
    }
    return true;
}

Rgb decode_pixel(Rgbe code, double scale) {
    if (code[3] == 0) return {};
    const double step = std::ldexp(scale, int{code[3]} - 136);
    const auto value = [&](std::uint8_t mantissa) {
        return static_cast<float>(std::min<double>(mantissa * step, kLargest));
    };
    return {value(code[0]), value(code[1]), value(code[2])};
}

}  // namespace

Result<HdrImage> decode_hdr(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&](const std::string& what, const std::string& remedy) -> Error {
        return make_error(ErrorKind::bad_input, name, "", what, remedy);
    };
    if (image_kind(bytes) != ImageKind::hdr) {
        return fail("is not a Radiance picture, whatever its name says", "give an .hdr image");
    }
    Input in{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
    Header header;
    if (const std::string fault = parse_header(in, header); !fault.empty()) {
        return fail(fault, "save it as an RGBE picture");
    }
    if (!is_plausible_size(header.width, header.height, bytes.size())) {
        return fail("claims " + std::to_string(header.width) + " x " +
                        std::to_string(header.height) + " pixels in " +
                        std::to_string(bytes.size()) + " bytes",
                    "at most 16384 x 8192 pixels, and a file that is not cut off");
    }
    try {
        HdrImage result;
        result.image.width = static_cast<std::uint32_t>(header.width);
        result.image.height = static_cast<std::uint32_t>(header.height);
        result.image.pixel.resize(header.width * header.height);
        const std::uint64_t lines = header.is_column_wise ? header.width : header.height;
        std::vector<Rgbe> scan(header.is_column_wise ? header.height : header.width);
        for (std::uint64_t i = 0; i < lines; ++i) {
            if (!read_row(in, scan)) {
                return fail("is cut off or damaged in scan line " + std::to_string(i) + " of " +
                                std::to_string(lines),
                            "export it again");
            }
            for (std::uint64_t k = 0; k < scan.size(); ++k) {
                std::uint64_t x = header.is_column_wise ? i : k, y = header.is_column_wise ? k : i;
                if (header.is_mirrored) x = header.width - 1 - x;
                if (header.is_upside_down) y = header.height - 1 - y;
                result.image.pixel[y * header.width + x] =
                    decode_pixel(scan[k], 1.0 / header.exposure);
            }
        }
        if (header.exposure != 1.0) {
            result.warnings.push_back(
                make_warning(name, "", "values are divided by the EXPOSURE of its header"));
        }
        for (const std::string& line : header.ignored) {
            result.warnings.push_back(make_warning(name, "", "its " + line + " line is ignored"));
        }
        return result;
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, name, "", "does not fit in memory",
                          "use a smaller image");
    }
}

}  // namespace opaline::formats
