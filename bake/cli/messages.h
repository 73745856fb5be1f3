#pragma once

#include <string>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::cli {

/// "opaline: error: FILE: WHERE: FAULT (REMEDY)"; empty parts are left out.
std::string format_diagnostic(const formats::Diagnostic& diagnostic);

/// Prints everything an error says to stderr; returns its exit code.
int report_error(const formats::Error& error);

/// Prints warnings to stderr.
void print_warnings(const std::vector<formats::Diagnostic>& warnings);

/// "3 minutes", "12.4 s", "0.3 ms"; "1.2 GB", "640 bytes".
std::string format_seconds(double seconds);
std::string format_bytes(double bytes);

}  // namespace opaline::cli
