#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "formats/gltf/unlit_glb.h"
#include "formats/opal/emitters.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/receiver_errors.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/opaline.hpp"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "runtime/specular.h"
#include "runtime/volumes/relight_volumes.h"
#include "tests/fuzz/targets.h"

namespace opaline::fuzz {
namespace {

constexpr float kAround[18] = {1, 1, 1, 0, 2, 0, 3, 0, 1,
                               0, 0, 0, 1, 0, 5, 9, 9, 9};  // a texel each

// A copy that ends where its memory does, aligned as files in memory must be.
class Aligned {
  public:
    explicit Aligned(std::span<const std::byte> bytes)
        : size_(bytes.size()),
          data_(static_cast<std::byte*>(
              ::operator new(std::max<std::size_t>(size_, 1), std::align_val_t(64)))) {
        std::copy(bytes.begin(), bytes.end(), data_);
    }
    Aligned(const Aligned&) = delete;
    Aligned& operator=(const Aligned&) = delete;
    ~Aligned() { ::operator delete(data_, std::align_val_t(64)); }
    std::span<const std::byte> bytes() const { return {data_, size_}; }

  private:
    std::size_t size_;
    std::byte* data_;
};

void expect_ok(opaline_status status, const char* promise) {
    if (status != OPALINE_OK) std::fprintf(stderr, "%s\n", opaline_last_error());
    hold(status == OPALINE_OK, promise);
}

void expect_light(const std::vector<float>& values, const char* promise) {
    for (const float value : values) {
        hold(std::isfinite(value) && value >= 0, promise);
    }
}

void ask_about_primitive(const opaline_asset* asset, std::uint32_t number) {
    opaline_primitive_info info{};
    info.struct_size = sizeof info;
    expect_ok(opaline_asset_primitive(asset, number, &info), "a primitive says what it is");
    const std::uint32_t receivers = opaline_asset_receiver_count(asset);
    hold(info.first_receiver <= receivers && info.receiver_count <= receivers - info.first_receiver,
         "a primitive's receivers are the asset's");
    opaline_primitive_shading shading{};
    shading.struct_size = sizeof shading;
    expect_ok(opaline_asset_primitive_shading(asset, number, &shading), "a primitive is shaded");
    hold(std::isfinite(shading.eta), "an index of refraction is finite");
    opaline_primitive_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    expect_ok(opaline_asset_primitive_mesh(asset, number, &mesh), "a primitive has a mesh");
    double sum = 0;
    for (std::size_t i = 0; i < std::size_t{3} * info.receiver_count; ++i) {
        sum += double{mesh.position[i]} + double{mesh.normal[i]} + double{mesh.base_color[i]};
    }
    hold(std::isfinite(sum), "a mesh is finite");
    for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
        hold(mesh.index[i] < info.receiver_count, "an index is of a vertex");
    }
    for (std::uint32_t i = 0; i < mesh.added_count; ++i) {
        const opaline_added_vertex& added = mesh.added[i];
        for (const std::uint32_t corner : added.corner) {
            hold(corner < info.receiver_count - mesh.added_count, "a corner is of the source");
        }
        hold(added.weight[0] >= 0 && added.weight[1] >= 0 &&
                 added.weight[0] + added.weight[1] <= 1 + 1e-5f,
             "weights are of a point of the triangle");
    }
    opaline_primitive_emission emission{};
    emission.struct_size = sizeof emission;
    expect_ok(opaline_asset_primitive_emission(asset, number, &emission), "what it sends out");
    hold(emission.emitter == OPALINE_NO_EMITTER ||
             emission.emitter < opaline_asset_emitter_count(asset),
         "an emitter is the asset's");
}

// Through the corners of its box, and from nowhere to anywhere.
void march_through(const opaline_asset* asset, const opaline_volume_light* light,
                   std::uint32_t number) {
    opaline_volume_info info{};
    info.struct_size = sizeof info;
    expect_ok(opaline_asset_volume(asset, number, &info), "a volume says what it is");
    std::vector<opaline_march_ray> rays;
    std::vector<opaline_sample_point> points;
    for (int corner = 0; corner < 8; ++corner) {
        opaline_march_ray ray{};
        opaline_sample_point point{};
        for (int k = 0; k < 3; ++k) {
            hold(std::isfinite(info.corner[corner][k]), "the corner of a volume is finite");
            // Half way to the opposite corner; finite where both are large, too.
            const float middle = 0.5f * info.corner[corner][k] + 0.5f * info.corner[7 - corner][k];
            ray.origin[k] = info.corner[corner][k];
            ray.direction[k] = middle - info.corner[corner][k];
            point.position[k] = middle;
        }
        ray.direction[corner % 3] += 1e-3f;
        ray.end = INFINITY;
        point.to_eye[corner % 3] = corner < 4 ? 1.0f : -1.0f;
        const bool is_ray = std::isfinite(ray.direction[0]) && std::isfinite(ray.direction[1]) &&
                            std::isfinite(ray.direction[2]);
        if (is_ray) rays.push_back(ray);
        points.push_back(point);
    }
    std::vector<opaline_march_result> seen(rays.size());
    opaline_march_options options{};
    options.struct_size = sizeof options;
    options.step = 2;
    options.least_transmittance = 0.01f;
    options.threads = 1;
    expect_ok(opaline_volumes_march(asset, light, &options, rays.data(),
                                    static_cast<std::uint32_t>(rays.size()), seen.data()),
              "rays are marched");
    for (const opaline_march_result& result : seen) {
        for (int band = 0; band < 3; ++band) {
            hold(std::isfinite(result.radiance[band]) && result.radiance[band] >= 0,
                 "a march gives light");
            hold(result.transmittance[band] >= 0 && result.transmittance[band] <= 1,
                 "a march leaves a share of light");
        }
    }
    std::vector<opaline_sample_result> samples(points.size());
    expect_ok(opaline_volumes_sample(asset, light, points.data(),
                                     static_cast<std::uint32_t>(points.size()), samples.data()),
              "points are sampled");
    for (const opaline_sample_result& sample : samples) {
        for (int band = 0; band < 3; ++band) {
            hold(std::isfinite(sample.extinction[band]) && sample.extinction[band] >= 0,
                 "extinction is finite and not negative");
            hold(std::isfinite(sample.scattered[band]) && sample.scattered[band] >= 0,
                 "scattered light is finite and not negative");
        }
    }
}

void relight(const opaline_asset* asset, opaline_light* light) {
    const float toward[3] = {0.3f, 1, 0.2f}, bright[3] = {1000, 900, 800}, eye[3] = {1, 2, 3};
    expect_ok(opaline_light_set_cubemap(light, kAround, 1), "a cube map is a light");
    expect_ok(opaline_light_add_sun(light, toward, 0.01f, bright), "a sun is a light");
    const std::uint32_t receivers = opaline_asset_receiver_count(asset);
    std::vector<float> out(std::size_t{3} * receivers);
    expect_ok(opaline_shade(asset, light, 0, out.data(), out.size()), "receivers are shaded");
    expect_light(out, "receivers send out light");
    expect_ok(opaline_shade_from(asset, light, OPALINE_SHADE_WITHOUT_BASE_COLOR, eye, 0, receivers,
                                 out.data(), out.size()),
              "receivers are shaded for an eye");
    expect_light(out, "receivers send light to an eye");
    if (opaline_asset_volume_count(asset) == 0) return;
    opaline_volume_light* volume_light = nullptr;
    expect_ok(opaline_volume_light_create(asset, &volume_light), "volumes have a light");
    const VolumeLightHandle handle(volume_light);
    expect_ok(opaline_volume_light_update(volume_light, asset, light, 0, 1), "they are relit");
    for (std::uint32_t v = 0; v < std::min(opaline_asset_volume_count(asset), 4u); ++v) {
        march_through(asset, volume_light, v);
    }
}

// What `opaline render` does with a file whose structure is sound and whose values may not be.
void draw(const formats::AssetView& view) {
    formats::Environment sky;
    sky.width = 4;
    sky.height = 2;
    sky.pixel.assign(8, {1, 2, 3});
    sky.discs.push_back({{0, 1, 0}, 0.01f, {1000, 900, 800}});
    runtime::Camera camera = runtime::frame_asset(view, 32, 6, 4);
    const runtime::LightVector light = runtime::project_environment(sky, view.cubemap_size, {}, 1);
    const runtime::VolumeLight volumes =
        runtime::relight_volumes(view.volumes, light, {.threads = 1});
    runtime::SoftwareOptions options;
    options.supersampling = 1;
    options.threads = 1;
    options.volumes = &volumes;
    options.lights = light;
    runtime::SpecularLight specular;
    if (const runtime::SpecularNeeds needs = runtime::specular_needs(view); needs.any()) {
        specular = runtime::make_specular_light(sky, needs, {}, 1);
        options.specular = &specular;
    }
    std::optional<runtime::LayerLight> layers;
    if (!view.clouds.empty()) {
        layers = runtime::light_layers(view.clouds, sky, {}, {.time = 10, .threads = 1});
        options.layers = &*layers;
    }
    const std::vector<formats::Rgb> radiance = runtime::shade_for_picture(
        view, light, camera.eye, formats::TermSet::baked, 1, options.emitters);
    const auto picture = runtime::render_software(view, radiance, sky, {}, camera, options);
    if (!picture) return;  // a damaged mesh has no camera
    for (const formats::Rgb& c : picture->pixel) {
        for (const float v : {c.r, c.g, c.b}) {
            hold(std::isfinite(v) && v >= 0, "a picture is light");
        }
    }
}

}  // namespace

