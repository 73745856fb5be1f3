#include "bake/pipeline/volume_warnings.h"

#include <algorithm>
#include <string>

#include "bake/accuracy/error_warnings.h"

namespace opaline::bake {
void warn_of_volumes(const Knobs& knobs, const std::optional<VolumeErrorReport>& error,
                     std::vector<formats::Diagnostic>& warnings) {
    if (!error || error->by_light.empty()) {
        return;
    }
    const bool asked = knobs.error_target > 0;
    const double limit = asked ? knobs.error_target : acceptable_error(knobs.quality);
    if ((asked ? error->rms_relative : error->ci95[0]) <= limit) {
        return;
    }
    const auto worst =
        std::ranges::max_element(error->by_light, {}, &VolumeErrorReport::Part::rms_relative);
    warnings.push_back(formats::make_warning(
        "", asked ? "--error" : "self-check",
        "volumes err by " + error_percent(error->rms_relative) +
            " (95 %: " + error_percent(error->ci95[0]) + " to " + error_percent(error->ci95[1]) +
            "), more than the " + error_percent(limit) +
            (asked ? " asked for; finer settings help little" : " that pass unnoticed") +
            "; most under light of the class '" + worst->name + "'",
        asked ? "accept the error, or give --volume-walks, --volume-spacing and "
                "--volume-coefficients"
              : "choose a finer --quality, or more --volume-walks and a smaller "
                "--volume-spacing"));
}

}  // namespace opaline::bake
