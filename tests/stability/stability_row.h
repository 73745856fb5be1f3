#pragma once

#include <string>
#include <vector>

namespace opaline::tests {

/// A numerically hard case at one input: what the form that a textbook prints makes of it, and what
/// the program's function does.
struct StabilityRow {
    std::string hard_case;  ///< as README.md and the rooms' tables name it
    std::string inputs;
    std::string naive_form;
    double naive = 0, ours = 0;
    std::string exact;      ///< a line of exact.tsv: an expression, there with its 50 digits
    double bound = 0;       ///< of the error of ours, relative; absolute where the value is 0
    double naive_errs = 0;  ///< the naive form errs by this or more, or is no finite number
};

struct StabilityField {
    std::string name;
    std::vector<StabilityRow> rows;
};

// Computed when called.
StabilityField surface_rows();
StabilityField walk_rows();
StabilityField volume_rows();
StabilityField differential_rows();
StabilityField layer_rows();
StabilityField droplet_rows();
StabilityField mie_rows();
StabilityField exchange_rows();

}  // namespace opaline::tests
