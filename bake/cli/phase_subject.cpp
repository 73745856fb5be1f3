#include "bake/cli/phase_subject.h"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "bake/cli/messages.h"
#include "bake/physics/mie/angular_table.h"
#include "bake/physics/phase.h"
#include "formats/media/read_phase_table.h"
#include "formats/opal/atomic_file.h"

namespace opaline::cli {
namespace {

using formats::PhaseFunction;

constexpr unsigned kDegrees = 32;
/// Rows of a table: what is left out is within this of the line between its neighbours, relative.
constexpr double kRowTolerance = 2e-3;

PhaseSubject make_droplet_subject(const DropletOptions& options) {
    const auto& given = options.substance.wavelengths;
    const std::vector<double> wavelengths = given.empty() ? std::vector{550 / 1e9} : given;
    const auto weights = weights_of(options.substance, wavelengths.size());
    auto optics = average_droplets(options, wavelengths);
    const bake::DropletOptics droplets =
        optics.size() == 1 ? optics.front() : bake::mix_wavelengths(optics, weights);
    PhaseSubject subject;
    subject.json = {{"type", "mie"},
                    {"wavelength_m", droplets.wavelength},
                    {"index", {droplets.index.real(), droplets.index.imag()}}};
    if (wavelengths.size() > 1) {
        subject.json["wavelengths_m"] = wavelengths;
        subject.json["weights"] = weights;
    }
    subject.json.update(describe_droplets(options.droplets));
    subject.error = describe_error(droplets);
    subject.series = bake::expand_table(droplets.phase, kDegrees);
    const std::vector<double> angles = bake::thin_table(droplets.phase, kRowTolerance).angle;
    for (auto angle = angles.rbegin(); angle != angles.rend(); ++angle) {
        subject.cosines.push_back(std::cos(*angle));
    }
    subject.table_cosines = subject.cosines;
    subject.p = [phase = droplets.phase](double cosine) {
        return bake::eval_table(phase, std::acos(std::clamp(cosine, -1.0, 1.0)));
    };
    return subject;
}

/// Ascending, from -1 to 1, each in single precision and once: the reader of tables keeps no more.
std::vector<double> round_cosines(std::vector<double> cosines) {
    for (double& cosine : cosines) {
        cosine = static_cast<double>(static_cast<float>(cosine));
    }
    cosines.erase(std::unique(cosines.begin(), cosines.end()), cosines.end());
    return cosines;
}

/// Rows that crowd where the function bends. They are chosen among angles in steps of 0.2 % from
/// both ends on, where peaks are.
std::vector<double> choose_cosines(const std::function<double(double)>& p) {
    constexpr double kFirst = 1e-4, kStep = 1.002;  // smaller angles have the rounded cosine 1
    std::vector<double> cosines{-1};
    for (double angle = kFirst; angle < std::numbers::pi / 2; angle *= kStep) {
        cosines.push_back(-std::cos(angle));
    }
    for (std::size_t i = cosines.size(); i-- > 0;) {
        cosines.push_back(-cosines[i]);
    }
    // Below, values would take hundreds of rows and make no difference.
    constexpr double kLeast = 1e-9;
    bake::AngularTable table;
    for (const double cosine : round_cosines(std::move(cosines))) {
        const double value = p(cosine);
        table.angle.push_back(std::acos(-cosine));  // ascending
        table.value.push_back(value < kLeast ? 0 : value);
    }
    std::vector<double> chosen;
    for (const double angle : bake::thin_table(table, kRowTolerance).angle) {
        chosen.push_back(-std::cos(angle));
    }
    return round_cosines(std::move(chosen));
}

}  // namespace

PhaseSubject make_phase_subject(const PhaseChoice& choice) {
    using Type = PhaseType;
    if (choice.type == PhaseType::mie) return make_droplet_subject(choice.droplets);
    if (choice.type == Type::henyey_greenstein) {
        const double g = choice.g;  // not rounded to the single precision of PhaseFunction
        return PhaseSubject{[g](double cosine) { return bake::henyey_greenstein(cosine, g); },
                            bake::expand_henyey_greenstein(g, kDegrees),
                            {{"type", "hg"}, {"g", g}}};
    }
    PhaseFunction phase;
    nlohmann::ordered_json json;
    if (choice.type == Type::gaussian) {
        phase.type = PhaseFunction::Type::gaussian;
        phase.rms_angle = static_cast<float>(choice.rms_angle);
        json = {{"type", "gaussian"}, {"rms_angle", choice.rms_angle}};
    } else if (choice.type == Type::tabulated) {
        phase = require(formats::read_phase_table(choice.table));
        json = {{"type", "table"}, {"file", choice.table}};
    } else if (choice.type == Type::rayleigh) {
        phase.type = PhaseFunction::Type::rayleigh;
        json = {{"type", "rayleigh"}};
    } else {
        phase.type = PhaseFunction::Type::isotropic;
        json = {{"type", "isotropic"}};
    }
    const bake::PhaseDensity density = bake::make_phase_density(phase);
    PhaseSubject subject{[density](double cosine) { return bake::eval_phase(density, cosine); },
                         bake::expand_phase(phase, kDegrees), std::move(json)};
    subject.table_cosines.assign(phase.cosine.begin(), phase.cosine.end());
    return subject;
}

formats::Status write_phase_table(const std::string& path, const PhaseSubject& subject) {
    std::string text = "cosine value\n";
    for (const double cosine : subject.table_cosines.empty()
                                   ? choose_cosines(subject.p)
                                   : round_cosines(subject.table_cosines)) {
        text += fmt::format("{} {}\n", cosine, subject.p(cosine));
    }
    return formats::write_file_atomically(path, text);
}

}  // namespace opaline::cli
