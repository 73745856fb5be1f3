#pragma once

#include "formats/opal/asset.h"
#include "tests/cli/run_program.h"
#include "tests/formats/gltf/asset_builder.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

/// A square over a larger square, in two primitives with different materials: 8 receivers.
AssetBuilder two_squares();

/// A wavy sheet of n x n vertices: a bake that takes a while.
AssetBuilder wavy_sheet(unsigned n);

/// Mean luminance of the pixels of an .exr file.
double mean_of_picture(const std::string& path);

/// A folder with a small scene in it and, on request, its bake.
class SmallScene {
  public:
    SmallScene();
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string scene() const { return path("scene.glb"); }
    /// Bakes once; the path of the .opal file.
    std::string baked();
    /// Writes an asset as a file of this name; its path.
    std::string write(const formats::Asset& asset, const std::string& name) const;
    const std::filesystem::path& folder() const { return folder_.path(); }

  private:
    TemporaryFolder folder_;
};

}  // namespace opaline::tests
