#include "formats/vdb/read_vdb.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "formats/vdb/limits.h"
#include "formats/vdb/reader_process.h"
#include "formats/vdb/reply.h"

namespace opaline::formats {
namespace {

using namespace vdb;

constexpr const char* kDamaged = "it is damaged, or OpenVDB cannot read it";
constexpr const char* kWriteAgain =
    "write it again with the program that made it, or look at it with vdb_print";

// Closed with its scope.
class File {
  public:
    // Without O_NONBLOCK a pipe would wait for a writer.
    explicit File(const std::filesystem::path& path)
        : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

Error bad_file(const std::filesystem::path& path, std::string fault, std::string remedy) {
    return make_error(ErrorKind::bad_input, path.string(), "", std::move(fault), std::move(remedy));
}

// What can be told without OpenVDB.
Status check_file(const std::filesystem::path& path, const File& file) {
    struct stat info {};
    if (file.descriptor() < 0 || ::fstat(file.descriptor(), &info) != 0) {
        return bad_file(path, std::string("cannot open: ") + std::strerror(errno),
                        "check the path and its permissions");
    }
    if (!S_ISREG(info.st_mode)) {
        return bad_file(path, "is not a regular file", "give the path of a file");
    }
    if (info.st_size == 0) return bad_file(path, "is empty", "give the path of an OpenVDB file");
    if (static_cast<std::uint64_t>(info.st_size) > kMaxFileBytes) {
        return bad_file(path, "has more than " + std::to_string(kMaxFileBytes >> 30) + " GiB",
                        "write fewer or coarser grids");
    }
    constexpr std::array<char, 8> kMagic{' ', 'B', 'D', 'V', 0, 0, 0, 0};
    std::array<char, 8> start{};
    ssize_t count = -1;
    do {
        count = ::pread(file.descriptor(), start.data(), start.size(), 0);
    } while (count < 0 && errno == EINTR);
    if (count < 0) {
        return bad_file(path, std::string("cannot read: ") + std::strerror(errno),
                        "check the path and its permissions");
    }
    if (count < static_cast<ssize_t>(start.size()) || start != kMagic) {
        return bad_file(path, "not an OpenVDB file", "give the path of an OpenVDB file (.vdb)");
    }
    return ok_status();
}

Status check_names(const std::filesystem::path& path, std::span<const std::string> names) {
    if (names.size() > kMaxGrids) {
        return make_error(ErrorKind::usage, path.string(), "",
                          std::to_string(names.size()) + " grids are asked for, and at most " +
                              std::to_string(kMaxGrids) + " can be read at once",
                          "name fewer");
    }
    for (const std::string& name : names) {
        if (name.size() > kMaxNameBytes || name.find('\0') != std::string::npos) {
            return bad_file(path,
                            "no grid has a name of more than " + std::to_string(kMaxNameBytes) +
                                " bytes or with a zero byte",
                            "name a grid that the file has");
        }
    }
    return ok_status();
}

// Fit for a message: no control characters, and not long.
std::string shown(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
    if (text.size() > kMaxTextShown) {
        std::size_t end = kMaxTextShown - 3;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) {
            --end;  // not within a character
        }
        text.replace(end, std::string::npos, "...");
    }
    return text;
}

Error reader_error(const std::filesystem::path& path, Ending ending,
                   const VdbReadOptions& options) {
    switch (ending) {
        case Ending::was_interrupted:
            return make_error(ErrorKind::interrupted, path.string(), "", "interrupted");
        case Ending::out_of_cpu:
            return bad_file(path,
                            "takes more than " + std::to_string(options.cpu_seconds) +
                                " s of computing to read, or is damaged",
                            "write fewer or coarser grids");
        case Ending::out_of_time:
            return bad_file(path,
                            "takes more than " + std::to_string(options.wall_seconds) +
                                " s to read, or is damaged",
                            "copy it to a faster disk, or write fewer or coarser grids");
        case Ending::done:
        case Ending::failed:
            break;
    }
    return bad_file(path, kDamaged, kWriteAgain);
}

// Whether these are the grids that were asked for.
bool fit_names(std::span<const VdbGrid> grids, std::span<const std::string> names) {
    return names.empty() || std::equal(grids.begin(), grids.end(), names.begin(), names.end(),
                                       [](const VdbGrid& grid, const std::string& name) {
                                           return grid.name == name;
                                       });
}

}  // namespace

Result<std::vector<VdbGrid>> read_vdb(const std::filesystem::path& file,
                                      std::span<const std::string> names,
                                      const VdbReadOptions& options,
                                      std::vector<std::string>* unread) {
    if (Status status = check_names(file, names); !status) return std::move(status).error();
    const File opened(file);
    if (Status status = check_file(file, opened); !status) return std::move(status).error();
    Result<ReaderProcess> reader = ReaderProcess::start(opened.descriptor(), names, options);
    if (!reader) return std::move(reader).error();
    std::optional<Reply> reply =
        parse_reply([&](std::span<std::byte> out) { return reader->read(out); });
    const bool is_whole = reply.has_value() && reader->is_at_end();
    const Ending ending = reader->finish();
    if (ending != Ending::done || !is_whole) return reader_error(file, ending, options);
    if (reply->fault) {
        return make_error(ErrorKind::bad_input, file.string(), shown(reply->fault->where),
                          shown(reply->fault->fault), shown(reply->fault->remedy));
    }
    if (!fit_names(reply->grids, names)) return reader_error(file, Ending::failed, options);
    if (unread != nullptr) {
        *unread = std::move(reply->unread);
        for (std::string& name : *unread) {
            name = shown(std::move(name));
        }
    }
    return std::move(reply->grids);
}

}  // namespace opaline::formats
