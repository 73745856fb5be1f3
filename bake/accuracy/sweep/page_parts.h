#pragma once

#include <string_view>

namespace opaline::bake {

// What the page is made of: the files of page/ and Chart.js, put into the program by embed.cmake.
extern const std::string_view kPageTemplate, kPageStyle, kPointsScript, kChartsScript, kPageScript,
    kChartLibrary;

}  // namespace opaline::bake
