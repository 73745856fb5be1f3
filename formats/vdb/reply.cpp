#include "formats/vdb/reply.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include "formats/vdb/limits.h"

namespace opaline::formats::vdb {
namespace {

/// What the grids of a reply may still have together.
struct Budget {
    std::uint64_t bricks = kMaxBricks, table = kMaxTableBricks;
};

template <class T>
bool read_value(const ByteSource& source, T& value) {
    return source(std::as_writable_bytes(std::span(&value, 1)));
}

std::optional<std::string> read_text(const ByteSource& source, std::size_t longest) {
    std::uint32_t size = 0;
    if (!read_value(source, size) || size > longest) return {};
    std::string text(size, '\0');
    if (!source(std::as_writable_bytes(std::span(text)))) return {};
    return text;
}

std::optional<Fault> read_fault(const ByteSource& source) {
    std::optional<std::string> text[3];
    for (auto& part : text) {
        part = read_text(source, kMaxTextBytes);
        if (!part) return {};
    }
    return Fault{*text[0], *text[1], *text[2]};
}

std::optional<std::vector<std::string>> read_names(const ByteSource& source) {
    std::uint32_t count = 0;
    if (!read_value(source, count) || count > kMaxGrids) return {};
    std::vector<std::string> names;
    while (names.size() < count) {
        std::optional<std::string> name = read_text(source, kMaxTextBytes);
        if (!name) return {};
        names.push_back(std::move(*name));
    }
    return names;
}

// Whether the table is not larger than what is left, and lies where index coordinates are exact.
bool is_allowed(const GridHead& head, Budget& budget) {
    std::uint64_t places = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t first = head.first_brick[axis], extent = head.extent[axis];
        if (extent < 1 || first * 8 < -kMaxIndex || (first + extent) * 8 > kMaxIndex) return false;
        places *= static_cast<std::uint64_t>(extent);
        if (places > budget.table) return false;
    }
    if (head.bricks < 1 || head.bricks > std::min(places, budget.bricks)) return false;
    budget.table -= places;
    budget.bricks -= head.bricks;
    return true;
}

bool is_valid(float value) {
    return std::isfinite(value) && value >= 0;
}
bool is_valid(const glm::vec3& value) {
    return is_valid(value.x) && is_valid(value.y) && is_valid(value.z);
}

template <class T>
bool is_usable(std::span<const T> values) {
    return std::all_of(values.begin(), values.end(), [](const T& v) { return is_valid(v); }) &&
           std::any_of(values.begin(), values.end(), [](const T& v) { return v != T(0); });
}

template <class T>
bool read_bricks(const ByteSource& source, const GridHead& head, SparseGrid<T>& grid) {
    constexpr std::size_t kVoxels = SparseGrid<T>::kBrickVoxels;
    static_assert(sizeof(T) % sizeof(float) == 0 && std::is_trivially_copyable_v<T>);
    grid.first_brick = {head.first_brick[0], head.first_brick[1], head.first_brick[2]};
    grid.extent = {head.extent[0], head.extent[1], head.extent[2]};
    for (int i = 0; i < 16; ++i) {
        grid.to_scene[i / 4][i % 4] = head.to_scene[i];
    }
    if (!is_invertible_affine(grid.to_scene)) return false;
    grid.table.assign(static_cast<std::size_t>(head.extent[0]) *
                          static_cast<std::size_t>(head.extent[1]) *
                          static_cast<std::size_t>(head.extent[2]),
                      SparseGrid<T>::kEmpty);
    // Address space at once, memory as bricks come.
    grid.value.reserve(head.bricks * kVoxels);
    std::uint32_t least_place = 0;
    for (std::uint32_t brick = 0; brick < head.bricks; ++brick) {
        std::uint32_t place = 0;
        if (!read_value(source, place) || place < least_place || place >= grid.table.size()) {
            return false;
        }
        grid.table[place] = brick;
        least_place = place + 1;
        grid.value.resize(grid.value.size() + kVoxels);
        const std::span<T> values = std::span(grid.value).last(kVoxels);
        if (!source(std::as_writable_bytes(values)) || !is_usable<T>(values)) return false;
    }
    return true;
}

std::optional<VdbGrid> read_grid(const ByteSource& source, Budget& budget) {
    VdbGrid grid;
    std::optional<std::string> name = read_text(source, kMaxNameBytes);
    GridHead head;
    if (!name || !read_value(source, head) || head.is_color > 1 || !is_allowed(head, budget)) {
        return {};
    }
    grid.name = std::move(*name);
    grid.is_color = head.is_color == 1;
    grid.active_voxels = head.active_voxels;
    grid.not_a_number = head.not_a_number;
    grid.negative = head.negative;
    const bool is_read = grid.is_color ? read_bricks(source, head, grid.color)
                                       : read_bricks(source, head, grid.scalar);
    if (!is_read) return {};
    return grid;
}

}  // namespace

