#pragma once

namespace opaline::formats {

/// Whether this process was started by read_vdb to read a file for it.
bool is_vdb_request(int argc, const char* const* argv);

/// Does that: reads the file within the limits asked for, replies and ends the process. A program
/// that calls read_vdb begins its main with
///
///     if (formats::is_vdb_request(argc, argv)) formats::answer_vdb_request(argc, argv);
///
/// before anything else, so that nothing of the program has been set up that limits could break.
[[noreturn]] void answer_vdb_request(int argc, const char* const* argv);

}  // namespace opaline::formats
