#pragma once

#include <nlohmann/json.hpp>

#include "formats/opal/clouds.h"

namespace opaline::cli {

/// What `opaline info` says of the cloud layers of a file, as JSON and on stdout. Precondition:
/// `clouds` passed read_opal's checks.
nlohmann::ordered_json layers_json(const formats::CloudsView& clouds);
void print_layers(const formats::CloudsView& clouds);

}  // namespace opaline::cli
