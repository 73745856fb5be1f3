#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "formats/opal/emitters.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "runtime/emitter_light.h"

namespace opaline::cli {

/// `--emitter NAME=R,G,B`, or NAME=V for a grey factor; may be given often.
void add_emitter_option(CLI::App& command, std::vector<std::string>& texts);

/// A factor for each emitter of a file: 1 where none is given, the last one where several are.
/// Errors: usage, for a name that the file does not have, and for factors that are not finite or
/// below 0.
formats::Result<std::vector<formats::Rgb>> parse_emitters(const formats::EmittersView& emitters,
                                                          const std::vector<std::string>& texts);

}  // namespace opaline::cli
