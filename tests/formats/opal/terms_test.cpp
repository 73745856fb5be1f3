#include "formats/opal/terms.h"

#include <gtest/gtest.h>

namespace opaline::formats {
namespace {

TEST(TermSets, NamesAndSetsAreInverse) {
    for (std::uint32_t bits = 1; bits <= static_cast<std::uint32_t>(TermSet::all); ++bits) {
        const auto set = static_cast<TermSet>(bits);
        const auto parsed = parse_terms(term_names(set), TermSet::all, "--terms");
        ASSERT_TRUE(parsed) << bits;
        EXPECT_EQ(*parsed, set);
    }
    EXPECT_EQ(term_names(TermSet::baked),
              "multiple,single,specular,diffuse,volume-single,volume-multiple");
}

TEST(TermSets, AllAndNothingStandForWhatIsAllowed) {
    for (const TermSet allowed : {TermSet::baked, TermSet::all}) {
        EXPECT_EQ(*parse_terms("all", allowed, "--terms"), allowed);
        EXPECT_EQ(*parse_terms("", allowed, "--terms"), allowed);
    }
}

TEST(TermSets, OtherNamesAreRefusedWithTheOptionAndTheNames) {
    for (const char* text : {"sparkle", "multiple,", ",single", "diffuse;single", "Diffuse",
                             "unscattered", "all,single"}) {
        const auto parsed = parse_terms(text, TermSet::baked, "--terms");
        ASSERT_FALSE(parsed) << text;
        EXPECT_EQ(parsed.error().kind, ErrorKind::usage);
        const Diagnostic& main = parsed.error().diagnostics.front();
        EXPECT_EQ(main.where, "--terms");
        EXPECT_NE(main.remedy.find("multiple,single,specular,diffuse"), std::string::npos);
        EXPECT_EQ(main.remedy.find("unscattered,"), std::string::npos);
    }
    EXPECT_TRUE(parse_terms("unscattered", TermSet::all, "--terms"));
}

TEST(TermSets, ComplementsStayWithinAllTerms) {
    EXPECT_EQ(~TermSet::none, TermSet::all);
    EXPECT_EQ(~TermSet::baked, TermSet::unscattered | TermSet::interreflection | TermSet::emitters);
}

}  // namespace
}  // namespace opaline::formats
