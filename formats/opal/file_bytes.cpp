#include "formats/opal/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

namespace opaline::formats {
namespace {

constexpr std::align_val_t kAlignment{64};

// Closed with its scope.
struct Descriptor {
    // Without O_NONBLOCK a pipe would wait for a writer.
    explicit Descriptor(const std::filesystem::path& path)
        : number(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
    int number;
};

// Bytes read, fewer than asked for at the end of the file; -1 on an error (errno).
ssize_t read_all(int descriptor, std::byte* out, std::size_t size) {
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
    std::size_t done = 0;
    while (done < size) {
        const ssize_t count = ::read(descriptor, out + done, std::min(size - done, kMostAtOnce));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return -1;
        if (count == 0) break;
        done += static_cast<std::size_t>(count);
    }
    return static_cast<ssize_t>(done);
}

}  // namespace

void FileBytes::Delete::operator()(std::byte* data) const {
    ::operator delete(data, kAlignment);
}

Result<FileBytes> FileBytes::open(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& what) -> Error {
        return make_error(ErrorKind::bad_input, path.string(), "",
                          what + ": " + std::strerror(errno), "check the path and its permissions");
    };
    const Descriptor descriptor(path);
    if (descriptor.number < 0) return fail("cannot open");
    struct stat info {};
    if (::fstat(descriptor.number, &info) != 0 || !S_ISREG(info.st_mode)) {
        return make_error(ErrorKind::bad_input, path.string(), "", "is not a regular file",
                          "give the path of a file");
    }
    FileBytes file;
    file.size_ = static_cast<std::size_t>(info.st_size);
    if (file.size_ == 0) return file;
    file.data_.reset(static_cast<std::byte*>(::operator new(file.size_, kAlignment, std::nothrow)));
    if (file.data_ == nullptr) {
        return make_error(ErrorKind::resource, path.string(), "",
                          "no memory for its " + std::to_string(file.size_) + " bytes",
                          "free some memory");
    }
    const ssize_t count = read_all(descriptor.number, file.data_.get(), file.size_);
    if (count < 0) return fail("cannot read");
    if (static_cast<std::size_t>(count) != file.size_) {
        return make_error(ErrorKind::bad_input, path.string(), "",
                          "became shorter while it was read", "try again");
    }
    return file;
}

}  // namespace opaline::formats
