#include "tests/fuzz/seeds.h"

#include <algorithm>
#include <span>

#include "bake/cli/view/view_script.h"
#include "formats/image/png.h"
#include "formats/opal/write_opal.h"
#include "formats/vdb/reply.h"
#include "tests/formats/gltf/compressed_sheets.h"
#include "tests/formats/gltf/encode_test_image.h"
#include "tests/formats/image/image_files.h"
#include "tests/formats/media/media_text.h"
#include "tests/formats/opal/cloud_fixture.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/formats/opal/glow_fixture.h"
#include "tests/formats/opal/hole_fixture.h"
#include "tests/formats/opal/normal_map_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/receiver_error_fixture.h"
#include "tests/formats/opal/slot_fixture.h"
#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/temporary_folder.h"

namespace opaline::fuzz {
namespace {

using tests::Blob;
using Seeds = std::vector<std::string>;

template <class Bytes>
std::string text_of_bytes(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// All bytes that come to be at a path.
template <class Write>
std::string bytes_written(Write&& write) {
    const tests::TemporaryFolder folder;
    write(folder / "seed");
    return tests::read_bytes(folder / "seed");
}

std::string opal_file(const formats::Asset& asset, formats::Compression compression) {
    return bytes_written([&](const std::filesystem::path& path) {
        auto file = formats::AtomicFile::create(path);
        (void)formats::write_opal_bytes(asset.view(), *file, {}, compression);
        (void)file->commit();
    });
}

Seeds opal_seeds() {
    formats::Asset rich = tests::make_small_asset();
    tests::add_translucent_triangle(rich, 4, 1.3f);
    tests::add_translucent_triangle(rich, 5, 0.8f, true, 1);
    tests::add_sheet_triangle(rich);
    tests::add_opaque_gloss(rich);
    formats::Asset refined = tests::make_small_asset(16);
    refined.added.count = {1, 2};
    refined.added.vertex = {
        {{0, 1, 2}, {0.5f, 0.5f}}, {{0, 1, 1}, {0.25f, 0}}, {{1, 0, 0}, {1, 0}}};
    Seeds seeds;
    for (const formats::Asset& asset :
         {rich, tests::with_copied_corners(rich), tests::with_two_copies(rich), refined,
          tests::make_cloud_asset(),
          tests::make_cloud_asset({.has_peak = false, .has_radiance = false}),
          tests::make_emitter_asset(), tests::make_glow_asset(), tests::make_hole_asset(),
          tests::make_normal_map_asset(), tests::make_mapped_sheet_asset(),
          tests::make_volume_asset()}) {
        seeds.push_back(opal_file(asset, formats::Compression::none));
    }
    seeds.push_back(opal_file(rich, formats::Compression::fast));
    seeds.push_back(text_of_bytes(tests::encode_with_errors(tests::make_receiver_errors())));
    return seeds;
}

Seeds gltf_seeds() {
    tests::AssetBuilder clear = tests::asset_with_extensions(tests::scattering_extensions());
    clear.json["extensions"]["OPALINE_media"] = tests::Json::parse(tests::kRichMedia);
    tests::AssetBuilder painted = tests::textured_triangle(
        {{"name", "Paint"},
         {"normalTexture", {{"index", 0u}, {"scale", 0.5}}},
         {"emissiveTexture", {{"index", 0u}}},
         {"alphaMode", "BLEND"},
         {"extensions",
          {{"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}}},
           {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}},
           {"KHR_materials_ior", {{"ior", 1.4}}},
           {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.4}}}}},
         {"pbrMetallicRoughness",
          {{"metallicFactor", 0},
           {"metallicRoughnessTexture", {{"index", 0u}}},
           {"baseColorTexture",
            {{"index", 0u},
             {"extensions",
              {{"KHR_texture_transform", {{"scale", {2, 2}}, {"rotation", 1}}}}}}}}}});
    tests::add_texture(painted, tests::encode_png({255, 0, 0, 255, 0, 128, 255, 64}, 2, 1));
    Seeds seeds;
    for (const tests::AssetBuilder& asset :
         {tests::rich_asset(), clear, painted, tests::meshopt_sheet(),
          tests::draco_sheet(tests::DracoMethod::sequential),
          tests::draco_sheet(tests::DracoMethod::edgebreaker)}) {
        seeds.push_back(text_of_bytes(asset.glb()));
    }
    seeds.push_back(tests::triangle_asset().text());
    return seeds;
}

Seeds exr_seeds() {
    using namespace formats;
    Seeds seeds;
    for (const int compression : {0, 1, 3, 4, 5, 7, 9}) {
        seeds.push_back(make_exr(ramp(12, 6), {.compression = compression, .is_half = true}));
    }
    seeds.push_back(make_exr(ramp(24, 20), {.is_tiled = true}));
    seeds.push_back(make_exr_of_parts(ramp(4, 3)));
    seeds.push_back(make_exr(ramp(3, 18), {.is_grey = true, .envmap = Envmap::cube}));
    return seeds;
}

Seeds hdr_seeds() {
    std::string rows;
    for (int row = 0; row < 4; ++row) {
        rows += {2, 2, 0, 8};
        for (int component = 0; component < 4; ++component) {
            rows += {static_cast<char>(-124), static_cast<char>(100 + component), 4, 1, 2, 3, 4};
        }
    }
    std::string flat;
    for (int pixel = 0; pixel < 6; ++pixel) {
        flat += {static_cast<char>(90 + pixel), 50, 7, static_cast<char>(-127)};
    }
    return {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 4 +X 8\n" + rows,
            "#?RGBE\n\n+X 3 -Y 4\n" + flat + std::string{1, 1, 1, 6}};
}

Seeds png_seeds() {
    const Blob pixels(80, 77);
    formats::Image8 image{5, 4, std::vector<std::uint8_t>(80, 77)};
    return {*formats::encode_png(image, "seed"),
            text_of_bytes(tests::encode_png(pixels, 5, 4, tests::TestImage::rgba)),
            text_of_bytes(tests::encode_png(pixels, 20, 4, tests::TestImage::grey))};
}

std::string vdb_file(const tests::FileOptions& options) {
    return bytes_written([&](const std::filesystem::path& path) {
        tests::write_file(path,
                          {{.values = tests::Values::half,
                            .voxels = tests::box_of_voxels({-3, 2, 0}, {6, 7, 5}),
                            .tiles = {{1, {64, 0, 0}, glm::vec3(1)}}},
                           {.name = "Cd",
                            .values = tests::Values::color,
                            .voxels = tests::box_of_voxels({0, 0, 0}, {2, 2, 2})}},
                          options);
    });
}

Seeds vdb_reply_seeds() {
    const auto written = [](const std::function<void(formats::vdb::ReplyWriter&)>& write) {
        return bytes_written([&](const std::filesystem::path& path) {
            const int file = ::open(path.c_str(), O_CREAT | O_WRONLY, 0600);
            formats::vdb::ReplyWriter writer(file);
            write(writer);
            ::close(file);
        });
    };
    return {written([](formats::vdb::ReplyWriter& writer) {
                formats::vdb::GridHead head{
                    .active_voxels = 9, .extent = {2, 1, 1}, .bricks = 1, .is_color = 0};
                for (const int i : {0, 5, 10, 15}) {
                    head.to_scene[i] = 1;
                }
                writer.write_grid("density", head);
                writer.write_brick(1, std::vector<float>(512, 0.5f));
                writer.write_end(std::vector<std::string>{"vel"});
            }),
            written([](formats::vdb::ReplyWriter& writer) {
                writer.write_fault({"grid 'a'", "is a level set", "convert it"});
            })};
}

Seeds script_seeds() {
    return {
        "light sky:3,35  # a clear day\nrotate-light 370\nexposure -1.5\ntone-map none\n"
        "toggle specular\ncoefficients 32\nemitter \"Desk lamp=1,0.5,0\"\ntime 60\n"
        "beside b.opal\nsplit 0.25\ndifference 8\nreceiver-errors 0.05\ntoggle panels\n"
        "orbit 90 0\nzoom 2\npan 0.1 0.2\nturn 0 0 1 1\nlevel\nframe\nexposure auto\n"
        "terms multiple,single\ndrop a.exr\nload c.opal\nwait-frames 3\nwait-reload\n"
        "screenshot a.png\nphotograph b.png\nquit\n",
        cli::script_help()};
}

// Arguments in lines.
Seeds command_seeds() {
    return {
        "any\na.opal\nb.opal\n--real\n0.5\n--above=3\n--length\n550nm\n--lengths\n1,2um,3mm",
        "any\na.opal\n--list=1,2,3\n--text\na\n--text=b\n--terms\nall\n--choice\nfast\n--seed\n7",
        "any\n-f\na.opal\n--threads=2\n--memory-limit\n1000000\n--\n-x",
        "any\n--help",
        "--version",
        "rendr\n--sead\n3",
        "any\na.opal\n--choice\nfastt\n-f"};
}

}  // namespace

std::vector<std::string> make_seeds(std::string_view target) {
    if (target.starts_with("opal")) return opal_seeds();
    if (target == "gltf") return gltf_seeds();
    if (target == "exr") return exr_seeds();
    if (target == "hdr") return hdr_seeds();
    if (target == "png") return png_seeds();
    if (target == "texture") {
        Seeds seeds = png_seeds();
        seeds.push_back(text_of_bytes(tests::encode_jpeg(100, 16)));
        return seeds;
    }
    if (target == "media") return {tests::kRichMedia};
    if (target == "phase_table")
        return {"cosine,value\n-1,0.5\n0,0.25  # side\n1,3\n", "-1 1\n1;1"};
    if (target == "vdb") {
        return {vdb_file({}), vdb_file({.has_offsets = false}), vdb_file({.is_compressed = false})};
    }
    if (target == "vdb_reply") return vdb_reply_seeds();
    if (target == "view_script") return script_seeds();
    if (target == "relight_table") {
        return {"primitive,vertex,r,g,b\n0,0,1,0.5,2e-3\n1,7,0,0,0\n",
                "primitive,vertex,r,g,b,se\r\n0,0,1,0.5,2,9\r\n"};
    }
    return command_seeds();
}

}  // namespace opaline::fuzz
