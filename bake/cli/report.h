#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/pipeline.h"

namespace opaline::cli {

/// The `--report` JSON (design 3, contract). `bytes`: size of the written file.
std::string make_report(const formats::Scene& scene, const bake::BakeResult& result,
                        const std::vector<formats::Diagnostic>& warnings, std::uint64_t bytes);

/// The plan as JSON: {"plan": [...]}, and as a table for people.
std::string make_plan_json(const std::vector<bake::PlanEntry>& plan);
std::string make_plan_table(const std::vector<bake::PlanEntry>& plan);

/// One rule in make format: `output: inputs`.
std::string make_depfile(const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs);

}  // namespace opaline::cli
