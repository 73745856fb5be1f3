#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "bake/cli/program.h"
#include "formats/vdb/answer_vdb_request.h"

namespace {

// Everything of ours is written and destroyed. Libraries' statics are left alone: OpenVDB brings a
// logger that starts four threads when it is loaded, and these race with its destruction.
int end_program(int code) {
    std::fflush(stdout);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they report at the end
    std::_Exit(code);
#endif
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    if (opaline::formats::is_vdb_request(argc, argv)) {
        opaline::formats::answer_vdb_request(argc, argv);
    }
    // A write past the limit of file sizes fails as one to a full disk does.
    std::signal(SIGXFSZ, SIG_IGN);
    return end_program(opaline::cli::run_program(argc, argv));
}
