#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats::vdb {

/// First argument of a program that is asked to read a file; see answer_vdb_request.h. After it:
/// bytes of address space, seconds of CPU time, names of grids.
inline constexpr const char* kRequest = "--opaline-read-vdb";
/// Set in the environment of that process, which must not start another one: a program that knows
/// nothing of requests would start itself over and over.
inline constexpr const char* kRequestVariable = "OPALINE_READS_VDB";
/// Descriptors of that process: the file, and the pipe for the reply. It has no others but
/// /dev/null as standard input, output and error.
inline constexpr int kFileDescriptor = 3, kReplyDescriptor = 4;

/// How a reader came to its end.
enum class Ending {
    done,         ///< exit code 0
    failed,       ///< another exit code, or a signal: a crash
    out_of_cpu,   ///< past its CPU time
    out_of_time,  ///< past the wall-clock time
    was_interrupted
};

/// A process that reads a file and replies through a pipe. It does not outlive the object.
class ReaderProcess {
  public:
    /// `file`: open descriptor of the file, which stays the caller's. Errors: resource.
    static Result<ReaderProcess> start(int file, std::span<const std::string> names,
                                       const VdbReadOptions& options);

    ReaderProcess(ReaderProcess&& other) noexcept;
    ReaderProcess& operator=(ReaderProcess&&) = delete;
    ReaderProcess(const ReaderProcess&) = delete;
    ReaderProcess& operator=(const ReaderProcess&) = delete;
    ~ReaderProcess();

    /// Waits for the next bytes of the reply until all of `out` is filled. False if the reply ends
    /// before, the time is over, or the user interrupts.
    bool read(std::span<std::byte> out);

    /// Whether the reply is at its end: waits for it, within the time.
    bool is_at_end();

    /// Ends the process if it still runs, and waits for it. Once.
    Ending finish();

  private:
    explicit ReaderProcess(const VdbReadOptions& options);
    bool wait_for_bytes();
    bool fill_buffer();

    pid_t process_ = -1;
    int pipe_ = -1;
    std::chrono::steady_clock::time_point deadline_;
    const std::atomic<bool>* interrupted_;
    bool is_late_ = false, is_interrupted_ = false;
    std::vector<std::byte> buffer_;  ///< came through the pipe and was not asked for yet:
    std::size_t used_ = 0;           ///< without these first ones
};

}  // namespace opaline::formats::vdb
