#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "formats/opal/mapped_file.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/write_opal.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/support/temporary_folder.h"

namespace opaline::formats {
namespace {

// Bytes at an address aligned like a mapped file's, with nothing readable behind them under the
// address sanitizer.
class AlignedBytes {
  public:
    explicit AlignedBytes(std::span<const std::byte> bytes)
        : size_(bytes.size()),
          data_(static_cast<std::byte*>(
              ::operator new(std::max<std::size_t>(size_, 1), std::align_val_t(64)))) {
        std::memcpy(data_, bytes.data(), size_);
    }
    AlignedBytes(const AlignedBytes&) = delete;
    AlignedBytes& operator=(const AlignedBytes&) = delete;
    ~AlignedBytes() { ::operator delete(data_, std::align_val_t(64)); }
    std::span<std::byte> bytes() { return {data_, size_}; }

  private:
    std::size_t size_;
    std::byte* data_;
};

std::vector<std::byte> encode(const Asset& asset) {
    const tests::TemporaryFolder folder;
    auto file = AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file);
    EXPECT_TRUE(write_opal(asset.view(), std::move(*file)));
    auto mapped = MappedFile::open(folder / "a.opal");
    EXPECT_TRUE(mapped);
    return {mapped->bytes().begin(), mapped->bytes().end()};
}

template <class A, class B>
void expect_same_bytes(const A& a, const B& b) {
    ASSERT_EQ(std::size(a), std::size(b));
    if (std::size(a) > 0) {
        EXPECT_EQ(std::memcmp(std::data(a), std::data(b), std::size(a) * sizeof(*std::data(a))), 0);
    }
}

TEST(OpalFile, ReturnsEveryValueItWasGiven) {
    for (const std::uint32_t bits : {8u, 16u}) {
        const Asset asset = tests::make_small_asset(bits);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        const AssetView& view = loaded->view;
        EXPECT_EQ(view.provenance, asset.provenance);
        EXPECT_EQ(view.cubemap_size, 8u);
        expect_same_bytes(view.primitives, asset.primitives);
        expect_same_bytes(view.position, asset.position);
        expect_same_bytes(view.normal, asset.normal);
        expect_same_bytes(view.base_color, asset.base_color);
        expect_same_bytes(view.texcoord, asset.texcoord);
        expect_same_bytes(view.index, asset.index);
        expect_same_bytes(view.transport.row_offset, asset.transport.row_offset);
        expect_same_bytes(view.transport.average_scale, asset.transport.average_scale);
        expect_same_bytes(view.transport.detail_scale, asset.transport.detail_scale);
        expect_same_bytes(view.transport.average_code, asset.transport.average_code);
        expect_same_bytes(view.transport.index16, asset.transport.index16);
        expect_same_bytes(view.transport.code8, asset.transport.code8);
        expect_same_bytes(view.transport.code16, asset.transport.code16);
        ASSERT_EQ(view.images.size(), 1u);
        expect_same_bytes(view.images[0].rgb, asset.images[0].rgb);
        for (const SectionEntry& section : loaded->sections) {
            EXPECT_EQ(section.offset % kSectionAlignment, 0u);
        }
    }
}

TEST(OpalFile, TranslucentPrimitivesComeBackWithEveryTerm) {
    for (const std::uint32_t terms : {1u, 4u, 9u, 16u, 25u}) {
        for (const float eta : {kMinEta, 1.0f, 1.3f, kMaxEta}) {
            Asset asset = tests::make_small_asset();
            tests::add_translucent_triangle(asset, terms, eta);
            AlignedBytes stored(encode(asset));
            const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
            ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
            ASSERT_EQ(loaded->view.primitives.size(), 3u);
            const PrimitiveRecord& p = loaded->view.primitives[2];
            expect_same_bytes(loaded->view.primitives, asset.primitives);
            ASSERT_EQ(p.rows().rows, 3 * terms);
            std::vector<float> stored_row(cubemap_texels(8)), own_row(cubemap_texels(8));
            for (std::uint32_t row = 0; row < p.rows().rows; ++row) {
                decode_row(loaded->view.transport, p.rows(), row, 1, stored_row);
                decode_row(asset.transport.view(), p.rows(), row, 1, own_row);
                EXPECT_EQ(stored_row, own_row);
            }
        }
    }
}

std::uint32_t version_of_primitives(const LoadedAsset& loaded) {
    return std::find_if(loaded.sections.begin(), loaded.sections.end(),
                        [](const SectionEntry& s) { return s.id == kPrimSection; })
        ->version;
}

// Readers that expect three bands in media must not take such a file for a damaged one.
TEST(OpalFile, MediaOfOneBandComeBackUnderAVersionOfTheirOwn) {
    for (const bool is_separate : {false, true}) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, is_separate ? 5 : 4, 1.3f, is_separate, 1);
        tests::add_translucent_triangle(asset, 4, 1.4f, false, 3);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        EXPECT_EQ(version_of_primitives(*loaded), 2u);
        expect_same_bytes(loaded->view.primitives, asset.primitives);
        EXPECT_EQ(loaded->view.primitives[2].bands, 1u);
        std::vector<float> stored_row(cubemap_texels(8)), own_row(cubemap_texels(8));
        for (const std::size_t p : {2u, 3u}) {
            const RowRange range = asset.primitives[p].rows();
            decode_row(loaded->view.transport, range, range.rows - 1, 0, stored_row);
            decode_row(asset.transport.view(), range, range.rows - 1, 0, own_row);
            EXPECT_EQ(stored_row, own_row);
        }
    }
}

