#include "bake/cli/machine_rates.h"

#include "bake/calibration/calibration.h"
#include "bake/calibration/rates_cache.h"
#include "bake/cli/messages.h"
#include "bake/effects/effects.h"

namespace opaline::cli {

MachineRates find_machine_rates() {
    const std::filesystem::path path = bake::rates_path();
    const bake::MachineKey machine = bake::this_machine();
    if (const auto known = bake::read_rates(path, machine)) {
        return {*known, "read from " + path.string()};
    }
    print_note("opaline: measuring this machine once, takes about 10 s");
    const bake::Rates rates = bake::measure_rates(bake::all_effects(), machine.threads);
    if (path.empty()) {
        return {rates, "measured; neither XDG_CACHE_HOME nor HOME says where to keep it"};
    }
    const bool kept = bake::write_rates(path, machine, rates).has_value();
    return {rates, (kept ? "measured, kept in " : "measured; cannot be kept in ") + path.string()};
}

}  // namespace opaline::cli
