#include "bake/pipeline/calibration/rates_cache.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "formats/opal/atomic_file.h"

namespace opaline::bake {
namespace {

using Json = nlohmann::ordered_json;

// The processor's name, or an empty name where the system does not report one.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return {};
}

Json key_json(const MachineKey& machine) {
    return {{"processor", machine.processor},
            {"threads", machine.threads},
            {"version", machine.version}};
}

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::filesystem::path absolute_folder(const char* variable) {
    const char* const value = std::getenv(variable);
    const std::filesystem::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

MachineKey this_machine() {
    return {processor_name(), std::max(1u, std::thread::hardware_concurrency()), OPALINE_VERSION};
}

std::filesystem::path cache_folder() {
    std::filesystem::path folder = absolute_folder("XDG_CACHE_HOME");
    if (folder.empty()) {
        folder = absolute_folder("HOME");
        folder = folder.empty() ? folder : folder / ".cache";
    }
    return folder.empty() ? folder : folder / "opaline";
}

std::filesystem::path rates_path() {
    const std::filesystem::path folder = cache_folder();
    return folder.empty() ? folder : folder / "calibration.json";
}

std::optional<StageRates> read_rates(const std::filesystem::path& path, const MachineKey& machine) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    const Json root = Json::parse(file, nullptr, false);
    // Compare with the text as written, because writing changes names that are not UTF-8.
    if (!root.is_object() || !root.contains("machine") || !root.contains("stages") ||
        !root["stages"].is_object() || dump(root["machine"]) != dump(key_json(machine))) {
        return std::nullopt;
    }
    StageRates rates;
    for (const auto& [kind, learnt] : root["stages"].items()) {
        if (!learnt.is_object() || !learnt.contains("factor") || !learnt["factor"].is_number() ||
            !learnt.contains("bakes") || !learnt["bakes"].is_number_unsigned()) {
            return std::nullopt;
        }
        const auto factor = learnt["factor"].get<double>();
        if (!std::isfinite(factor) || !(factor > 0)) return std::nullopt;
        rates.kinds[kind] = {factor, learnt["bakes"].get<std::uint32_t>()};
    }
    return rates;
}

formats::Status write_rates(const std::filesystem::path& path, const MachineKey& machine,
                            const StageRates& rates) {
    Json root;
    root["machine"] = key_json(machine);
    root["stages"] = Json::object();
    for (const auto& [kind, learnt] : rates.kinds) {
        root["stages"][kind] = {{"factor", learnt.factor}, {"bakes", learnt.bakes}};
    }
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) {
        return formats::make_error(formats::ErrorKind::resource, path.parent_path().string(), "",
                                   "cannot be made: " + error.message());
    }
    return formats::write_file_atomically(path, dump(root) + "\n");
}

void learn_rates(std::span<const StageCost> predicted, const StageLog& ran, StageRates& rates) {
    constexpr double kLeastSeconds = 5e-3, kFullSeconds = 0.1, kMostFactor = 20,
                     kLeastWeight = 1.0 / 8;
    struct Sum {
        double work = 0, seconds = 0;
    };
    std::map<std::string, Sum> sums;
    std::vector<StageCost> left(predicted.rbegin(), predicted.rend());
    for (auto stage = ran.rbegin(); stage != ran.rend(); ++stage) {
        const auto found = std::ranges::find(left, stage->name, &StageCost::name);
        if (found != left.end()) {
            Sum& sum = sums[found->kind];
            sum.work += found->work;
            sum.seconds += stage->cpu_seconds;
            left.erase(found);
        }
    }
    for (const auto& [kind, sum] : sums) {
        if (!(sum.work > 0)) continue;
        const double factor = sum.seconds / sum.work;
        if (sum.seconds < kLeastSeconds || !(factor > 1 / kMostFactor && factor < kMostFactor)) {
            continue;
        }
        StageRates::Learnt& learnt = rates.kinds[kind];
        ++learnt.bakes;
        const double weight =
            std::max(1.0 / learnt.bakes, kLeastWeight) * std::min(1.0, sum.seconds / kFullSeconds);
        learnt.factor = std::pow(learnt.factor, 1 - weight) * std::pow(factor, weight);
    }
}

MachineRates find_machine_rates() {
    const std::filesystem::path path = rates_path();
    if (auto known = read_rates(path, this_machine())) {
        return {std::move(*known), "learnt from bakes, read from " + path.string()};
    }
    return {{}, "constants: no bake on this machine is known"};
}

void learn_machine_rates(std::span<const StageCost> predicted, const StageLog& ran,
                         StageRates rates) {
    learn_rates(predicted, ran, rates);
    if (const std::filesystem::path path = rates_path(); !path.empty()) {
        static_cast<void>(write_rates(path, this_machine(), rates));
    }
}

}  // namespace opaline::bake