TEST(OpalFile, WithoutMediaOfOneBandEarlierReadersReadIt) {
    Asset asset = tests::make_small_asset();  // one diffuse primitive of one band
    tests::add_translucent_triangle(asset, 4, 1.3f);
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(version_of_primitives(*loaded), 1u);
}

TEST(OpalFile, ALaterSectionVersionAsksForAnUpdate) {
    for (const std::uint32_t id : {kPrimSection, kTranSection}) {
        AlignedBytes stored(encode(tests::make_small_asset()));
        FileHeader header;
        std::memcpy(&header, stored.bytes().data(), sizeof header);
        std::byte* const table = stored.bytes().data() + sizeof header;
        for (std::uint32_t s = 0; s < header.section_count; ++s) {
            SectionEntry entry;
            std::memcpy(&entry, table + s * sizeof entry, sizeof entry);
            if (entry.id == id) {
                entry.version = id == kPrimSection ? 3 : 2;
                std::memcpy(table + s * sizeof entry, &entry, sizeof entry);
            }
        }
        header.table_checksum = checksum({table, header.section_count * sizeof(SectionEntry)});
        std::memcpy(stored.bytes().data(), &header, sizeof header);
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded);
        EXPECT_EQ(loaded.error().kind, ErrorKind::newer_file);
        EXPECT_EQ(loaded.error().diagnostics.front().where, "section " + section_name(id));
    }
}

TEST(OpalFile, ImpossibleShadingIsRefusedByName) {
    const auto fault_of = [](auto change) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, 4, 1.3f);
        change(asset.primitives);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        return loaded ? std::string() : loaded.error().diagnostics.front().fault;
    };
    using Primitives = std::vector<PrimitiveRecord>;
    EXPECT_EQ(fault_of([](Primitives&) {}), "");
    for (const std::uint32_t terms : {0u, 2u, 3u, 5u, 36u, 0xffffffffu}) {
        EXPECT_THAT(fault_of([terms](Primitives& p) { p[2].terms = terms; }),
                    testing::HasSubstr("terms"));
    }
    for (const std::uint32_t bands : {0u, 2u, 4u, 0xffffffffu}) {
        EXPECT_THAT(
            fault_of([bands](Primitives& p) { p[2].bands = bands; }),
            testing::AllOf(testing::HasSubstr(std::to_string(bands) + " bands"),
                           testing::HasSubstr("expected"), testing::HasSubstr("1 or 3 bands")));
    }
    for (const float eta : {0.0f, 0.33f, 3.01f, -1.3f, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
        EXPECT_THAT(fault_of([eta](Primitives& p) { p[2].eta = eta; }),
                    testing::HasSubstr("index of refraction"));
        if (eta != 0) {
            EXPECT_THAT(fault_of([eta](Primitives& p) { p[0].eta = eta; }),
                        testing::HasSubstr("index of refraction"));
        }
    }
    EXPECT_THAT(fault_of([](Primitives& p) { p[0].terms = 4; }), testing::HasSubstr("terms"));
    EXPECT_THAT(fault_of([](Primitives& p) { p[1].shading = static_cast<Shading>(3); }),
                testing::HasSubstr("shading 3"));
    // More rows than there are, by the number of terms.
    EXPECT_NE(fault_of([](Primitives& p) { p[2].terms = 9; }), "");
}