void run_opal_abi(std::span<const std::byte> bytes) {
    const Aligned file(bytes);
    opaline_asset* asset = nullptr;
    if (opaline_asset_load(file.bytes().data(), file.bytes().size(), &asset) != OPALINE_OK) {
        hold(asset == nullptr && std::strlen(opaline_last_error()) > 0, "an error says what it is");
        return;
    }
    const AssetHandle handle(asset);
    for (std::uint32_t p = 0; p < std::min(opaline_asset_primitive_count(asset), 64u); ++p) {
        ask_about_primitive(asset, p);
    }
    for (std::uint32_t e = 0; e < std::min(opaline_asset_emitter_count(asset), 64u); ++e) {
        opaline_emitter_info info{};
        info.struct_size = sizeof info;
        expect_ok(opaline_asset_emitter(asset, e, &info), "an emitter says what it is");
        hold(std::memchr(info.name, 0, sizeof info.name) != nullptr && info.name[0] != '\0',
             "an emitter has a name");
    }
    opaline_light* light = nullptr;
    expect_ok(opaline_light_create(asset, &light), "an asset has a light");
    const LightHandle light_handle(light);
    relight(asset, light);
}

void run_opal_picture(std::span<const std::byte> bytes) {
    const Aligned file(bytes);
    const auto loaded = formats::read_opal(file.bytes(), "x.opal", formats::Checks::structure);
    if (!loaded) {
        hold(!loaded.error().diagnostics.front().fault.empty(), "an error says what is wrong");
        return;
    }
    draw(loaded->view);
    const auto errors = formats::read_receiver_errors(file.bytes(), *loaded, "x.opal");
    if (errors) {
        hold(std::isfinite(formats::summarize_errors(*errors).mean),
             "errors by receiver are finite");
    }
    // What export-gltf adds to it, for files that pass all checks.
    const auto sound = formats::read_opal(file.bytes(), "x.opal", formats::Checks::full);
    if (!sound || !formats::check_has_mesh(sound->view, "x.opal")) return;
    const std::vector<formats::Rgb> grey(sound->view.receivers(), formats::Rgb{0.5f, 0.5f, 0.5f});
    const auto glb = formats::make_unlit_glb(sound->view, grey, "x.opal");
    hold(glb && glb->bytes.size() % 4 == 0, "a sound file can be shown elsewhere");
}

}  // namespace opaline::fuzz
