#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// An image of three 16-bit numbers a pixel, without loss, in a fraction of its bytes where it is
/// smooth. `unpack` of page/data.js reads it.
///
/// Each number is predicted from those of its band to the left (a), above (b) and left above (c):
/// a + b - c, within the range of a and b, as JPEG-LS does (ITU-T T.87, A.4.2). What is left,
/// folded as 0, -1, 1, -2, ... to 0, 1, 2, 3, ..., stands in blocks of 16, each with four bits k
/// before it: 15 means 16 zeros; otherwise each number is Rice's code of parameter k. The first bit
/// of a byte is its highest. `width` [pixels] > 0.
std::vector<std::byte> pack_image(std::span<const std::uint16_t> values, std::uint32_t width);

/// A script that hands arrays to the page: browsers that open a page from a disk read scripts, but
/// no other files.

/// Text as a literal of JavaScript, which is safe inside HTML too.
std::string script_literal(std::string_view text);

/// As RFC 4648 has it, padded.
std::string base64_of(std::span<const std::byte> bytes);

/// One call `opaline.put(owner, name, type, base64)` after the other; `data.js` answers them.
class DataScript {
  public:
    explicit DataScript(std::string owner) : owner_(std::move(owner)) {}

    /// Numbers: a vector, span or array of them.
    template <std::ranges::contiguous_range Values>
    void put(std::string_view name, const Values& values) {
        add(name, type_name<std::ranges::range_value_t<Values>>(),
            std::as_bytes(std::span(values)));
    }
    /// Records as they stand in the file (formats/README.md), as words of four bytes.
    template <class Record>
    void put_records(std::string_view name, std::span<const Record> records) {
        add(name, "u32", std::as_bytes(records));
    }
    /// An image of values >= 0 as halves, packed (data_script.h), times the number `name.scale`.
    /// Halves lose their last `dropped_bits` bits: they err by 2^(dropped_bits - 12) down to 1e-9
    /// of the brightest. `width` [pixels] > 0 where there are any.
    void put_radiance(const std::string& name, std::span<const formats::Rgb> values,
                      std::uint32_t width, unsigned dropped_bits);
    /// A statement of its own.
    void add_statement(std::string_view statement);

    const std::string& text() const { return text_; }

  private:
    template <class T>
    static constexpr const char* type_name() {
        static_assert(std::is_same_v<T, float> || std::is_integral_v<T>);
        if constexpr (std::is_same_v<T, float>) return "f32";
        constexpr std::array kUnsigned{"u8", "u16", "u32"}, kSigned{"i8", "i16", "i32"};
        return (std::is_signed_v<T> ? kSigned : kUnsigned)[sizeof(T) / 2];
    }
    void add(std::string_view name, const char* type, std::span<const std::byte> bytes);

    std::string owner_, text_;
};

}  // namespace opaline::runtime
