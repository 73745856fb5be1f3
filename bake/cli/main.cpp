#include <fcntl.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

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

// Where a standard descriptor is closed, the next file that is opened would get its number, and
// what is printed would stand in that file. What this opens in its place can neither be read nor
// written, as before.
void keep_standard_descriptors() {
    for (const int descriptor : {0, 1, 2}) {
        if (::fcntl(descriptor, F_GETFD) == -1) {
            [[maybe_unused]] const int taken =
                ::open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (opaline::formats::is_vdb_request(argc, argv)) {
        opaline::formats::answer_vdb_request(argc, argv);
    }
    keep_standard_descriptors();
    // A write past the limit of file sizes fails as one to a full disk does.
    std::signal(SIGXFSZ, SIG_IGN);
    return end_program(opaline::cli::run_program(argc, argv));
}
