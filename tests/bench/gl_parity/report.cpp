#include "tests/bench/gl_parity/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace opaline::parity {
namespace {

// Steps are rare; a function that is wrong everywhere must not pass for them.
constexpr std::size_t kOneIn = 50;

}  // namespace

void Report::compare(Kind kind, double difference, std::string_view of, std::size_t number,
                     double tolerance) {
    if (!std::isfinite(difference)) difference = std::numeric_limits<double>::infinity();
    Largest& largest = kinds_[static_cast<std::size_t>(kind)];
    ++largest.count;
    largest.beyond += difference > tolerance ? 1u : 0u;
    largest.difference = std::max(largest.difference, difference);
    if (difference / tolerance <= largest.excess) return;
    largest.excess = difference / tolerance;
    largest.found = difference;
    largest.tolerance = tolerance;
    largest.of = of;
    largest.number = number;
}

void Report::compare_step(Kind kind, double difference, std::string_view of, std::size_t number) {
    Largest& largest = kinds_[static_cast<std::size_t>(kind)];
    ++largest.count;
    ++largest.steps;
    if (difference <= largest.step) return;
    largest.step = difference;
    largest.of_step = std::string(of) + " " + std::to_string(number);
}

bool Report::holds() const {
    return std::ranges::none_of(
        kinds_, [](const Largest& l) { return l.beyond > 0 || kOneIn * l.steps > l.count; });
}

std::string Report::text(const std::string& file, const std::string& context) const {
    std::ostringstream text;
    text.precision(2);
    text << "| " << file << " | " << context << " |";
    for (const Largest& largest : kinds_) {
        if (largest.count == 0) {
            text << " |";
        } else {
            text << " " << largest.difference << " |";
        }
    }
    text << "\n";
    for (std::size_t k = 0; k < kKinds; ++k) {
        const Largest& largest = kinds_[k];
        if (largest.steps > 0) {
            text << "STEPS: " << file << ", " << context << ", " << kKindNames[k] << ": "
                 << largest.steps << " of " << largest.count << " values, up to " << largest.step
                 << " at " << largest.of_step
                 << ", where the CPU's own change as much if rounding moves the eye"
                 << (kOneIn * largest.steps > largest.count ? ": TOO MANY" : "") << "\n";
        }
        if (largest.beyond == 0) continue;
        text << "BEYOND TOLERANCE: " << file << ", " << context << ", " << kKindNames[k] << ": "
             << largest.of << " " << largest.number << " is off by " << largest.found
             << ", tolerated are " << largest.tolerance << "; " << largest.beyond << " of "
             << largest.count << " values are beyond\n";
    }
    for (const std::string& note : notes_)
        text << "NOT COMPARED: " << file << ", " << context << ": " << note << "\n";
    return text.str();
}

}  // namespace opaline::parity