TEST(OpalFile, SeparateScatteringHasOneRowMoreThanItsHarmonics) {
    const auto fault_of = [](std::uint32_t terms, bool is_separate) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, terms, 1.3f, is_separate);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        if (loaded) {
            EXPECT_EQ(loaded->view.primitives[2].is_separate(), is_separate);
        }
        return loaded ? std::string() : loaded.error().diagnostics.front().fault;
    };
    for (const std::uint32_t single : {0u, 1u, 4u, 9u, 16u, 25u}) {
        EXPECT_EQ(fault_of(1 + single, true), "") << single;
    }
    for (const std::uint32_t terms : {3u, 4u, 6u, 9u, 25u, 27u}) {
        EXPECT_THAT(fault_of(terms, true), testing::HasSubstr("terms"));
    }
    EXPECT_NE(fault_of(26, false), "");
    Asset asset = tests::make_small_asset();
    asset.primitives[0].flags |= PrimitiveRecord::kSeparate;
    AlignedBytes stored(encode(asset));
    EXPECT_FALSE(read_opal(stored.bytes(), "a.opal"));
}

TEST(OpalFile, SpecularComesBackAndIsAbsentWithoutIt) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    {
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded);
        EXPECT_TRUE(loaded->view.roughness.empty() && loaded->view.openness.empty());
        EXPECT_EQ(loaded->sections.size(), 6u);
    }
    tests::add_gloss(asset);
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    expect_same_bytes(loaded->view.roughness, asset.roughness);
    expect_same_bytes(loaded->view.openness, asset.openness);
    EXPECT_EQ(loaded->sections.back().id, kSpecSection);
}

TEST(OpalFile, ImpossibleSpecularIsRefusedByName) {
    const auto fault_of = [](auto change) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, 4, 1.3f);
        tests::add_gloss(asset);
        change(asset);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        return loaded ? std::string() : loaded.error().diagnostics.front().where;
    };
    EXPECT_EQ(fault_of([](Asset&) {}), "");
    for (const float roughness : {-0.5f, 1.01f, std::numeric_limits<float>::quiet_NaN(),
                                  std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(fault_of([roughness](Asset& a) { a.roughness[2] = roughness; }),
                  "section SPEC, primitive 2");
    }
    EXPECT_EQ(fault_of([](Asset& a) { a.roughness[0] = 0.2f; }), "section SPEC, primitive 0");
    EXPECT_EQ(fault_of([](Asset& a) { a.roughness.pop_back(); }), "section SPEC");
    EXPECT_EQ(fault_of([](Asset& a) { a.openness.pop_back(); }), "section SPEC");
}

TEST(Openness, ComesBackWithinItsBits) {
    for (int i = 0; i < 2000; ++i) {
        const float t = static_cast<float>(i);
        const Vec3 axis = normalize({std::sin(t), std::cos(2.3f * t), std::sin(3.1f * t + 1)});
        const float fraction = 0.5f + 0.5f * std::sin(0.7f * t);
        const Openness openness = encode_openness(3.0f * axis, fraction);
        EXPECT_LT(length(open_axis(openness) - axis), 0.0175f);  // 1 degree
        EXPECT_NEAR(open_fraction(openness), fraction, 1.0f / 255);
    }
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0},
                            Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        EXPECT_EQ(open_axis(encode_openness(axis, 1)), axis);
    }
    // What is exactly open or closed stays so, and nothing else becomes so.
    EXPECT_EQ(open_fraction(encode_openness({0, 0, 1}, 1)), 1.0f);
    EXPECT_EQ(open_fraction(encode_openness({0, 0, 1}, 0)), 0.0f);
    EXPECT_LT(open_fraction(encode_openness({0, 0, 1}, 0.99999f)), 1.0f);
    EXPECT_GT(open_fraction(encode_openness({0, 0, 1}, 1e-6f)), 0.0f);
    // Absurd input gives something that can be decoded.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(open_axis(encode_openness({0, 0, 0}, nan)), (Vec3{0, 0, 1}));
    EXPECT_EQ(encode_openness({nan, 1, 0}, nan).fraction, 0);
    for (int x = -128; x < 128; x += 5) {
        Openness any;
        any.axis[0] = any.axis[1] = static_cast<std::int8_t>(x);
        EXPECT_NEAR(length(open_axis(any)), 1, 1e-6f);
    }
}

TEST(OpalFile, TransportIsUsedInPlace) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_TRUE(loaded);
    const auto* codes = reinterpret_cast<const std::byte*>(loaded->view.transport.code8.data());
    EXPECT_GE(codes, stored.bytes().data());
    EXPECT_LT(codes, stored.bytes().data() + stored.bytes().size());
}

TEST(OpalFile, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = encode(tests::make_small_asset());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        AlignedBytes stored(std::span<const std::byte>(whole).first(size));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes";
        ASSERT_EQ(loaded.error().kind, ErrorKind::bad_input);
    }
}

