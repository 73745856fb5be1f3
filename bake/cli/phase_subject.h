#pragma once

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/cli/droplet_options.h"
#include "bake/physics/phase_series.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// The types of media files, and droplets, which become a table there.
enum class PhaseType { henyey_greenstein, isotropic, rayleigh, gaussian, tabulated, mie };

/// What options name: of the type's own values the others are not read.
struct PhaseChoice {
    PhaseType type = PhaseType::henyey_greenstein;
    double g = std::nan(""), rms_angle = std::nan("");  ///< rms_angle in radians
    std::string table;                                  ///< a file
    DropletOptions droplets;
};

/// The function itself, its series, and the object that names it in a media file (of droplets:
/// their parameters).
struct PhaseSubject {
    std::function<double(double)> p;  ///< of the cosine [1/sr]
    bake::PhaseSeries series;
    nlohmann::ordered_json json;
    /// Rows of its own, ascending from -1 to 1, in print and in --table-output; empty: equal
    /// angles, and rows that are chosen.
    std::vector<double> cosines = {}, table_cosines = {};
    nlohmann::ordered_json error = nullptr;  ///< numerical
};

/// Errors: of the table's reader, of droplets as `average_droplets`.
PhaseSubject make_phase_subject(const PhaseChoice& choice);

/// A table as media files name them (formats/media/README.md), which has the function back within
/// 0.2 %. Errors: as write_file_atomically.
formats::Status write_phase_table(const std::string& path, const PhaseSubject& subject);

}  // namespace opaline::cli
