#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "bake/accuracy/sweep/analysis.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// JSON text that is safe inside a <script> element: no tag can begin or end in it, whatever names
/// the scene has.
std::string json_for_html(const nlohmann::ordered_json& json);

/// RFC 4648, with padding.
std::string encode_base64(std::string_view bytes);

/// The whole page: template, style, script, plotting library, data (`json`: make_sweep_json) and
/// pictures in one text that needs no network. Errors: resource (a picture cannot be encoded).
formats::Result<std::string> make_report_page(const SweepResult& result,
                                              const SweepAnalysis& analysis,
                                              const nlohmann::ordered_json& json);

}  // namespace opaline::bake
