#include "formats/opal/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <system_error>
#include <utility>

namespace opaline::formats {
namespace {

constexpr std::string_view kPrefix = ".opaline-", kPattern = "XXXXXX";

Error io_error(const std::filesystem::path& path, const std::string& what, int code) {
    const char* remedy =
        code == ENOSPC || code == EDQUOT ? "free some space, or write to another disk"
        : code == EACCES || code == EPERM || code == EROFS ? "choose a folder you may write to"
        : code == EFBIG  ? "raise the limit of file sizes (ulimit -f)"
        : code == ENOENT ? "create the folder first"
                         : "check the output path";
    return make_error(ErrorKind::resource, path.string(), "", what + ": " + std::strerror(code),
                      remedy);
}

// What /dev/stdout leads to must keep its inode: whoever opened it reads that one.
bool names_a_descriptor(const std::filesystem::path& path) {
    const std::string text = path.lexically_normal().string();
    return text == "/dev/stdout" || text == "/dev/stderr" || text.starts_with("/dev/fd/") ||
           text.starts_with("/proc/");
}

std::string path_of_descriptor(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

// -1 where the file system or the kernel has none, or nothing could give it a name later.
int open_unnamed(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0 && ::access(path_of_descriptor(descriptor).c_str(), F_OK) != 0) {
        ::close(descriptor);
        return -1;
    }
    return descriptor;
}

bool is_abandoned(const std::filesystem::path& path) {
    constexpr std::time_t kLongEnough = 60;  // s; younger ones may not be locked yet
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return false;
    struct stat info {};
    const bool is_old = ::fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) &&
                        std::time(nullptr) - info.st_mtime > kLongEnough;
    const bool is_ours = is_old && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    ::close(descriptor);
    return is_ours;
}

// Temporary files of processes that were killed. Those in use are locked.
void remove_abandoned(const std::filesystem::path& folder) {
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.size() == kPrefix.size() + kPattern.size() && name.starts_with(kPrefix) &&
            is_abandoned(entry->path())) {
            ::unlink(entry->path().c_str());
        }
    }
}

// Locked until it is closed. Empty on failure, errno says why.
std::string create_named(const std::filesystem::path& folder, int& descriptor) {
    remove_abandoned(folder);
    std::string path = (folder / (std::string(kPrefix) + std::string(kPattern))).string();
    descriptor = ::mkostemp(path.data(), O_CLOEXEC);
    if (descriptor < 0) {
        return {};
    }
    ::flock(descriptor, LOCK_EX | LOCK_NB);  // without locks it is only kept longer
    return path;
}

// An unnamed file gets a name; false: errno says why.
bool link_unnamed(int descriptor, const std::string& path) {
    return ::linkat(AT_FDCWD, path_of_descriptor(descriptor).c_str(), AT_FDCWD, path.c_str(),
                    AT_SYMLINK_FOLLOW) == 0;
}

// The same under a name that nothing has yet: empty on failure, errno says why.
std::string link_beside(int descriptor, const std::filesystem::path& folder) {
    remove_abandoned(folder);
    constexpr unsigned kTries = 1000000;
    const auto start = static_cast<unsigned>(::getpid());
    for (unsigned i = 0; i < kTries; ++i) {
        std::string digits = std::to_string((start + i) % kTries);
        digits.insert(0, kPattern.size() - digits.size(), '0');
        std::string path = (folder / (std::string(kPrefix) + digits)).string();
        if (link_unnamed(descriptor, path)) return path;
        if (errno != EEXIST) break;
    }
    return {};
}

}  // namespace

std::filesystem::path resolve_links(const std::filesystem::path& path) {
    constexpr int kMostLinks = 40;  // as Linux
    std::error_code error;
    std::filesystem::path at = std::filesystem::absolute(path, error);
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(at, error); ++i) {
        const std::filesystem::path next = std::filesystem::read_symlink(at, error);
        if (error) break;
        at = at.parent_path() / next;
    }
    const std::filesystem::path resolved = std::filesystem::weakly_canonical(at, error);
    return error ? at : resolved;
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& target, Temporary temporary) {
    AtomicFile file;
    file.target_ = target;
    if (target.empty()) {
        return make_error(ErrorKind::resource, "", "", "the name of an output is empty",
                          "give a file name");
    }
    struct stat info {};
    const bool exists = ::stat(target.c_str(), &info) == 0;
    if (!exists && errno == ENAMETOOLONG) return io_error(target, "cannot create", errno);
    if (exists && S_ISDIR(info.st_mode)) {
        return make_error(ErrorKind::resource, target.string(), "", "is a folder",
                          "give a file name inside it");
    }
    if (exists && (!S_ISREG(info.st_mode) || names_a_descriptor(target))) {
        file.descriptor_ = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (file.descriptor_ < 0) return io_error(target, "cannot write", errno);
        return file;
    }
    file.destination_ = resolve_links(target);
    const std::filesystem::path folder = file.destination_.parent_path();
    file.descriptor_ = temporary == Temporary::unnamed ? open_unnamed(folder) : -1;
    if (file.descriptor_ < 0) {
        file.temporary_ = create_named(folder, file.descriptor_);
        if (file.temporary_.empty()) return io_error(target, "cannot create", errno);
    }
    // The permissions of the file that is replaced, or those that an ordinary new file gets.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(file.descriptor_, exists ? info.st_mode & 0777 : 0666 & ~mask);
    return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      destination_(std::move(other.destination_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      written_(std::exchange(other.written_, 0)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this != &other) {
        discard();
        target_ = std::move(other.target_);
        destination_ = std::move(other.destination_);
        temporary_ = std::exchange(other.temporary_, {});
        descriptor_ = std::exchange(other.descriptor_, -1);
        written_ = std::exchange(other.written_, 0);
    }
    return *this;
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::discard() noexcept {
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        temporary_.clear();
    }
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
}

Status AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return io_error(target_, "cannot write", errno);
        written_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return ok_status();
}

Status AtomicFile::write(std::string_view text) {
    return write(std::as_bytes(std::span(text.data(), text.size())));
}

Status AtomicFile::sync() {
    // A pipe or terminal cannot be synced; what was written to it is out already.
    if (!destination_.empty() && ::fsync(descriptor_) != 0) {
        return io_error(target_, "cannot write", errno);
    }
    return ok_status();
}

Status AtomicFile::publish() {
    if (destination_.empty()) return ok_status();
    if (temporary_.empty()) {
        if (link_unnamed(descriptor_, destination_.string())) return ok_status();
        // A link cannot replace a file: a name beside it, and a rename at once.
        if (errno == EEXIST) {
            temporary_ = link_beside(descriptor_, destination_.parent_path());
        }
        if (temporary_.empty()) return io_error(target_, "cannot name the finished file", errno);
    }
    if (::rename(temporary_.c_str(), destination_.c_str()) != 0) {
        return io_error(target_, "cannot rename the finished file", errno);
    }
    temporary_.clear();
    return ok_status();
}

Status AtomicFile::commit() {
    if (Status status = sync(); !status) return status;
    if (Status status = publish(); !status) return status;
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        return io_error(target_, "cannot write", errno);
    }
    return ok_status();
}

Status write_file_atomically(const std::filesystem::path& target, std::string_view bytes) {
    Result<AtomicFile> file = AtomicFile::create(target);
    if (!file) return std::move(file).error();
    if (Status status = file->write(bytes); !status) return status;
    return file->commit();
}

}  // namespace opaline::formats
