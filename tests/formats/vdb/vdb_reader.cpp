// The process that read_vdb starts: what the program does first, and nothing else of it.
#include "formats/vdb/answer_vdb_request.h"

int main(int argc, char** argv) {
    if (opaline::formats::is_vdb_request(argc, argv)) {
        opaline::formats::answer_vdb_request(argc, argv);
    }
    return 2;
}
