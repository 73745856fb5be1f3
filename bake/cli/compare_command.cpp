#include "bake/lab/compare/compare_files.h"

#include <fmt/core.h>

#include <memory>
#include <string>

#include "bake/cli/command.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"

namespace opaline::cli {
namespace {

struct CompareCommand {
    std::string a, b;
    double max_relative = -1;
    bool json = false;
};

int run(const CompareCommand& options) {
    const auto comparison = require(bake::compare_files(options.a, options.b));
    const bool is_within =
        options.max_relative < 0 || comparison.relative_rmse <= options.max_relative;
    if (options.json) {
        fmt::print("{}", json_text({{"elements", comparison.count},
                                    {"rmse", comparison.rmse},
                                    {"relative_rmse", comparison.relative_rmse},
                                    {"p95", comparison.p95},
                                    {"maximum", comparison.maximum},
                                    {"within", is_within}}));
        return is_within ? kExitSuccess : kExitNo;
    }
    fmt::print("elements        {}\n", comparison.count);
    fmt::print("rmse            {:.6g}\n", comparison.rmse);
    fmt::print("relative rmse   {:.6g}\n", comparison.relative_rmse);
    fmt::print("95th percentile {:.6g}\n", comparison.p95);
    fmt::print("maximum         {:.6g}\n", comparison.maximum);
    if (!is_within) {
        print_to_stderr(fmt::format("opaline: {} differs from {} by more than {:g}\n",
                                    printable(options.a), printable(options.b),
                                    options.max_relative));
        return kExitNo;
    }
    return kExitSuccess;
}

}  // namespace

void add_compare_command(Program& program) {
    auto [command, options] = add_command<CompareCommand>(
        program, "compare",
        "Say how far A is from the reference B: two images or two relight tables", run);
    command.add("a", "A", file_name(options.a), "image (.exr, .hdr, .png) or table (.csv)")
        .required();
    command.add("b", "B", file_name(options.b), "the reference, of the same kind").required();
    command.add("--max-rel", "E", real_number(options.max_relative, 0, 1e30),
                "exit with code 1 if the relative RMSE is larger");
    command.add_flag("--json", options.json, "print JSON");
    command.footer("Example:\n  opaline compare draft.exr production.exr --max-rel 0.05");
}

}  // namespace opaline::cli
