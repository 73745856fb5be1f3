#include "bake/cli/outputs.h"

#include <sys/stat.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "bake/cli/messages.h"
#include "formats/image/exr.h"
#include "formats/image/png.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Status;

// What makes two names one file: the path behind all links, or the inode of a file that exists.
struct Identity {
    std::string path;
    std::pair<dev_t, ino_t> inode;  ///< 0, 0: there is none
};

Identity identify(const std::filesystem::path& path) {
    Identity identity{formats::resolve_links(path).string(), {}};
    struct stat info {};
    if (::stat(path.c_str(), &info) == 0) {
        identity.inode = {info.st_dev, info.st_ino};
        if (!S_ISREG(info.st_mode)) {
            return {};  // devices and pipes take what they get
        }
    }
    return identity;
}

// Names of files, each with what it is for.
class Taken {
  public:
    /// The use of the file, if it has one.
    const std::string* find(const Identity& identity) const {
        const auto path = by_path_.find(identity.path);
        if (path != by_path_.end()) return &path->second;
        const auto inode = by_inode_.find(identity.inode);
        return inode == by_inode_.end() ? nullptr : &inode->second;
    }
    void add(const Identity& identity, const std::string& use) {
        if (!identity.path.empty()) {
            by_path_.emplace(identity.path, use);
        }
        if (identity.inode != std::pair<dev_t, ino_t>{}) {
            by_inode_.emplace(identity.inode, use);
        }
    }

  private:
    std::map<std::string, std::string> by_path_;
    std::map<std::pair<dev_t, ino_t>, std::string> by_inode_;
};

Status check_ending(const OutputFile& output) {
    const auto& endings = output.endings;
    if (endings.empty() || std::ranges::find(endings, ending_of(output.path)) != endings.end()) {
        return formats::ok_status();
    }
    std::string list;
    for (const std::string& ending : endings) {
        list += (list.empty() ? "" : " or ") + ending;
    }
    return make_error(
        ErrorKind::usage, output.path.string(), "",
        "cannot tell the format from the ending '" + output.path.extension().string() + "'",
        "end the name in " + list);
}

}  // namespace

Status check_outputs(std::span<const OutputFile> outputs,
                     std::span<const std::filesystem::path> inputs) {
    Taken taken;
    for (const std::filesystem::path& input : inputs) {
        if (!input.empty()) {
            taken.add(identify(input), "");
        }
    }
    for (const OutputFile& output : outputs) {
        if (auto status = check_ending(output); !status) return status;
        const Identity identity = identify(output.path);
        if (const std::string* use = taken.find(identity); use != nullptr && use->empty()) {
            return make_error(ErrorKind::usage, output.path.string(), "",
                              "is an input and would be overwritten", "choose another output");
        } else if (use != nullptr) {
            return make_error(ErrorKind::usage, output.path.string(), "",
                              *use + " and " + output.option + " name the same file",
                              "give each output a file of its own");
        }
        taken.add(identity, output.option);
    }
    return formats::ok_status();
}

std::vector<formats::AtomicFile> create_outputs(std::span<const OutputFile> outputs) {
    std::vector<formats::AtomicFile> files;
    for (const OutputFile& output : outputs) {
        files.push_back(require(formats::AtomicFile::create(output.path)));
    }
    return files;
}

void commit_outputs(std::span<formats::AtomicFile> files) {
    for (formats::AtomicFile& file : files) {
        require(file.sync());
    }
    for (formats::AtomicFile& file : files) {
        require(file.commit());
    }
}

std::string ending_of(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

formats::Status write_picture(const std::string& path, const runtime::Picture& picture,
                              float exposure, runtime::ToneMap map) {
    if (ending_of(path) == ".exr") {
        const float gain = std::exp2(exposure);
        formats::Image image{picture.width, picture.height, picture.pixel};
        for (formats::Rgb& pixel : image.pixel) {
            pixel = gain * pixel;
        }
        return formats::write_exr(path, image);
    }
    runtime::DisplayPicture display = runtime::tone_map(picture, exposure, map);
    return formats::write_png(path, {display.width, display.height, std::move(display.rgba)});
}

}  // namespace opaline::cli
