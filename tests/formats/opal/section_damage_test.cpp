// Files whose bytes are not as they were written: nothing may be read out of bounds.
#include <gtest/gtest.h>

#include <functional>

#include "formats/opal/cubemap.h"
#include "formats/opal/half.h"
#include "tests/formats/opal/cloud_fixture.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/formats/opal/glow_fixture.h"
#include "tests/formats/opal/hole_fixture.h"
#include "tests/formats/opal/normal_map_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/slot_fixture.h"
#include "tests/support/float_traps.h"

namespace opaline::formats {
namespace {

using tests::AlignedBytes;
using tests::encode;

/// A section whose arrays are used in place, of a sound asset. Of its first `record_bytes` bytes,
/// which decide most, several bits are changed one by one, of the others one a byte. So many files
/// must be refused for their structure, accepted by that check, and refused for their values.
struct Section {
    const char* name;
    Asset asset;
    std::uint32_t id;
    std::size_t record_bytes, refused, accepted, refused_for_values;
};

std::vector<Section> all_sections() {
    using namespace tests;
    const std::size_t head = 48;
    const auto clouds = [](bool has_all) {
        return make_cloud_asset({.has_peak = has_all, .has_radiance = has_all});
    };
    return {{"clouds", clouds(true), kClouSection, head + sizeof(LayerRecord), 250, 250, 50},
            {"bare clouds", clouds(false), kClouSection, head + sizeof(LayerRecord), 250, 250, 50},
            {"emitters", make_emitter_asset(), kEmitSection, head + 16 + 16 + 80, 50, 50, 0},
            {"glow", make_glow_asset(), kGlowSection, head + 2 * sizeof(GlowRecord), 200, 500, 0},
            {"holes", make_hole_asset(), kHoleSection, 80, 50, 50, 5},
            {"normal maps", make_normal_map_asset(), kNormSection, 48, 50, 50, 0},
            {"slots", make_shared_asset(), kSharSection, 16, 80, 0, 0},
            {"volumes", make_volume_asset(), kVoluSection, head + 2 * sizeof(VolumeRecord), 1000,
             1000, 1000}};
}

double sum_of(const auto& values) {
    double sum = 0;
    for (const auto value : values) {
        sum += static_cast<double>(value);
    }
    return sum;
}

void use_rows(const SparseRowsView& rows, const RowRange& range, double& sum) {
    std::vector<float> dense(cubemap_texels(rows.cubemap_size));
    for (std::uint32_t row = 0; row < range.rows; ++row) {
        for (std::uint32_t band = 0; band < range.bands; ++band) {
            decode_row(rows, range, row, band, dense);
            sum += double{dense[row % dense.size()]};
        }
    }
}

void use_volume(const VolumesView& volumes, const VolumeRecord& v, double& sum) {
    const std::size_t cells = std::size_t{v.extent[0]} * v.extent[1] * v.extent[2];
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const std::uint32_t brick = volumes.table[v.first_cell + cell];
        if (brick == kNoBrick) continue;
        const std::size_t number = v.first_brick_number + brick;
        sum += double{volumes.density_scale[number]} +
               sum_of(volumes.density.subspan(number * kBrickVoxels, kBrickVoxels));
        for (std::size_t i = 0; i < v.corners_of_brick(); ++i) {
            const std::uint32_t node =
                volumes.corner[v.first_corner + brick * v.corners_of_brick() + i];
            if (node != kNoNode) sum += volumes.node[v.first_node + node][0];
        }
    }
    use_rows(volumes.rows, v.rows(), sum);
}

void use_glow(const AssetView& asset, const GlowRecord& record, double& sum) {
    const GlowView& glow = asset.volumes.glow;
    const VolumeRecord& volume = asset.volumes.records[record.volume];
    for (std::uint32_t b = 0; b < record.brick_count; ++b) {
        const std::size_t brick = record.first_brick + b;
        sum += asset.volumes.density_scale[volume.first_brick_number + glow.brick[brick]];
        for (std::size_t i = 0; i < kBrickVoxels; ++i) {
            sum += unpack_shared(glow.code[brick * kBrickVoxels + i]).g;
        }
    }
    const std::size_t values = std::size_t{3} * record.terms * volume.node_count;
    sum += sum_of(glow.value.subspan(record.first_value, values));
    sum += asset.emitters.name(record.emitter).size();
}

/// Uses everything that a runtime would use; the address sanitizer watches.
void use(const AssetView& asset) {
    const tests::UntrappedFloats any_value;  // not all readers check values
    double sum = static_cast<double>(list_emitters(asset.emitters).size());
    for (std::size_t number = 0; number < asset.primitives.size(); ++number) {
        const PrimitiveRecord& p = asset.primitives[number];
        use_rows(asset.transport, asset.rows_of(number), sum);
        for (std::uint32_t v = p.first_vertex; v < p.first_vertex + p.vertex_count; ++v) {
            const std::uint32_t slot = asset.slot_of(number, v);
            sum += asset.transport.row_offset[p.first_row + slot * p.terms] +
                   asset.normal[asset.vertex_of(number, slot)].x;
        }
        for (const std::uint32_t i : asset.index.subspan(p.first_index, p.index_count)) {
            sum += asset.position.subspan(p.first_vertex + i, 1)[0].x;
        }
    }
    for (const VolumeRecord& v : asset.volumes.records) {
        use_volume(asset.volumes, v, sum);
    }
    for (const GlowRecord& record : asset.volumes.glow.record) {
        use_glow(asset, record, sum);
    }
    for (std::size_t i = 0; i < asset.volumes.records.size(); ++i) {
        sum += double{eval_phase_table(asset.volumes.phase_of(i), 0.3f)};
    }
    for (const LayerRecord& layer : asset.clouds.records) {
        sum += sum_of(asset.clouds.thickness_of(layer));
        for (const auto& color : asset.clouds.ground_of(layer)) {
            sum += color[0] + color[3];
        }
        for (std::size_t band = 0; band < 3; ++band) {
            const LayerTables t = tables_of(asset.clouds, layer, band);
            for (const auto part :
                 {t.log_phase, t.glow, t.t1, t.t_ms, t.r1, t.mean_t, t.reflected, t.transmitted}) {
                sum += sum_of(part);
            }
        }
    }
    const EmittersView& emitters = asset.emitters;
    for (const EmitterBlock& block : emitters.block) {
        const PrimitiveRecord& primitive = asset.primitives[block.primitive];
        for (std::size_t row = 0; row < primitive.vertex_count * primitive.terms; ++row) {
            sum += double{block_value(emitters, block, row).b};
        }
        sum += static_cast<double>(emitters.name(block.emitter).size());
    }
    for (const OwnLight& own : emitters.own) {
        sum += static_cast<double>(emitters.name(own.emitter).size());
        if (own.image != kNoImage) sum += asset.images[own.image].rgb[0];
    }
    for (const HoleRecord& hole : asset.holes.record) {
        sum += asset.primitives[hole.primitive].terms;
        if (hole.image != kNoImage) sum += asset.images[hole.image].rgb[0];
    }
    for (const NormalMapRecord& map : asset.normal_maps.record) {
        sum += asset.primitives[map.primitive].terms + asset.images[map.image].rgb[0];
    }
    volatile double used = sum;
    (void)used;
}

TEST(SectionDamage, EveryTruncationOfTheFileIsRefused) {
    std::vector<Section> files = all_sections();
    files.push_back({"primitives", tests::make_small_asset(), kPrimSection, 0, 0, 0, 0});
    for (const Section& section : files) {
        SCOPED_TRACE(section.name);
        std::vector<std::byte> whole = encode(section.asset);
        for (std::size_t size = 0; size < whole.size(); ++size) {
            AlignedBytes stored(std::span<const std::byte>(whole).first(size));
            const auto loaded = read_opal(stored.bytes(), "a.opal");
            ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes";
            ASSERT_EQ(loaded.error().kind, ErrorKind::bad_input);
        }
        whole.push_back(std::byte{0});
        AlignedBytes longer(whole);
        EXPECT_FALSE(read_opal(longer.bytes(), "a.opal"));
    }
}

// Though all the rest agrees with its being cut.
TEST(SectionDamage, EveryTruncationOfTheLastSectionIsRefused) {
    for (const Section& section : all_sections()) {
        SCOPED_TRACE(section.name);
        const std::vector<std::byte> whole = encode(section.asset);
        AlignedBytes sound(whole);
        auto table = read_section_table(sound.bytes(), "a.opal");
        ASSERT_TRUE(table);
        SectionEntry& last = table->back();
        ASSERT_EQ(last.id, section.id);
        const std::uint64_t whole_size = last.codec == 0 ? last.size : 0;
        for (std::uint64_t size = 0; size < whole_size; ++size) {
            AlignedBytes stored(std::span<const std::byte>(whole).first(last.offset + size));
            FileHeader header;
            std::memcpy(&header, stored.bytes().data(), sizeof header);
            header.file_size = stored.bytes().size();
            std::memcpy(stored.bytes().data(), &header, sizeof header);
            last.size = last.stored_size = size;
            std::memcpy(stored.bytes().data() + sizeof header + (table->size() - 1) * sizeof last,
                        &last, sizeof last);
            tests::repair_checksums(stored.bytes(), section.id);
            const auto loaded = read_opal(stored.bytes(), "a.opal");
            ASSERT_FALSE(loaded) << "accepted the first " << size << " bytes of the section";
            ASSERT_EQ(loaded.error().diagnostics.front().where,
                      "section " + section_name(section.id));
        }
    }
}

TEST(SectionDamage, EveryFlippedByteOfASectionIsFoundByTheFullCheck) {
    std::vector<Section> files = all_sections();
    for (const std::uint32_t id :
         {kProvSection, kBasiSection, kPrimSection, kTranSection, kMeshSection, kImagSection}) {
        files.push_back({"primitives", tests::make_small_asset(), id, 0, 0, 0, 0});
    }
    for (const Section& section : files) {
        SCOPED_TRACE(section.name);
        AlignedBytes stored(encode(section.asset));
        const auto table = read_section_table(stored.bytes(), "a.opal");
        ASSERT_TRUE(table);
        const SectionEntry entry = tests::section_of(*table, section.id);
        for (std::uint64_t i = 0; i < entry.stored_size; ++i) {
            std::byte& byte = stored.bytes()[entry.offset + i];
            byte ^= std::byte{0x40};
            ASSERT_FALSE(read_opal(stored.bytes(), "a.opal", Checks::full)) << "byte " << i;
            byte ^= std::byte{0x40};
        }
        EXPECT_TRUE(read_opal(stored.bytes(), "a.opal", Checks::full));
    }
}

// Damage that keeps its checksum is what a hostile writer makes.
TEST(SectionDamage, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    for (const Section& section : all_sections()) {
        SCOPED_TRACE(section.name);
        const std::vector<std::byte> whole = encode(section.asset);
        AlignedBytes sound(whole);
        const auto table = read_section_table(sound.bytes(), "a.opal");
        ASSERT_TRUE(table);
        const SectionEntry entry = tests::section_of(*table, section.id);
        std::size_t refused = 0, accepted = 0, refused_for_values = 0;
        for (std::uint64_t i = 0; i < entry.stored_size; ++i) {
            const bool decides = i < section.record_bytes;
            for (const int bit : decides ? std::vector{0, 2, 4, 7} : std::vector{int(i % 8)}) {
                AlignedBytes stored(whole);
                stored.bytes()[entry.offset + i] ^= static_cast<std::byte>(1 << bit);
                const auto loaded = read_opal(stored.bytes(), "a.opal");
                tests::repair_checksums(stored.bytes(), section.id);
                const bool is_sound = read_opal(stored.bytes(), "a.opal", Checks::full).has_value();
                if (!loaded) {
                    EXPECT_FALSE(is_sound);
                    ++refused;
                    continue;
                }
                use(loaded->view);
                ++accepted;
                refused_for_values += is_sound ? 0 : 1;
            }
        }
        EXPECT_GE(refused, section.refused);
        EXPECT_GE(accepted, section.accepted);
        EXPECT_GE(refused_for_values, section.refused_for_values);
    }
}

// The table of sections and all of a file of primitives.
TEST(SectionDamage, ConsistentlyForgedFilesAreRefusedOrStayInBounds) {
    Asset plain = tests::make_small_asset();
    tests::add_translucent_triangle(plain, 4, 1.3f, false, 1);
    Asset shared = plain;
    tests::add_gloss(shared);
    shared = tests::with_copied_corners(shared);
    for (const Asset* const asset : {&plain, &shared}) {
        const std::vector<std::byte> whole = encode(*asset);
        std::size_t refused = 0, accepted = 0;
        for (std::size_t at = sizeof(FileHeader); at < whole.size(); ++at) {
            for (const int bit : {0, 3, 7}) {
                AlignedBytes stored(whole);
                stored.bytes()[at] ^= static_cast<std::byte>(1 << bit);
                tests::repair_checksums(stored.bytes(), 0);  // of the table alone
                const auto loaded = read_opal(stored.bytes(), "a.opal");
                ++(loaded ? accepted : refused);
                if (loaded) use(loaded->view);
            }
        }
        EXPECT_GT(refused, 100u);
        EXPECT_GT(accepted, 100u);
    }
}

// All counts at once, as no single bit makes them.
TEST(SectionDamage, CountsWhoseProductsOverflowAreRefused) {
    const std::vector<std::uint32_t> huge{0xffffffffu, 0x80000000u, 0x10000u, 7u};
    const auto expect_refused = [](const std::function<void(LayerRecord&)>& change) {
        EXPECT_NE(tests::fault_after(tests::make_cloud_asset(),
                                     [&](Asset& asset) { change(asset.clouds.records[0]); }),
                  "");
    };
    for (const std::uint32_t a : huge) {
        expect_refused([=](LayerRecord& l) { l.phase_angles = a; });
        for (const std::uint32_t b : huge) {
            SCOPED_TRACE(std::to_string(a) + ' ' + std::to_string(b));
            expect_refused([=](LayerRecord& l) { l.frames = a, l.columns = b; });
            expect_refused([=](LayerRecord& l) {
                l.radiance_depths = l.radiance_modes = a, l.radiance_cosines = b;
            });
            expect_refused([=](LayerRecord& l) { l.flux_depths = a, l.flux_cosines = b; });
            expect_refused([=](LayerRecord& l) { l.glow_angles = a, l.glow_events = b; });
        }
    }
}

}  // namespace
}  // namespace opaline::formats
