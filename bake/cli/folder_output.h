#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "formats/opal/result.h"

namespace opaline::cli {

/// A file of a folder that is written.
struct FolderFile {
    std::string name;  ///< without a path
    std::string_view text;
};

/// Refuses a folder that write_folder would not replace: a file of that name, or a folder that
/// holds anything which `is_ours` does not know by its name. Errors: usage.
formats::Status check_folder(const std::filesystem::path& folder,
                             const std::function<bool(std::string_view)>& is_ours);

/// Writes the files to a folder beside it, syncs them, and gives that the folder's name; what stood
/// there before is removed afterwards. Links are followed. On a file system that cannot exchange
/// two folders, none of that name exists for a moment.
/// Errors: resource; nothing has changed then.
formats::Status write_folder(const std::filesystem::path& folder,
                             std::span<const FolderFile> files);

}  // namespace opaline::cli
