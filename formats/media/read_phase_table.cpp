#include "formats/media/read_phase_table.h"

#include <new>
#include <string_view>
#include <utility>

#include "formats/gltf/container.h"
#include "formats/gltf/report.h"
#include "formats/media/read_phase.h"

namespace opaline::formats {

Result<PhaseFunction> read_phase_table(const std::filesystem::path& path) {
    gltf::Report report;
    report.file = path.string();
    try {
        const auto bytes = gltf::read_whole_file(path, "", report);
        if (!bytes) return report.take_error();
        const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        auto phase = media::parse_phase_table(text, "table", report);
        if (!phase) return report.take_error();
        return std::move(*phase);
    } catch (const std::bad_alloc&) {
        return report.take_exception("make it smaller", "");
    }
}

}  // namespace opaline::formats
