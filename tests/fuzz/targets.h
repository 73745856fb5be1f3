#pragma once

#include <cstddef>
#include <span>

#include "formats/opal/result.h"

namespace opaline::fuzz {

/// A reader, given bytes as if they came from anyone.
struct Target {
    const char* name;  ///< also of the folder of its inputs in corpus/
    /// Returns whatever the bytes are; a promise of the reader that does not hold ends the program.
    void (*run)(std::span<const std::byte>);
    /// Bytes that one allocation may have for a file of that many.
    std::size_t (*most_allocated)(std::size_t file_bytes);
};

std::span<const Target> all_targets();

/// Runs the target. Larger allocations meanwhile end a program that the address sanitizer is in.
void run(const Target& target, std::span<const std::byte> bytes);

/// What each reader runs. `.opal` files: read as hosts do, through the C interface, and as
/// `opaline render` does, which does not look at values.
void run_opal_abi(std::span<const std::byte> bytes);
void run_opal_picture(std::span<const std::byte> bytes);
void run_gltf(std::span<const std::byte> bytes);
void run_texture(std::span<const std::byte> bytes);
void run_media(std::span<const std::byte> bytes);
void run_phase_table(std::span<const std::byte> bytes);
void run_exr(std::span<const std::byte> bytes);
void run_hdr(std::span<const std::byte> bytes);
void run_png(std::span<const std::byte> bytes);
/// The process that reads OpenVDB files, and what the one that asked makes of its reply.
void run_vdb(std::span<const std::byte> bytes);
void run_vdb_reply(std::span<const std::byte> bytes);
void run_view_script(std::span<const std::byte> bytes);
void run_relight_table(std::span<const std::byte> bytes);
/// Arguments, each ended by a zero or a line feed.
void run_command_line(std::span<const std::byte> bytes);

/// Ends the program, saying `promise`, where it does not hold.
void hold(bool holds, const char* promise);

/// Where an error does not say what is wrong, or has too many faults for a reader.
void expect_message(const formats::Error& error);

}  // namespace opaline::fuzz
