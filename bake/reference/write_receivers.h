#pragma once

#include <filesystem>
#include <span>

#include "bake/reference/estimate.h"
#include "bake/reference/path.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Writes `primitive,vertex,r,g,b,se_r,se_g,se_b`, one line per receiver: mean radiance
/// [W m^-2 sr^-1] and its standard error. `opaline compare` reads it as a relight table.
/// Errors: resource.
formats::Status write_receiver_csv(const std::filesystem::path& path,
                                   std::span<const ReferenceReceiver> receivers,
                                   const Estimate& estimate);

}  // namespace opaline::bake
