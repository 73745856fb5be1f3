#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/opaline.h"

namespace opaline::test {

/// A file loaded as a host does: by opaline.h. Throws as `require`.
class LoadedFile {
  public:
    explicit LoadedFile(const std::filesystem::path& path);
    LoadedFile(const LoadedFile&) = delete;
    LoadedFile& operator=(const LoadedFile&) = delete;
    ~LoadedFile();

    const opaline_asset* asset() const { return asset_; }
    opaline_light* light() const { return light_; }  ///< of this asset, black at first
    std::uint32_t receivers() const { return opaline_asset_receiver_count(asset_); }

    /// What opaline_gl hands out, from the CPU: three floats a receiver.
    std::vector<float> expected(const float* eye) const;

  private:
    opaline_asset* asset_ = nullptr;
    opaline_light* light_ = nullptr;
};

/// Adds to a light a map whose gradient differs between bands, and a sun.
void light_by_gradient(opaline_light* light);

}  // namespace opaline::test
