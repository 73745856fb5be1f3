#include "formats/opal/terms.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace opaline::formats {
namespace {

struct NamedTerm {
    TermSet term;
    std::string_view name;
};

constexpr std::array kNamedTerms{NamedTerm{TermSet::multiple, "multiple"},
                                 NamedTerm{TermSet::single, "single"},
                                 NamedTerm{TermSet::specular, "specular"},
                                 NamedTerm{TermSet::diffuse, "diffuse"},
                                 NamedTerm{TermSet::unscattered, "unscattered"},
                                 NamedTerm{TermSet::interreflection, "interreflection"},
                                 NamedTerm{TermSet::volume_single, "volume-single"},
                                 NamedTerm{TermSet::volume_multiple, "volume-multiple"},
                                 NamedTerm{TermSet::emitters, "emitters"}};

}  // namespace

std::string term_names(TermSet terms, std::string_view separator) {
    std::string names;
    for (const NamedTerm& t : kNamedTerms) {
        if (!has_any(terms, t.term)) continue;
        if (!names.empty()) names += separator;
        names += t.name;
    }
    return names;
}

Result<TermSet> parse_terms(std::string_view text, TermSet allowed, const std::string& option) {
    if (text.empty() || text == "all") return allowed;
    TermSet terms = TermSet::none;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view name = text.substr(begin, end - begin);
        const auto* const known = std::find_if(
            kNamedTerms.begin(), kNamedTerms.end(),
            [&](const NamedTerm& t) { return t.name == name && has_any(allowed, t.term); });
        if (known == kNamedTerms.end()) {
            return make_error(ErrorKind::usage, "", option,
                              "'" + std::string(name) + "' is not a component of radiance here",
                              "give all, or some of " + term_names(allowed));
        }
        terms |= known->term;
        begin = end + 1;
    }
    return terms;
}

}  // namespace opaline::formats
