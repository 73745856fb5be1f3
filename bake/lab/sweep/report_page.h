#pragma once

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <string_view>

#include "bake/lab/sweep/analysis.h"
#include "formats/image/image.h"
#include "formats/opal/result.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// The luminance difference of full colour: it covers 98 % of the pixels in which one of `pictures`
/// differs from `truth`, rounded up to 1, 2 or 5 times a power of ten; 1 if none differs. All of
/// one size.
double difference_scale(std::span<const runtime::Picture* const> pictures,
                        const runtime::Picture& truth);

/// Signed difference of luminance over `scale`: white where equal, blue where the picture is
/// darker, vermilion where it is brighter. Two colours of the Okabe-Ito set, distinguishable with
/// any colour vision.
formats::Image8 draw_difference(const runtime::Picture& picture, const runtime::Picture& truth,
                                double scale);

/// JSON text that is safe inside a <script> element: no tag can begin or end in it, whatever names
/// the scene has.
std::string json_for_html(const nlohmann::ordered_json& json);

/// The whole page: template, style, script, plotting library, data (`json`: make_sweep_json) and
/// pictures in one text that needs no network. Errors: resource (a picture cannot be encoded).
formats::Result<std::string> make_report_page(const SweepResult& result,
                                              const SweepAnalysis& analysis,
                                              const nlohmann::ordered_json& json);

/// What the page is made of: the files of page/ and Chart.js, put into the program by embed.cmake.
extern const std::string_view kPageTemplate, kPageStyle, kPointsScript, kChartsScript, kPageScript,
    kChartLibrary;

}  // namespace opaline::bake
