#include <cmath>
#include <fstream>
#include <string>

#include "formats/gltf/import_gltf.h"
#include "formats/gltf/report.h"
#include "formats/media/apply_media.h"
#include "formats/media/load_clouds.h"
#include "formats/media/read_media.h"
#include "formats/media/read_phase.h"
#include "tests/formats/media/cloud_text.h"
#include "tests/formats/media/media_text.h"
#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"

namespace opaline::fuzz {
namespace {

// The input as the only file of a folder.
std::filesystem::path write_input(const char* name, std::span<const std::byte> bytes) {
    static const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
}

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_within(formats::Rgb c, float most) {
    return c.r >= 0 && c.r <= most && c.g >= 0 && c.g <= most && c.b >= 0 && c.b <= most;
}

// What every accepted scene promises to the baker.
void expect_sound(const formats::Scene& scene) {
    hold(!scene.materials.empty(), "there is a material");
    for (const formats::Material& m : scene.materials) {
        hold(is_within(m.emission, 1e12f), "emission is finite and not negative");
        hold(m.alpha >= 0 && m.alpha <= 1 && m.alpha_cutoff >= 0, "alpha is a share");
        hold(!m.medium || tests::is_sound(*m.medium), "a medium of a scene is sound");
    }
    for (const auto& light : scene.lights) {
        hold(!light.name.empty() && is_within(light.intensity, 1e12f), "a lamp has light");
        hold(is_finite(light.position), "a lamp is somewhere");
        hold(std::abs(glm::length(light.direction) - 1.0f) < 1e-5f, "its direction is a unit");
        hold(light.range >= 0 && std::isfinite(light.range), "its range is finite");
        hold(0 <= light.inner_cone && light.inner_cone < light.outer_cone &&
                 light.outer_cone <= 1.5707964f,
             "its cones are in order");
    }
    for (const auto& p : scene.primitives) {
        const std::size_t vertices = p.position.size();
        hold(p.material < scene.materials.size(), "a primitive has a material");
        hold(p.normal.size() == vertices, "a vertex has a normal");
        hold(p.texcoord.empty() || p.texcoord.size() == vertices, "or a texture coordinate");
        hold(p.color.empty() || p.color.size() == vertices, "or a colour");
        hold(p.index.size() % 3 == 0, "indices are of triangles");
        for (std::size_t v = 0; v < vertices; ++v) {
            hold(is_finite(p.position[v]), "a vertex is somewhere");
            const float length = glm::length(p.normal[v]);
            hold(length == 0.0f || std::abs(length - 1.0f) < 1e-5f, "a normal is a unit, or none");
        }
        for (const auto i : p.index) {
            hold(i < vertices, "an index is of a vertex");
        }
    }
}

void expect_sound(const formats::MediaFile& media) {
    for (const formats::MaterialMedium& material : media.materials) {
        hold(!material.medium || tests::is_sound(*material.medium), "a medium of a file is sound");
    }
    for (const formats::CloudEntry& cloud : media.clouds) {
        hold(tests::is_sound(cloud), "a layer of a file is sound");
    }
}

}  // namespace

void run_gltf(std::span<const std::byte> bytes) {
    formats::ImportOptions options;
    // As the program refuses what does not fit into memory.
    options.check_size = [](const formats::SceneCounts& counts) {
        const bool fits = counts.vertices <= 200'000 && counts.indices <= 1'000'000;
        return fits ? formats::ok_status()
                    : formats::Status(formats::make_error(formats::ErrorKind::resource, "x.glb", "",
                                                          "is too large"));
    };
    options.smooth_angle = bytes.size() % 2 == 0 ? 0 : 30;
    const std::filesystem::path path = write_input("scene.glb", bytes);
    auto imported = formats::import_gltf(path, options);
    if (!imported) return expect_message(imported.error());
    expect_sound(imported->scene);
    if (imported->media.empty()) return;
    const auto media = formats::parse_media(imported->media, path, "OPALINE_media");
    if (!media) return expect_message(media.error());
    expect_sound(*media);
    const auto applied = formats::apply_media(*media, imported->scene);
    if (!applied) return expect_message(applied.error());
    expect_sound(imported->scene);
}

void run_media(std::span<const std::byte> bytes) {
    const auto media = formats::read_media(write_input("media.json", bytes));
    if (!media) return expect_message(media.error());
    expect_sound(*media);
    formats::Scene scene;
    scene.materials.resize(1);
    scene.materials[0].name = "Wax";
    const auto applied = formats::apply_media(*media, scene);
    if (!applied) return expect_message(applied.error());
    expect_sound(scene);
    const auto clouds = formats::load_clouds(*media, scene, formats::CloudDetail::largest);
    if (!clouds) expect_message(clouds.error());
}

void run_phase_table(std::span<const std::byte> bytes) {
    formats::gltf::Report report;
    report.file = "x.csv";
    const auto phase = formats::media::parse_phase_table(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "table", report);
    if (!phase) return expect_message(report.take_error());
    hold(phase->cosine.size() == phase->value.size() && phase->cosine.size() >= 2, "rows");
    hold(phase->cosine.front() == -1 && phase->cosine.back() == 1, "rows from -1 to 1");
    for (std::size_t i = 0; i < phase->cosine.size(); ++i) {
        hold(i == 0 || phase->cosine[i - 1] < phase->cosine[i], "cosines ascend");
        hold(std::isfinite(phase->value[i]) && phase->value[i] >= 0, "values are densities");
    }
    hold(std::abs(phase->g) <= 0.99f, "a mean cosine below 1");
}

}  // namespace opaline::fuzz