TEST(OpalFile, TrailingBytesAreRefused) {
    std::vector<std::byte> bytes = encode(tests::make_small_asset());
    bytes.push_back(std::byte{0});
    AlignedBytes stored(bytes);
    EXPECT_FALSE(read_opal(stored.bytes(), "a.opal"));
}

// Padding between sections is the only place where a flipped bit means nothing.
TEST(OpalFile, EveryFlippedByteOfASectionIsFoundByTheFullCheck) {
    const std::vector<std::byte> whole = encode(tests::make_small_asset());
    AlignedBytes sound(whole);
    const auto table = read_section_table(sound.bytes(), "a.opal");
    ASSERT_TRUE(table);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        AlignedBytes stored(whole);
        stored.bytes()[at] ^= std::byte{0x40};
        const bool in_section = std::any_of(table->begin(), table->end(), [at](const auto& s) {
            return at >= s.offset && at < s.offset + s.stored_size;
        });
        const bool accepted = read_opal(stored.bytes(), "a.opal", Checks::full).has_value();
        if (in_section) {
            ASSERT_FALSE(accepted) << "byte " << at;
        }
    }
}

// Damage that keeps its checksum is what a hostile writer makes: nothing may be read out of bounds.
TEST(OpalFile, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f, false, 1);
    const std::vector<std::byte> whole = encode(asset);
    std::size_t refused = 0, accepted = 0;
    for (std::size_t at = sizeof(FileHeader); at < whole.size(); ++at) {
        for (const int bit : {0, 3, 7}) {
            AlignedBytes stored(whole);
            stored.bytes()[at] ^= static_cast<std::byte>(1 << bit);
            // Repair the table's own checksum, so that forged tables are looked at.
            FileHeader header;
            std::memcpy(&header, stored.bytes().data(), sizeof header);
            header.table_checksum = checksum(
                stored.bytes().subspan(sizeof header, header.section_count * sizeof(SectionEntry)));
            std::memcpy(stored.bytes().data(), &header, sizeof header);
            const auto loaded = read_opal(stored.bytes(), "a.opal");
            if (!loaded) {
                ++refused;
                continue;
            }
            ++accepted;
            // Use everything the runtime would use; the address sanitizer watches.
            std::vector<float> dense(cubemap_texels(loaded->view.cubemap_size));
            for (const PrimitiveRecord& p : loaded->view.primitives) {
                for (std::uint32_t r = 0; r < p.rows().rows; ++r) {
                    for (std::uint32_t band = 0; band < p.bands; ++band) {
                        decode_row(loaded->view.transport, p.rows(), r, band, dense);
                    }
                }
                for (std::uint32_t i = 0; i < p.index_count; ++i) {
                    const std::uint32_t v = p.first_vertex + loaded->view.index[p.first_index + i];
                    ASSERT_LT(v, loaded->view.position.size());
                }
            }
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(accepted, 100u);
}

TEST(OpalFile, ALaterVersionAsksForAnUpdate) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    header.version = kOpalVersion + 1;
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::newer_file);
}

TEST(OpalFile, AnUnknownSectionIsSkipped) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    FileHeader header;
    std::memcpy(&header, stored.bytes().data(), sizeof header);
    // The provenance is the one section that nothing else needs: rename it.
    SectionEntry entry;
    std::byte* table = stored.bytes().data() + sizeof header;
    std::memcpy(&entry, table, sizeof entry);
    ASSERT_EQ(entry.id, kProvSection);
    entry.id = section_id("XTRA");
    entry.version = 99;
    std::memcpy(table, &entry, sizeof entry);
    header.table_checksum = checksum({table, header.section_count * sizeof(SectionEntry)});
    std::memcpy(stored.bytes().data(), &header, sizeof header);
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->view.provenance.empty());
}

TEST(OpalFile, TheFullCheckFindsNumbersThatAreNotFinite) {
    Asset asset = tests::make_small_asset();
    asset.position[3].y = std::numeric_limits<float>::quiet_NaN();
    AlignedBytes bad_position(encode(asset));
    EXPECT_TRUE(read_opal(bad_position.bytes(), "a.opal"));
    EXPECT_FALSE(read_opal(bad_position.bytes(), "a.opal", Checks::full));
    asset = tests::make_small_asset();
    asset.transport.detail_scale[2] = std::numeric_limits<float>::infinity();
    AlignedBytes bad_scale(encode(asset));
    EXPECT_FALSE(read_opal(bad_scale.bytes(), "a.opal", Checks::full));
}

}  // namespace
}  // namespace opaline::formats
