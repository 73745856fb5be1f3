#include "runtime/terms.h"

#include <string>

namespace opaline::runtime {

using formats::TermSet;

std::size_t find_merged(const formats::AssetView& asset, formats::TermSet terms) {
    const bool multiple = has_any(terms, TermSet::multiple);
    const bool single = has_any(terms, TermSet::single);
    for (std::size_t i = 0; multiple != single && i < asset.primitives.size(); ++i) {
        const formats::PrimitiveRecord& p = asset.primitives[i];
        if (p.shading == formats::Shading::translucent && !p.is_separate() && !p.is_single_only())
            return i;
    }
    return asset.primitives.size();
}

formats::Status check_terms(const formats::AssetView& asset, formats::TermSet terms,
                            const std::string& file) {
    const std::size_t merged = find_merged(asset, terms);
    if (merged == asset.primitives.size()) return formats::ok_status();
    return formats::make_error(
        formats::ErrorKind::bad_input, file, "primitive " + std::to_string(merged),
        std::string("its rows hold multiple and single scattering as one, so that ") +
            (has_any(terms, TermSet::multiple) ? "multiple" : "single") +
            " scattering cannot be shown alone",
        "bake with --separate-terms, or show both");
}

}  // namespace opaline::runtime
