#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/pipeline.h"

namespace opaline::cli {

/// The predicted cost of a bake, and the source of the rates.
struct Expectation {
    bake::CostPrediction cost;
    std::string rates_note;
};

/// The `--report` JSON. Its keys are a contract. `bytes`: size of the written file.
std::string make_report(const formats::Scene& scene, const bake::BakeResult& result,
                        const Expectation& expected,
                        const std::vector<formats::Diagnostic>& warnings, std::uint64_t bytes);

/// The plan as JSON: {"plan": [...], "stages": [...], ...}, and as a table for people, who read on
/// how many `threads` it is for.
std::string make_plan_json(const bake::Knobs& knobs, const bake::RefineReport& refined,
                           const std::vector<bake::PlanEntry>& plan,
                           const bake::CostPrediction& cost);
std::string make_plan_table(const bake::Knobs& knobs, const bake::RefineReport& refined,
                            const std::vector<bake::PlanEntry>& plan,
                            const bake::CostPrediction& cost, unsigned threads);

/// One rule in make format: `output: inputs`.
std::string make_depfile(const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs);

}  // namespace opaline::cli
