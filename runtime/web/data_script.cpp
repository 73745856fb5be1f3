#include "runtime/web/data_script.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

#include "formats/opal/half.h"

namespace opaline::runtime {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
    return i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i]) : 0;
}

constexpr std::size_t kBlock = 16;
constexpr unsigned kAllZero = 15;

class BitWriter {
  public:
    void put(std::uint32_t value, unsigned bits) {
        while (bits-- > 0) {
            if (used_ % 8 == 0) bytes_.push_back(std::byte{0});
            bytes_.back() |= static_cast<std::byte>((value >> bits & 1u) << (7 - used_ % 8));
            ++used_;
        }
    }
    std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
    std::size_t used_ = 0;
};

int predict(std::span<const std::uint16_t> values, std::size_t i, std::size_t line) {
    const bool has_left = i % line >= 3, has_above = i >= line;
    const int left = has_left ? values[i - 3] : 0, above = has_above ? values[i - line] : 0;
    if (!has_left || !has_above) return left + above;
    const int corner = values[i - line - 3];
    return std::clamp(left + above - corner, std::min(left, above), std::max(left, above));
}

void put_block(BitWriter& out, std::span<const std::uint32_t, kBlock> block) {
    if (std::all_of(block.begin(), block.end(), [](std::uint32_t v) { return v == 0; })) {
        out.put(kAllZero, 4);
        return;
    }
    unsigned best = 0;
    std::uint64_t fewest = ~std::uint64_t{0};
    for (unsigned k = 0; k < kAllZero; ++k) {
        std::uint64_t bits = kBlock * (1 + k);
        for (const std::uint32_t v : block) {
            bits += v >> k;
        }
        if (bits < fewest) {
            fewest = bits;
            best = k;
        }
    }
    out.put(best, 4);
    for (const std::uint32_t v : block) {
        for (std::uint32_t ones = v >> best; ones > 0; --ones) {
            out.put(1, 1);
        }
        out.put(0, 1);
        out.put(v & ((1u << best) - 1), best);
    }
}

}  // namespace

std::string script_literal(std::string_view text) {
    std::string literal = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&') {
            std::array<char, 8> escaped{};
            std::snprintf(escaped.data(), escaped.size(), "\\u%04x", static_cast<unsigned>(code));
            literal += escaped.data();
        } else {
            literal += c;
        }
    }
    return literal + "\"";
}

std::string base64_of(std::span<const std::byte> bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::uint32_t group =
            byte_at(bytes, i) << 16 | byte_at(bytes, i + 1) << 8 | byte_at(bytes, i + 2);
        text += kDigits[group >> 18];
        text += kDigits[group >> 12 & 63];
        text += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
        text += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
    }
    return text;
}

void DataScript::add(std::string_view name, const char* type, std::span<const std::byte> bytes) {
    add_statement("opaline.put(" + script_literal(owner_) + "," + script_literal(name) + ",\"" +
                  type + "\",\"" + base64_of(bytes) + "\")");
}

void DataScript::put_radiance(const std::string& name, std::span<const formats::Rgb> values,
                              std::uint32_t width, unsigned dropped_bits) {
    constexpr float kMost = 60000;  // below the largest half
    float most = 0;
    for (const formats::Rgb value : values) {
        most = std::max({most, value.r, value.g, value.b});
    }
    const float scale = most > 0 ? most / kMost : 1.0f;
    std::vector<std::uint16_t> halves;
    halves.reserve(3 * values.size());
    for (const formats::Rgb value : values) {
        for (const float band : {value.r, value.g, value.b}) {
            const std::uint32_t half = formats::half_from_float(std::min(band / scale, kMost));
            halves.push_back(
                static_cast<std::uint16_t>((half + (1u << dropped_bits >> 1)) >> dropped_bits));
        }
    }
    const std::vector<std::byte> packed = pack_image(halves, std::max(width, 1u));
    add_statement("opaline.putPacked(" + script_literal(owner_) + "," + script_literal(name) + "," +
                  std::to_string(width) + "," + std::to_string(halves.size()) + "," +
                  std::to_string(dropped_bits) + ",\"" + base64_of(packed) + "\")");
    put(name + ".scale", std::span<const float>(&scale, 1));
}

void DataScript::add_statement(std::string_view statement) {
    text_ += statement;
    text_ += ";\n";
}

std::vector<std::byte> pack_image(std::span<const std::uint16_t> values, std::uint32_t width) {
    BitWriter out;
    std::array<std::uint32_t, kBlock> block{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int left_over = values[i] - predict(values, i, std::size_t{3} * width);
        block[i % kBlock] =
            static_cast<std::uint32_t>(left_over < 0 ? -2 * left_over - 1 : 2 * left_over);
        if (i % kBlock == kBlock - 1 || i + 1 == values.size()) {
            std::fill(block.begin() + static_cast<std::ptrdiff_t>(i % kBlock) + 1, block.end(), 0u);
            put_block(out, block);
        }
    }
    return out.take();
}

}  // namespace opaline::runtime
