#include "formats/opal/receiver_errors.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/opal/section_arrays.h"

namespace opaline::formats {
namespace {

// In units whose address suits every array of a section.
struct alignas(kArrayAlignment) ArrayUnit {
    std::byte bytes[kArrayAlignment];
};

std::uint64_t section_size(std::uint64_t receivers) {
    const std::uint64_t values = receivers * sizeof(float);
    return sizeof(ReceiverErrorsHead) +
           (values + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
}

// The section's bytes once they are decoded; empty where they are not of that size.
std::vector<ArrayUnit> decode_units(std::span<const std::byte> stored, std::uint32_t codec,
                                    std::uint64_t size) {
    std::vector<ArrayUnit> units(static_cast<std::size_t>(size / sizeof(ArrayUnit)));
    if (codec == static_cast<std::uint32_t>(Codec::zstd)) {
        if (ZSTD_decompress(units.data(), static_cast<std::size_t>(size), stored.data(),
                            stored.size()) != size) {
            units.clear();
        }
    } else if (codec == static_cast<std::uint32_t>(Codec::none) && stored.size() == size) {
        std::memcpy(units.data(), stored.data(), stored.size());
    } else {
        units.clear();
    }
    return units;
}

const char* find_error_fault(const ReceiverErrorsHead& head, std::uint32_t receivers,
                             std::span<const float> errors) {
    if (head.receivers != receivers) return "it does not have a number for each receiver";
    if ((head.reserved[0] | head.reserved[1] | head.reserved[2]) != 0) {
        return "a value is not one of this version";
    }
    const bool is_sound = std::all_of(errors.begin(), errors.end(),
                                      [](float e) { return std::isfinite(e) && e >= 0; });
    return is_sound ? nullptr : "an error is below 0 or not finite";
}

}  // namespace

Result<std::vector<float>> read_receiver_errors(std::span<const std::byte> bytes,
                                                const LoadedAsset& loaded,
                                                const std::string& file) {
    const auto entry = std::find_if(loaded.sections.begin(), loaded.sections.end(),
                                    [](const SectionEntry& s) { return s.id == kRerrSection; });
    if (entry == loaded.sections.end()) return std::vector<float>{};
    const auto damaged = [&](const char* fault) {
        return make_error(ErrorKind::bad_input, file, "section RERR", fault,
                          "the file is damaged: bake it again, or copy it again");
    };
    if (entry->version != kRerrVersion) {
        return make_error(ErrorKind::newer_file, file, "section RERR",
                          "version " + std::to_string(entry->version) + " is unknown",
                          "update Opaline");
    }
    const std::span<const std::byte> stored = bytes.subspan(
        static_cast<std::size_t>(entry->offset), static_cast<std::size_t>(entry->stored_size));
    if (checksum(stored) != entry->checksum) return damaged("its checksum does not match");
    // The receivers stand in the file, 40 bytes each: their number bounds what is allocated.
    const std::uint32_t receivers = count_stored_vertices(loaded.view);
    if (entry->size != section_size(receivers)) {
        return damaged("it does not have a number for each receiver");
    }
    const std::vector<ArrayUnit> units = decode_units(stored, entry->codec, entry->size);
    if (units.empty()) return damaged("its data cannot be decoded");
    SectionCursor cursor(std::as_bytes(std::span(units)));
    ReceiverErrorsHead head;
    std::span<const float> errors;
    if (!cursor.take_one(head) || !cursor.take(receivers, errors) || !cursor.at_end()) {
        return damaged("its counts do not agree with its size");
    }
    if (const char* const fault = find_error_fault(head, receivers, errors)) return damaged(fault);
    return spread_to_copies(loaded.view, errors);
}

ErrorSummary summarize_errors(std::span<const float> errors) {
    ErrorSummary summary;
    if (errors.empty()) return summary;
    for (const float error : errors) {
        summary.mean += static_cast<double>(error);
    }
    summary.mean /= static_cast<double>(errors.size());
    std::vector<float> sorted(errors.begin(), errors.end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t rank = (95 * sorted.size() + 99) / 100;  // from 1
    summary.p95 = static_cast<double>(sorted[rank - 1]);
    summary.largest = static_cast<double>(sorted.back());
    return summary;
}

}  // namespace opaline::formats
