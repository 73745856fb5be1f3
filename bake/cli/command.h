#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace opaline::cli {

/// Exit codes (README.md of the project).
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitNo = 1;  ///< the job ran and the answer is no
inline constexpr int kExitUsage = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitResource = 4;
inline constexpr int kExitInterrupted = 130;

/// The action of the chosen command, run after parsing; returns the exit code.
using Job = std::function<int()>;

/// Each adds one command, its options and its help to the program.
void add_bake_command(CLI::App& app, Job& job);
void add_plan_command(CLI::App& app, Job& job);
void add_info_command(CLI::App& app, Job& job);
void add_verify_command(CLI::App& app, Job& job);
void add_relight_command(CLI::App& app, Job& job);
void add_render_command(CLI::App& app, Job& job);
void add_view_command(CLI::App& app, Job& job);  // in view/
void add_export_web_command(CLI::App& app, Job& job);
void add_reference_command(CLI::App& app, Job& job);
void add_compare_command(CLI::App& app, Job& job);
void add_mie_command(CLI::App& app, Job& job);
void add_phase_command(CLI::App& app, Job& job);
void add_slab_command(CLI::App& app, Job& job);
void add_sweep_command(CLI::App& app, Job& job);
void add_example_command(CLI::App& app, Job& job);
void add_help_command(CLI::App& app, Job& job);  // of those added before and after

}  // namespace opaline::cli
