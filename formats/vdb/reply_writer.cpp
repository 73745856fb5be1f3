#include "formats/vdb/reply_writer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "formats/vdb/limits.h"

namespace opaline::formats::vdb {

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
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            ::_exit(1);
        }
        rest = rest.subspan(static_cast<std::size_t>(written));
    }
    buffer_.clear();
}

}  // namespace opaline::formats::vdb
