#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/mie/sphere_scattering.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/physics/phase.h"
#include "tests/stability/naive_forms.h"
#include "tests/stability/stability_table.h"

namespace opaline::tests {
namespace {

/// One parameter of a hard case, and errors along it.
struct ErrorCurve {
    std::string title, axis;
    struct Point {
        double at = 0, naive = 0, ours = 0;
        std::string exact;  ///< a line of exact.tsv
    };
    std::vector<Point> points;  ///< along the axis, which is logarithmic
};

template <class... Numbers>
std::string format_curve(const char* format, Numbers... numbers) {
    char text[400];
    std::snprintf(text, sizeof text, format, numbers...);
    return text;
}

constexpr double kWidth = 230, kHeight = 200, kLeft = 40, kTop = 30;

// Errors from 1e-17 at the bottom to 10, and all beyond, at the top.
double height_of(double error) {
    const double log = std::clamp(std::log10(std::max(error, 1e-17)), -17.0, 1.0);
    return kTop + kHeight * (1 - log) / 18;
}

/// Optical depth, albedo to 1, index to 1, mean cosine to 1, size parameter.
std::vector<ErrorCurve> error_curves() {
    ErrorCurve depth{"share that is scattered", "optical depth", {}};
    for (int power = -16; power <= 4; ++power) {
        const double ell = std::strtod(format_curve("1e%d", power).c_str(), nullptr);
        depth.points.push_back({ell, naive_share(0, ell), bake::scattered_share(0, ell),
                                format_curve("-expm1(-mpf(1e%d))", power)});
    }
    ErrorCurve albedo{"σ_tr of the dipole", "1 − albedo", {}};
    for (int power = -17; power <= -1; ++power) {
        const double a = std::strtod(format_curve("1e%d", power).c_str(), nullptr);
        albedo.points.push_back(
            {a, naive_decay(1, a), bake::make_dipole(bake::DipoleKind::classic, 1, a, 1.3).sigma_tr,
             format_curve("sqrt(3 * mpf(1e%d) * (1 + mpf(1e%d)))", power, power)});
    }
    ErrorCurve eta{"1 − F_ext of a boundary", "η − 1", {}};
    for (int power = -12; power <= 0; ++power) {
        const double x = std::strtod(format_curve("1e%d", power).c_str(), nullptr);
        eta.points.push_back({x, 1 - naive_external(1 + x),
                              1 - bake::fresnel_moments(1 + x).external,
                              format_curve("1 - external(double(1 + 1e%d))", power)});
    }
    ErrorCurve forward{"sin² of a sampled angle, q 1e-6", "1 − g", {}};
    for (const double g : {0.99999, 0.9999, 0.999, 0.99, 0.9, 0.5}) {
        forward.points.push_back(
            {1 - g, naive_square_sine(naive_peak_cosine(g, 1e-6), 1e-6),
             bake::eval_lobe({bake::Lobe::Kind::henyey_greenstein, g}, 1e-6).square_sine_over_q,
             format_curve("(1 - lobe(%g, 1e-6) ** 2) / 1e-6", g)});
    }
    ErrorCurve size{"Q_sca of a sphere, m 1.33", "size parameter", {}};
    for (int power = -8; power <= 4; ++power) {
        const double x = std::strtod(format_curve("1e%d", power).c_str(), nullptr);
        size.points.push_back({x, naive_mie(x, 1.33).q_sca,
                               bake::sphere_efficiencies(x, 1.33).q_sca,
                               format_curve("mie(1e%d, 1.33, 0).sca", power)});
    }
    return {depth, albedo, eta, forward, size};
}

/// errors.svg: a panel a curve, relative errors of the naive form and of ours.
std::string print_error_curves(const std::vector<ErrorCurve>& curves,
                               const std::map<std::string, long double>& exact) {
    const double panel = kWidth + kLeft + 10;
    std::string text = format_curve(
        "<svg xmlns='http://www.w3.org/2000/svg' width='%g' height='%g' font-family='sans-serif' "
        "font-size='11'>\n<rect width='100%%' height='100%%' fill='white'/>\n",
        panel * static_cast<double>(curves.size()), kHeight + kTop + 40);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const ErrorCurve& curve = curves[i];
        const double low = std::log10(curve.points.front().at);
        const double span = std::log10(curve.points.back().at) - low;
        text += format_curve("<g transform='translate(%g 0)'>\n",
                             panel * static_cast<double>(i) + kLeft);
        text += "<text x='0' y='18'>" + curve.title + "</text>\n";
        for (int power = -16; power <= 0; power += 4) {
            const double y = height_of(std::pow(10.0, power));
            text += format_curve(
                "<path d='M0 %.0fh%g' stroke='#ddd'/>"
                "<text x='-4' y='%.0f' text-anchor='end'>1e%d</text>\n",
                y, kWidth, y + 4, power);
        }
        for (const bool last : {false, true}) {
            text += format_curve("<text x='%g' y='%g' text-anchor='%s'>%.0e</text>\n",
                                 last ? kWidth : 0, kTop + kHeight + 14, last ? "end" : "start",
                                 last ? curve.points.back().at : curve.points.front().at);
        }
        text += format_curve("<text x='%g' y='%g' text-anchor='middle'>", kWidth / 2,
                             kTop + kHeight + 30) +
                curve.axis + "</text>\n";
        for (const bool is_naive : {true, false}) {
            text += is_naive ? "<polyline fill='none' stroke='#c33' stroke-width='2' points='"
                             : "<polyline fill='none' stroke='#26c' stroke-width='2' points='";
            for (const ErrorCurve::Point& point : curve.points) {
                const double error =
                    error_of(is_naive ? point.naive : point.ours, exact.at(point.exact));
                text += format_curve("%.0f,%.0f ", kWidth * (std::log10(point.at) - low) / span,
                                     height_of(error));
            }
            text += "'/>\n";
        }
        text += "</g>\n";
    }
    return text + format_curve(
                      "<text x='%g' y='18' fill='#c33'>naive</text>"
                      "<text x='%g' y='18' fill='#26c'>ours</text></svg>\n",
                      kLeft + 150, kLeft + 195);
}

std::string read_text(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(StabilityTable, OursIsWithinItsBoundOfTheExactValueWhereTheNaiveFormIsNot) {
    const auto exact = read_exact_values();
    std::set<std::string> used;
    for (const StabilityField& field : stability_fields()) {
        for (const StabilityRow& row : field.rows) {
            SCOPED_TRACE(field.name + ": " + row.hard_case + ": " + row.inputs);
            const auto found = exact.find(row.exact);
            ASSERT_NE(found, exact.end())
                << "add the line '" << row.exact << "' to exact.tsv and run exact.py";
            EXPECT_LE(error_of(row.ours, found->second), row.bound) << row.ours;
            EXPECT_GE(error_of(row.naive, found->second), row.naive_errs)
                << row.naive << ": the naive form does not fail, and the row goes";
            EXPECT_GT(row.naive_errs, row.bound) << "the naive form would do";
            used.insert(row.exact);
        }
    }
    for (const ErrorCurve& curve : error_curves()) {
        for (const ErrorCurve::Point& point : curve.points) {
            used.insert(point.exact);
        }
    }
    for (const auto& [expression, value] : exact) {
        EXPECT_TRUE(used.contains(expression)) << "no row has " << expression;
    }
}

// Without what rounding alone decides, which another machine's library may do otherwise: results of
// naive forms, and how high the lines of the picture run.
std::string without_noise(const std::string& text) {
    static const std::regex naive("^((\\| [^\n]*?[^\\\\] ){3}\\| )-?[0-9][0-9.e+-]*( \\| [^ |])",
                                  std::regex::multiline);
    static const std::regex points("points='[^']*'");
    return std::regex_replace(std::regex_replace(text, naive, "$1#$3"), points, "");
}

TEST(StabilityTable, TheFilesAreCurrent) {
    const std::string folder = OPALINE_SOURCE_DIR "/tests/stability/";
    for (const auto& [name, text] :
         {std::pair{"TABLE.md", print_table(stability_fields(), read_exact_values())},
          {"errors.svg", print_error_curves(error_curves(), read_exact_values())}}) {
        if (without_noise(read_text(folder + name)) == without_noise(text)) continue;
        std::ofstream(name) << text;
        ADD_FAILURE() << folder << name << " is not current: copy " << name
                      << " from the folder that this test ran in";
    }
}

// Of a cell of README: "NaN" and "∞" are what they say.
double number_of(const std::string& cell) {
    return cell == "∞" ? HUGE_VAL : std::strtod(cell.c_str(), nullptr);
}

bool is_near(double a, double b, double tolerance) {
    return (std::isnan(a) && std::isnan(b)) || a == b || std::abs(a - b) <= tolerance * std::abs(b);
}

// case | textbook's form | ours | exact | ours errs at most
TEST(StabilityTable, TheRowsThatReadmeShowsAreInIt) {
    const auto exact = read_exact_values();
    const auto fields = stability_fields();
    const std::string text = read_text(OPALINE_SOURCE_DIR "/README.md");
    std::istringstream lines(text.substr(text.find("| hard case |")));
    std::string line;
    std::getline(lines, line);
    std::getline(lines, line);
    int shown = 0;
    for (; std::getline(lines, line) && line.starts_with("| "); ++shown) {
        static const std::regex cells(
            "\\| (.*) \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\|");
        std::smatch cell;
        ASSERT_TRUE(std::regex_match(line, cell, cells)) << line;
        const double naive = number_of(cell[2]), ours = number_of(cell[3]),
                     value = number_of(cell[4]), bound = number_of(cell[5]);
        bool is_found = false;
        for (const StabilityField& field : fields) {
            for (const StabilityRow& row : field.rows) {
                is_found =
                    is_found || (row.bound == bound && is_near(row.naive, naive, 0.1) &&
                                 is_near(row.ours, ours, 1e-5) &&
                                 is_near(static_cast<double>(exact.at(row.exact)), value, 1e-5));
            }
        }
        EXPECT_TRUE(is_found) << line;
    }
    EXPECT_EQ(shown, 10);
}

}  // namespace

}  // namespace opaline::tests
