#include "runtime/web/packed_image.h"

#include <algorithm>
#include <array>
#include <utility>

namespace opaline::runtime {
namespace {

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
