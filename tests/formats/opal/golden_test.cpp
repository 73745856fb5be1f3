// Files of every section version that was ever released: today's reader reads them for ever.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/half.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/receiver_errors.h"
#include "formats/opal/sheet_shares.h"

namespace opaline::formats {
namespace {

// The sum of a primitive's or a volume's last row in one band, and its sum weighted with the
// coefficient's number modulo 17.
struct RowSum {
    std::size_t primitive;  // or volume
    std::uint32_t band;
    double sum, weighted;
};

void expect_sums(const SparseRowsView& rows, const RowRange& range, const RowSum& row) {
    std::vector<float> dense(cubemap_texels(rows.cubemap_size));
    decode_row(rows, range, range.rows - 1, row.band, dense);
    double sum = 0, weighted = 0;
    for (std::size_t i = 0; i < dense.size(); ++i) {
        sum += dense[i];
        weighted += dense[i] * static_cast<double>(i % 17);
    }
    EXPECT_NEAR(sum, row.sum, 1e-5) << row.primitive << ' ' << row.band;
    EXPECT_NEAR(weighted, row.weighted, 1e-4) << row.primitive << ' ' << row.band;
}

struct Golden {
    const char* name;
    std::uint32_t prim, tran, receivers;
    std::vector<RowSum> rows;
};

class GoldenFile : public testing::Test {
  protected:
    const AssetView& read(const std::string& name) {
        auto file = FileBytes::open(std::string(OPALINE_SOURCE_DIR) + "/tests/data/golden/" + name);
        EXPECT_TRUE(file) << name;
        file_.emplace(std::move(*file));
        auto loaded = read_opal(file_->bytes(), name, Checks::full);
        EXPECT_TRUE(loaded) << name << ": " << loaded.error().diagnostics.front().fault;
        loaded_.emplace(std::move(*loaded));
        return loaded_->view;
    }
    std::uint32_t version_of(std::uint32_t id) const {
        for (const SectionEntry& section : loaded_->sections) {
            if (section.id == id) return section.version;
        }
        return 0;
    }
    std::optional<FileBytes> file_;
    std::optional<LoadedAsset> loaded_;
};

TEST_F(GoldenFile, TransportHasTheValuesItHadWhenItWasWritten) {
    const RowSum grey{0, 0, 2.094714, 30.58194}, red{1, 0, 4.867499, 21.49634},
        blue{1, 2, 5.099615, 18.19239};
    const RowSum medium{2, 0, -1.861943, -7.296338}, medium_blue{2, 2, -0.9062569, -1.010991};
    const std::vector<Golden> files{
        {"prim1-tran2.opal", 1, 2, 8, {grey, red, blue}},
        {"prim2-codes16.opal",
         2,
         2,
         11,
         {{0, 0, 2.070188, 30.40623},
          {1, 0, 4.853886, 21.39535},
          {1, 2, 5.096532, 18.14928},
          {2, 0, 1.125904, 3.778791}}},
        {"prim3.opal", 3, 2, 11, {grey, red, blue, medium, medium_blue}},
        {"spec1.opal", 1, 2, 11, {grey, red, blue, medium, medium_blue}},
        {"glos1.opal", 1, 2, 8, {grey, red, blue}},
        {"index4.opal", 1, 2, 3, {{0, 0, 3.601584, 21.70784}}},
    };
    for (const Golden& golden : files) {
        SCOPED_TRACE(golden.name);
        const AssetView& asset = read(golden.name);
        EXPECT_EQ(version_of(kPrimSection), golden.prim);
        EXPECT_EQ(version_of(kTranSection), golden.tran);
        ASSERT_EQ(asset.receivers(), golden.receivers);
        for (const RowSum& row : golden.rows) {
            expect_sums(asset.transport, asset.rows_of(row.primitive), row);
        }
    }
}

TEST_F(GoldenFile, MeshImagesAndFlagsToo) {
    {
        const AssetView& asset = read("prim1-tran2.opal");
        EXPECT_EQ(asset.provenance, R"({"generator":"test"})");
        EXPECT_EQ(asset.cubemap_size, 8u);
        EXPECT_EQ(asset.position[7], (Vec3{1, 1, 1}));
        EXPECT_EQ(asset.base_color[3], (Rgb{0.5f, 0.6f, 0.7f}));
        EXPECT_EQ(asset.index[10], 3u);
        ASSERT_EQ(asset.images.size(), 1u);
        EXPECT_EQ(asset.images[0].rgb[4], 255);
        EXPECT_EQ(asset.primitives[1].base_color_image, 0u);
    }
    EXPECT_TRUE(read("prim2-codes16.opal").primitives[2].is_separate());
    EXPECT_EQ(loaded_->view.primitives[2].bands, 1u);
    EXPECT_EQ(loaded_->view.primitives[2].eta, 1.3f);
    EXPECT_EQ(loaded_->view.transport.code_bits, 16u);
    EXPECT_TRUE(read("prim3.opal").primitives[2].is_single_only());
    EXPECT_EQ(read("index4.opal").transport.index_bytes, 4u);
}

TEST_F(GoldenFile, SpecularReflectionToo) {
    {
        const AssetView& asset = read("spec1.opal");
        EXPECT_EQ(version_of(kSpecSection), 1u);
        EXPECT_EQ(asset.roughness[1], kNotGlossy);
        EXPECT_EQ(asset.roughness[2], 0.3f);
        EXPECT_EQ(asset.openness[10].fraction, 255);
        EXPECT_EQ(asset.openness[10].axis[0], 21);
        EXPECT_TRUE(asset.gloss.empty());
    }
    const AssetView& asset = read("glos1.opal");
    EXPECT_EQ(version_of(kGlosSection), 1u);
    ASSERT_EQ(asset.gloss.size(), 2u);
    const GlossRecord &metal = asset.gloss[0], &plastic = asset.gloss[1];
    EXPECT_EQ(metal.metallic, 1);
    EXPECT_EQ(metal.roughness, 0.75f);
    EXPECT_EQ(metal.image, 0u);
    EXPECT_EQ(metal.wrap_v, Wrap::mirror);
    EXPECT_EQ(plastic.metallic, 0);
    EXPECT_EQ(plastic.roughness, 0.25f);
    EXPECT_EQ(plastic.f0, (Rgb{0.04f, 0.05f, 0.06f}));
    EXPECT_EQ(plastic.f90, 0.5f);
    EXPECT_EQ(plastic.image, kNoImage);
}

TEST_F(GoldenFile, VolumesToo) {
    const AssetView& asset = read("volu1.opal");
    EXPECT_EQ(version_of(kVoluSection), 1u);
    EXPECT_TRUE(asset.primitives.empty() && asset.position.empty());
    const VolumesView& volumes = asset.volumes;
    ASSERT_EQ(volumes.records.size(), 2u);
    EXPECT_EQ(volumes.records[0].spacing, 4u);
    EXPECT_EQ(volumes.records[0].to_world[6], -0.2f);
    EXPECT_EQ(volumes.records[0].moment[1], 0.6f);
    EXPECT_EQ(volumes.records[1].first_brick, (std::array<std::int32_t, 3>{-1, 0, 2}));
    EXPECT_EQ(volumes.records[1].bands, 3u);
    EXPECT_EQ(volumes.records[1].sigma_t, (Rgb{1, 2, 3.5f}));
    EXPECT_EQ(volumes.table[1], 0u);
    EXPECT_EQ(volumes.table[2], kNoBrick);
    EXPECT_FLOAT_EQ(volumes.density_scale[2], 1.8026969e-05f);
    EXPECT_EQ(volumes.density[2 * kBrickVoxels + 511], 32910);
    EXPECT_EQ(volumes.corner[2], kNoNode);
    EXPECT_EQ(volumes.node[1], (NodeVoxel{4, 0, 16}));
    EXPECT_FLOAT_EQ(volumes.phase_of(1)[0], 0.03978874f);
    EXPECT_FLOAT_EQ(volumes.phase_of(1)[192], 0.10941903f);
    for (const RowSum& row : {RowSum{0, 0, 2.964527, 24.95635}, RowSum{1, 0, 2.465866, 10.08604},
                              RowSum{1, 2, 3.55175, 17.96101}}) {
        expect_sums(volumes.rows, volumes.records[row.primitive].rows(), row);
    }
}

TEST_F(GoldenFile, EmittersToo) {
    const AssetView& asset = read("emit1.opal");
    EXPECT_EQ(version_of(kEmitSection), 1u);
    const EmittersView& emitters = asset.emitters;
    EXPECT_EQ(list_emitters(emitters), "'Lamp', 'Panel'");
    ASSERT_EQ(emitters.block.size(), 3u);
    EXPECT_EQ(emitters.block[2].emitter, 1u);
    EXPECT_EQ(emitters.block[2].primitive, 1u);
    EXPECT_EQ(emitters.block[2].scale, 0.001953125f);
    EXPECT_EQ(block_value(emitters, emitters.block[2], 3),
              (Rgb{5.44140625f, 0.266845703f, 38.03125f}));
    ASSERT_EQ(emitters.own.size(), 1u);
    EXPECT_EQ(emitters.own[0].radiance, (Rgb{100, 50, 25}));
    EXPECT_EQ(emitters.own[0].image, 0u);
    EXPECT_EQ(emitters.own[0].wrap_u, Wrap::mirror);
}

TEST_F(GoldenFile, LightOfVolumesToo) {
    const AssetView& asset = read("glow1.opal");
    EXPECT_EQ(version_of(kGlowSection), 1u);
    EXPECT_EQ(version_of(kVoluSection), 1u);
    EXPECT_EQ(list_emitters(asset.emitters), "'Fire'");
    const GlowView& glow = asset.volumes.glow;
    ASSERT_EQ(glow.record.size(), 2u);
    EXPECT_EQ(glow.record[0].terms, 4u);
    EXPECT_EQ(glow.record[0].value_scale, 0.25f);
    EXPECT_EQ(glow.record[0].code_scale, 2);
    EXPECT_EQ(glow.record[1].volume, 1u);
    EXPECT_EQ(glow.record[1].brick_count, 0u);
    ASSERT_EQ(glow.brick.size(), 1u);
    EXPECT_EQ(glow.brick[0], 1u);
    ASSERT_EQ(glow.code.size(), kBrickVoxels);
    EXPECT_EQ(unpack_shared(glow.code[17]), (Rgb{27.875f, 15.375f, 34.5f}));
    EXPECT_EQ(float_from_half(glow.value[glow.record[1].first_value + 2]), 41120);
}

TEST_F(GoldenFile, HolesToo) {
    const HolesView& holes = read("hole1.opal").holes;
    EXPECT_EQ(version_of(kHoleSection), 1u);
    ASSERT_EQ(holes.record.size(), 2u);
    EXPECT_EQ(holes.record[0].mode, HoleMode::blend);
    EXPECT_EQ(holes.record[0].alpha, 0.25f);
    EXPECT_EQ(holes.record[0].image, kNoImage);
    EXPECT_EQ(holes.record[1].primitive, 1u);
    EXPECT_EQ(holes.record[1].image, 0u);
    EXPECT_EQ(holes.record[1].wrap_v, Wrap::mirror);
    EXPECT_EQ(holes.record[1].cutoff, 0.75f);
    ASSERT_EQ(holes.vertex_alpha.size(), 8u);
    EXPECT_EQ(holes.vertex_alpha[3], 0.75f);
}

TEST_F(GoldenFile, NormalMapsToo) {
    const NormalMapsView& maps = read("norm1.opal").normal_maps;
    EXPECT_EQ(version_of(kNormSection), 1u);
    ASSERT_EQ(maps.record.size(), 1u);
    EXPECT_EQ(maps.record[0].primitive, 1u);
    EXPECT_EQ(maps.record[0].image, 0u);
    EXPECT_EQ(maps.record[0].wrap_v, Wrap::clamp);
    EXPECT_EQ(maps.record[0].scale, 0.75f);
    ASSERT_EQ(maps.tangent.size(), 8u);
    EXPECT_EQ(decode_tangent(maps.tangent[0]).direction, Vec3{});
    EXPECT_EQ(decode_tangent(maps.tangent[3]).sign, -1);
    EXPECT_NEAR(decode_tangent(maps.tangent[3]).direction.x, -0.98999f, 1e-4f);
    EXPECT_NEAR(decode_tangent(maps.tangent[3]).direction.z, 0.14112f, 1e-4f);
}

TEST_F(GoldenFile, SharesOfMappedSheetsToo) {
    const NormalMapsView& maps = read("norm2.opal").normal_maps;
    EXPECT_EQ(version_of(kNormSection), 2u);
    ASSERT_EQ(maps.record.size(), 1u);
    EXPECT_EQ(maps.record[0].scale, 0.75f);
    EXPECT_EQ(sheet_shares_of(maps.record[0]).transmit, (Rgb{0.25f, 0.75f, 1}));
}

TEST_F(GoldenFile, ErrorsByReceiverToo) {
    read("rerr1.opal");
    EXPECT_EQ(version_of(kRerrSection), 1u);
    const auto errors = read_receiver_errors(file_->bytes(), *loaded_, "rerr1.opal");
    ASSERT_TRUE(errors);
    ASSERT_EQ(errors->size(), 8u);
    EXPECT_EQ((*errors)[0], 0);
    EXPECT_EQ((*errors)[7], 0.109375f);
}

TEST_F(GoldenFile, CloudLayersToo) {
    const AssetView& asset = read("clou1.opal");
    EXPECT_EQ(version_of(kClouSection), 1u);
    EXPECT_TRUE(asset.primitives.empty() && asset.volumes.empty());
    const CloudsView& clouds = asset.clouds;
    ASSERT_EQ(clouds.records.size(), 1u);
    const LayerRecord& layer = clouds.records[0];
    EXPECT_EQ(layer.base, 800);
    EXPECT_EQ(layer.ground, -20);
    EXPECT_EQ(layer.center, (std::array<float, 2>{100, -300}));
    EXPECT_EQ(layer.size, (std::array<float, 2>{4000, 3000}));
    EXPECT_EQ(layer.wind, (std::array<float, 2>{5, -2.5f}));
    EXPECT_EQ(layer.highest, 250);
    EXPECT_EQ(layer.peak_angle, 0.0875f);
    EXPECT_EQ(layer.haze, 1e-4f);
    EXPECT_TRUE(layer.has_radiosity() && !layer.repeats());
    EXPECT_EQ(layer.band[2].kappa, 0.046f);
    EXPECT_EQ(layer.band[1].peak_weight, 0.45f);
    EXPECT_EQ(layer.band[0].g, 0.85f);
    EXPECT_TRUE(layer.loops());
    EXPECT_EQ(layer.frames, 2u);
    EXPECT_EQ(layer.frame_seconds, 90);
    ASSERT_EQ(layer.thickness_count(), 24u);
    EXPECT_EQ(clouds.thickness_of(layer)[11], 26000);
    EXPECT_EQ(clouds.thickness_of(layer)[23], 6518);
    EXPECT_EQ(clouds.ground_of(layer)[5], (std::array<std::uint8_t, 4>{200, 128, 55, 255}));
    const LayerTables tables = tables_of(clouds, layer, 2);
    EXPECT_EQ(tables.log_phase[4], -2.33915567f);
    EXPECT_EQ(tables.glow[5], 15.398654f);
    EXPECT_EQ(tables.t1[0], 0.30265519f);
    EXPECT_EQ(tables.t_ms[2], 1);
    EXPECT_EQ(tables.r1[3], 0.0348787121f);
    EXPECT_EQ(tables.mean_t[3], 0);
    EXPECT_EQ(tables.reflected[35], 0.808276415f);
    EXPECT_EQ(tables.transmitted[35], 0.446365088f);
}

}  // namespace
}  // namespace opaline::formats