ReplyWriter::ReplyWriter(int descriptor) : descriptor_(descriptor) {
    append_number(kReplyMagic);
}

void ReplyWriter::write_grid(std::string_view name, const GridHead& head) {
    append_number(static_cast<std::uint32_t>(ReplyTag::grid));
    append_text(name);
    append(std::as_bytes(std::span(&head, 1)));
}

void ReplyWriter::write_brick(std::uint32_t place, std::span<const float> values) {
    append_number(place);
    append(std::as_bytes(values));
}

void ReplyWriter::write_fault(const Fault& fault) {
    append_number(static_cast<std::uint32_t>(ReplyTag::fault));
    append_text(fault.where);
    append_text(fault.fault);
    append_text(fault.remedy);
    flush();
}

void ReplyWriter::write_end(std::span<const std::string> unread) {
    unread = unread.first(std::min(unread.size(), kMaxGrids));
    append_number(static_cast<std::uint32_t>(ReplyTag::end));
    append_number(static_cast<std::uint32_t>(unread.size()));
    for (const std::string& name : unread) {
        append_text(name);
    }
    flush();
}

void ReplyWriter::append(std::span<const std::byte> bytes) {
    constexpr std::size_t kEnough = 256u << 10;
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    if (buffer_.size() >= kEnough) {
        flush();
    }
}

void ReplyWriter::append_number(std::uint32_t number) {
    append(std::as_bytes(std::span(&number, 1)));
}

void ReplyWriter::append_text(std::string_view text) {
    text = text.substr(0, kMaxTextBytes);
    append_number(static_cast<std::uint32_t>(text.size()));
    append(std::as_bytes(std::span(text.data(), text.size())));
}

void ReplyWriter::flush() {
    std::span<const std::byte> rest = buffer_;
    while (!rest.empty()) {
        const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            ::_exit(1);
        }
        rest = rest.subspan(static_cast<std::size_t>(written));
    }
    buffer_.clear();
}

std::optional<Reply> parse_reply(const ByteSource& source) {
    Budget budget;
    Reply reply;
    std::uint32_t magic = 0, tag = 0;
    if (!read_value(source, magic) || magic != kReplyMagic) return {};
    while (read_value(source, tag)) {
        if (tag == static_cast<std::uint32_t>(ReplyTag::fault)) {
            reply.fault = read_fault(source);
            reply.grids.clear();
            if (!reply.fault) return {};
            return reply;
        }
        if (tag == static_cast<std::uint32_t>(ReplyTag::end)) {
            auto unread = read_names(source);
            if (reply.grids.empty() || !unread) return {};
            reply.unread = std::move(*unread);
            return reply;
        }
        if (tag != static_cast<std::uint32_t>(ReplyTag::grid) || reply.grids.size() == kMaxGrids) {
            return {};
        }
        std::optional<VdbGrid> grid = read_grid(source, budget);
        if (!grid) return {};
        reply.grids.push_back(std::move(*grid));
    }
    return {};
}

}  // namespace opaline::formats::vdb
