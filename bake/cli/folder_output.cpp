#include "bake/cli/folder_output.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "formats/opal/atomic_file.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Status;

Status refuse_write(const std::filesystem::path& folder, const char* doing) {
    return make_error(ErrorKind::resource, folder.string(), "",
                      std::string("cannot ") + doing + ": " + std::strerror(errno),
                      "choose a folder you may write to");
}

// Removes the folder unless it has become the output.
class TemporaryOutput {
  public:
    explicit TemporaryOutput(const std::filesystem::path& parent)
        : path_((parent / ".opaline-XXXXXX").string()) {
        if (::mkdtemp(path_.data()) == nullptr) path_.clear();
    }
    TemporaryOutput(const TemporaryOutput&) = delete;
    TemporaryOutput& operator=(const TemporaryOutput&) = delete;
    ~TemporaryOutput() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }

    const std::string& path() const { return path_; }  ///< empty: it could not be made
    void keep() { path_.clear(); }

  private:
    std::string path_;
};

// As a folder that mkdir makes.
void set_usual_mode(const std::string& folder) {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::chmod(folder.c_str(), 0777 & ~mask);
}

void sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

// Puts the folder `fresh` in the place of `target`; what stood there has then the name `fresh`.
bool put_in_place(const std::string& fresh, const std::string& target) {
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
        return true;
    }
    if (errno != EINVAL && errno != ENOSYS) return false;
    const std::string old = fresh + "-old";
    if (::rename(target.c_str(), old.c_str()) != 0) return false;
    if (::rename(fresh.c_str(), target.c_str()) != 0) {
        const int reason = errno;
        ::rename(old.c_str(), target.c_str());
        errno = reason;
        return false;
    }
    return ::rename(old.c_str(), fresh.c_str()) == 0;
}

}  // namespace

Status check_folder(const std::filesystem::path& folder,
                    const std::function<bool(std::string_view)>& is_ours) {
    std::error_code error;
    const auto status = std::filesystem::status(folder, error);
    if (!std::filesystem::exists(status)) return formats::ok_status();
    if (!std::filesystem::is_directory(status)) {
        return make_error(ErrorKind::usage, folder.string(), "", "is a file, not a folder",
                          "choose another output");
    }
    std::filesystem::directory_iterator entries(folder, error);
    for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
        const std::string name = entries->path().filename().string();
        if (entries->is_regular_file(error) && is_ours(name)) continue;
        return make_error(ErrorKind::usage, folder.string(), "",
                          "holds '" + name + "', and would be replaced as a whole",
                          "choose a folder that is new, empty, or an earlier output");
    }
    if (error) {
        return make_error(ErrorKind::resource, folder.string(), "",
                          "cannot be read: " + error.message(), "choose another output");
    }
    return formats::ok_status();
}

Status write_folder(const std::filesystem::path& folder, std::span<const FolderFile> files) {
    std::filesystem::path target = formats::resolve_links(folder);
    if (!target.has_filename()) target = target.parent_path();  // DIR/
    std::error_code error;
    std::filesystem::create_directories(target.parent_path(), error);
    TemporaryOutput fresh(target.parent_path());
    if (fresh.path().empty()) return refuse_write(folder, "make it");
    for (const FolderFile& file : files) {
        auto written = formats::write_file_atomically(
            std::filesystem::path(fresh.path()) / file.name, file.text);
        if (!written) return written;
    }
    set_usual_mode(fresh.path());
    sync_folder(fresh.path());
    if (std::filesystem::exists(target, error)) {
        if (!put_in_place(fresh.path(), target.string())) return refuse_write(folder, "replace it");
    } else {
        if (::rename(fresh.path().c_str(), target.c_str()) != 0) {
            return refuse_write(folder, "name it");
        }
        fresh.keep();
    }
    sync_folder(target.parent_path());
    return formats::ok_status();
}

}  // namespace opaline::cli
