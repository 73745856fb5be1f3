#include "runtime/gl/gl_volume_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/picture/volume_pass.h"
#include "runtime/volumes/suns.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of volumes.frag.glsl.
enum Uniform : GLint {
    kSupersampling,
    kTileOrigin,
    kToPlane,
    kRight,
    kDown,
    kForward,
    kNearPlane,
    kSuns,
    kEyeAboveGround = kSuns + static_cast<GLint>(kMaxSuns),  // with a layer
    kUnitsOfMetre
};
static_assert(kEyeAboveGround == 15);

// Volume of volume_march.glsl.
struct ShaderVolume {
    std::array<std::array<float, 4>, 3> to_bricks{};
    std::array<std::uint32_t, 4> extent_first{}, numbers{};
    std::array<float, 4> extinction{}, albedo{};
    std::array<std::uint32_t, 4> coefficient{};
};
static_assert(sizeof(ShaderVolume) == 128);

// The way from the camera into the table, in shader units. False where floats cannot hold it.
bool set_way(const VolumeLattice& lattice, const Camera& camera, ShaderVolume& volume) {
    const double unit = view_unit(camera);
    const auto eye = index_of_point(lattice, camera.eye);
    bool is_finite = true;
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t c = 0; c < 3; ++c) {
            volume.to_bricks[a][c] =
                static_cast<float>(lattice.to_index[4 * a + c] / formats::kBrickSide / unit);
        }
        volume.to_bricks[a][3] =
            static_cast<float>(eye[a] / formats::kBrickSide - lattice.record->first_brick[a]);
        is_finite = is_finite && std::ranges::all_of(volume.to_bricks[a],
                                                     [](float x) { return std::isfinite(x); });
    }
    return is_finite;
}

ShaderVolume shader_volume(const GlVolumes& volumes, const GlVolumes::Entry& entry,
                           const Camera& camera) {
    const formats::VolumeRecord& record = *entry.lattice.record;
    const VolumeLight::Part& part = volumes.light.part[entry.volume];
    ShaderVolume volume;
    // Without cells it is nowhere.
    if (!set_way(entry.lattice, camera, volume)) return {};
    volume.extent_first = {record.extent[0], record.extent[1], record.extent[2],
                           static_cast<std::uint32_t>(record.first_cell)};
    volume.numbers = {record.first_brick_number, static_cast<std::uint32_t>(record.first_corner),
                      record.corners_along_edge() - 1, part.terms};
    const auto per_unit = [&](float sigma) {
        return static_cast<float>(std::min(static_cast<double>(sigma) / view_unit(camera), 1e30));
    };
    volume.extinction = {per_unit(record.sigma_t.r), per_unit(record.sigma_t.g),
                         per_unit(record.sigma_t.b), 0};
    volume.albedo = {record.albedo.r, record.albedo.g, record.albedo.b, 0};
    volume.coefficient = {static_cast<std::uint32_t>(3 * part.first), part.suns,
                          static_cast<std::uint32_t>(formats::kPhaseEntries * entry.volume), 0};
    return volume;
}

}  // namespace

formats::Result<GlProgram> make_volume_program(const GlVolumes& volumes, bool layer) {
    const std::string text = std::string(volume_march_text) + volumes_frag_text;
    const std::array<StageSource, 2> stages{
        {{GL_VERTEX_SHADER, screen_vert_text}, {GL_FRAGMENT_SHADER, text.c_str()}}};
    return make_program("volumes",
                        "#define VOLUMES " + std::to_string(volumes.entry.size()) +
                            "\n#define HARMONICS " + std::to_string(volumes.harmonics) +
                            "\n#define SUNS " + std::to_string(kMaxSuns) +
                            "\n#define BRICK_WORDS " + std::to_string(kGlBrickWords) +
                            "\n#define LAYER " + (layer ? "1" : "0") +
                            "\n#define SHEET_TOLERANCE " + std::to_string(kSheetTolerance) + "\n",
                        stages);
}

void draw_volumes_filtered(const DrawScene& scene, const GlProgram& program, const TileView& view) {
    const CameraFrame& frame = view.frame;
    const TileGrid& grid = view.grid;
    std::vector<ShaderVolume> records;
    for (const GlVolumes::Entry& entry : scene.volumes.entry) {
        records.push_back(shader_volume(scene.volumes, entry, scene.camera));
    }
    std::size_t size = 0;
    const GlBuffer buffer = make_buffer_of(std::span<const ShaderVolume>(records), size);
    const std::array<const GlBuffer*, 6> buffers{&buffer,
                                                 &scene.volumes.table,
                                                 &scene.volumes.density,
                                                 &scene.volumes.corner,
                                                 &scene.volumes.coefficient,
                                                 &scene.volumes.phase};
    for (GLuint i = 0; i < buffers.size(); ++i) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]->name());
    }
    const GLuint name = program.name();
    glUseProgram(name);
    glUniform1i(kSupersampling, static_cast<GLint>(scene.supersampling));
    glUniform2f(kTileOrigin, grid.first_column, grid.first_row);
    glUniform2f(kToPlane, 2.0f / grid.columns, 2.0f / grid.rows);
    set_vec3(name, kRight, static_cast<float>(frame.tan_half_x) * frame.right);
    set_vec3(name, kDown, static_cast<float>(-frame.tan_half_y) * frame.up);
    set_vec3(name, kForward, -1.0f * frame.backward);
    const std::vector<formats::Vec3>& suns = scene.volumes.light.sun;
    if (!suns.empty()) glUniform3fv(kSuns, static_cast<GLsizei>(suns.size()), &suns.front().x);
    glUniform1f(kNearPlane, static_cast<float>(view_unit(scene.camera) *
                                               static_cast<double>(scene.camera.near_plane)));
    if (scene.layers.shown) {
        const double height = static_cast<double>(scene.camera.eye.y) - scene.layers.ground_height;
        const double unit = view_unit(scene.camera);
        glUniform1f(kEyeAboveGround, static_cast<float>(unit * height));
        glUniform1f(kUnitsOfMetre, static_cast<float>(unit));
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace opaline::runtime
