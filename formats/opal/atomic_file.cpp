#include "formats/opal/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace opaline::formats {
namespace {

Error io_error(const std::filesystem::path& path, const std::string& what, int code) {
    const char* remedy =
        code == ENOSPC || code == EDQUOT ? "free some space, or write to another disk"
        : code == EACCES || code == EPERM || code == EROFS ? "choose a folder you may write to"
        : code == ENOENT                                   ? "create the folder first"
                                                           : "check the output path";
    return make_error(ErrorKind::resource, path.string(), "", what + ": " + std::strerror(code),
                      remedy);
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& target) {
    AtomicFile file;
    file.target_ = target;
    struct stat info {};
    const bool exists = ::stat(target.c_str(), &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        return make_error(ErrorKind::resource, target.string(), "", "is a folder",
                          "give a file name inside it");
    }
    if (exists && !S_ISREG(info.st_mode)) {
        file.descriptor_ = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (file.descriptor_ < 0) {
            return io_error(target, "cannot write", errno);
        }
        return file;
    }
    const std::filesystem::path folder =
        target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
    file.temporary_ = (folder / ("." + target.filename().string() + ".XXXXXX")).string();
    file.descriptor_ = ::mkostemp(file.temporary_.data(), O_CLOEXEC);
    if (file.descriptor_ < 0) {
        file.temporary_.clear();
        return io_error(target, "cannot create", errno);
    }
    // mkostemp makes the file private; give it the permissions that an ordinary new file gets.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(file.descriptor_, exists ? info.st_mode & 0777 : 0666 & ~mask);
    return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this != &other) {
        discard();
        target_ = std::move(other.target_);
        temporary_ = std::exchange(other.temporary_, {});
        descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::discard() noexcept {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        temporary_.clear();
    }
}

Status AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return io_error(target_, "cannot write", errno);
        }
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return ok_status();
}

Status AtomicFile::write(std::string_view text) {
    return write(std::as_bytes(std::span(text.data(), text.size())));
}

Status AtomicFile::commit() {
    // A pipe or terminal cannot be synced; what was written to it is out already.
    if (!temporary_.empty() && ::fsync(descriptor_) != 0) {
        return io_error(target_, "cannot write", errno);
    }
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        return io_error(target_, "cannot write", errno);
    }
    if (!temporary_.empty()) {
        if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
            return io_error(target_, "cannot rename the finished file", errno);
        }
        temporary_.clear();
    }
    return ok_status();
}

Status write_file_atomically(const std::filesystem::path& target, std::string_view bytes) {
    Result<AtomicFile> file = AtomicFile::create(target);
    if (!file) {
        return std::move(file).error();
    }
    if (Status status = file->write(bytes); !status) {
        return status;
    }
    return file->commit();
}

}  // namespace opaline::formats
