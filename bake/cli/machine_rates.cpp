#include "bake/cli/machine_rates.h"

#include <filesystem>
#include <utility>

#include "bake/calibration/rates_cache.h"

namespace opaline::cli {

MachineRates find_machine_rates() {
    const std::filesystem::path path = bake::rates_path();
    if (auto known = bake::read_rates(path, bake::this_machine())) {
        return {std::move(*known), "learnt from bakes, read from " + path.string()};
    }
    return {{}, "constants: no bake on this machine is known"};
}

void learn_machine_rates(bake::StageRates rates, const bake::CostPrediction& predicted,
                         const bake::StageLog& ran) {
    bake::learn_rates(predicted.stages, ran, rates);
    if (const std::filesystem::path path = bake::rates_path(); !path.empty()) {
        static_cast<void>(bake::write_rates(path, bake::this_machine(), rates));
    }
}

}  // namespace opaline::cli
