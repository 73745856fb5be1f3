// What the page shows, in a headless browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/clouds/part_environments.h"
#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_bounds.h"
#include "runtime/web/page_layer.h"
#include "tests/formats/opal/slot_fixture.h"
#include "tests/runtime/picture/every_surface.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/runtime/web/page_comparison.h"
#include "tests/support/cloud_layers.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using test::expect_same_pixels;
using test::page_of;
using test::PagePicture;
using test::PageView;
using test::render_on_cpu;

formats::Environment white() {
    return tests::lat_long_map(2, 1, [](formats::Vec3) { return Rgb{1, 1, 1}; });
}

formats::Environment sky_with_sun() {
    formats::Environment sky = tests::lat_long_map(128, 64, test::two_lights);
    sky.discs = {{normalize(formats::Vec3{0.3f, 0.8f, 0.5f}), 0.0046f, {8000, 7000, 6000}}};
    return sky;
}

void expect_every_surface(const PageView& wanted, formats::Vec3 eye,
                          const formats::Asset& asset = test::make_every_surface()) {
    const formats::AssetView view = asset.view();
    const PageLight lights[] = {{"white", white()}, {"my <sky>", sky_with_sun()}};
    const auto page = page_of(asset, lights, "a \"title\" </script>");
    const auto shown =
        expect_same_pixels(page, wanted.address,
                           {.eye = eye,
                            .target = {0, 0.7f, 0},
                            .fov_y = 32,
                            .width = 120,
                            .height = 90,
                            .near_plane = near_plane_for(view, eye)},
                           [&](const Camera& moved) {
                               return render_on_cpu(view, lights[1].environment, moved, wanted);
                           });
    EXPECT_EQ(shown.title, "a \"title\" &lt;/script&gt;");
}

TEST_F(PagePicture, SurfacesWhoseVerticesShareRowsLookAsOnTheCpu) {
    expect_every_surface({"light=my+%3Csky%3E&eye=0.5,2,7&target=0,0.7,0&rotate=40", 40},
                         {0.5f, 2, 7}, tests::with_copied_corners(test::make_every_surface()));
}

TEST_F(PagePicture, EverySurfaceLooksAsOnTheCpuUnderTurnedLight) {
    expect_every_surface({"light=my+%3Csky%3E&eye=0.5,2,7&target=0,0.7,0&rotate=40", 40},
                         {0.5f, 2, 7});
}

TEST_F(PagePicture, EverySurfaceLooksAsOnTheCpuFromBehindAndWithDimmedEmitters) {
    expect_every_surface({"light=my+%3Csky%3E&eye=-3,3,-6&target=0,0.7,0&rotate=-130&exposure=-0.7&"
                          "emitter=b%3D0,0,0&"
                          "emitter=a%3D2,1,0.5",
                          -130,
                          -0.7f,
                          {{2, 1, 0.5f}, {0, 0, 0}}},
                         {-3, 3, -6});
}

// A map of photographs: the sun stands in a few of its pixels.
formats::Environment sky_with_sun_in_the_map() {
    const formats::Vec3 sun = normalize(formats::Vec3{0.3f, 0.8f, 0.5f});
    return tests::lat_long_map(1024, 512, [sun](formats::Vec3 d) {
        return test::two_lights(d) + (dot(d, sun) > 0.9999f ? 5000.0f : 0.0f) * Rgb{1, 0.9f, 0.8f};
    });
}

TEST_F(PagePicture, DefaultViewUnderATurnedSunInTheMapIsTheOneOfPictures) {
    formats::Asset asset = test::make_asset(8, 16);
    test::add_primitive(asset, test::make_sphere({3, 1, -2}, 0.8f, 24, 16), {.bands = 3});
    const PageLight lights[] = {{"sky", sky_with_sun_in_the_map()}};
    // The view is framed for the window, which is wider than high, as this picture is.
    expect_same_pixels(
        page_of(asset, lights), "rotate=63", frame_asset(asset.view(), 32, 160, 120),
        [&](const Camera& moved) {
            return render_on_cpu(asset.view(), lights[0].environment, moved, {{}, 63});
        });
}

// Bumps with holes, in three frames, over a ground of squares; wind moves them. `with_bodies`:
// endless, a sheet and smoke partly in them.
formats::Asset make_cloudy_scene(bool with_bodies) {
    test::TestLayer layer = test::uneven_test_layer(24, 20);
    layer.droplets.kappa = {0.01, 0.012, 0.014};
    layer.record.wind = {9, -5};
    if (!with_bodies) layer.record.flags = formats::LayerRecord::kRadiosity;
    formats::Asset asset = test::make_asset(8, 16);
    const auto frame_of = [&](double shift) {
        return test::make_test_clouds(layer, [shift](std::uint32_t column, std::uint32_t row) {
            return 300 *
                   std::max(0.0, std::sin(column * 0.82 + shift) * std::cos(row * 0.74) + 0.4);
        });
    };
    asset.clouds = frame_of(0);
    for (const double shift : {1.5, 3.0}) {
        const formats::Clouds more = frame_of(shift);
        asset.clouds.thickness.insert(asset.clouds.thickness.end(), more.thickness.begin(),
                                      more.thickness.end());
    }
    formats::LayerRecord& record = asset.clouds.records.front();
    record.frames = 3;
    record.frame_seconds = 40;
    record.flags |= formats::LayerRecord::kLoop;
    test::paint_squares(asset.clouds, 150, 110);
    if (!with_bodies) return asset;
    test::add_primitive(asset,
                        test::make_sheet({-200, 700, -900}, {900, 100, 0}, {0, 900, -300}, 2, 2),
                        {.bands = 1, .details = 20});
    asset.volumes = test::make_volumes(8);
    test::TestVolume smoke = test::smoke_ball();
    smoke.to_world = {20, 0, 0, -70, 0, 20, 0, 800, 0, 0, 20, -720};
    smoke.sigma_t = {0.01f, 0.015f, 0.02f};
    smoke.albedo = {0.9f, 0.6f, 0.3f};
    test::add_volume(asset.volumes, smoke);
    return asset;
}

formats::Environment sky_above_clouds() {
    formats::Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    sky.discs.push_back({normalize(formats::Vec3{-0.5f, 0.6f, -0.5f}), 0.01f, {4e3f, 3e3f, 1e3f}});
    return sky;
}

// What turns and moves in the pages of cloud layers.
struct CloudView {
    float degrees = 0, exposure = 0;
    double time = 0;
};

// `points`: how many bodies are lit at.
DisplayPicture render_cloudy_on_cpu(const formats::AssetView& view, const formats::Environment& sky,
                                    const Camera& camera, const CloudView& shown,
                                    std::size_t points) {
    const Rotation rotation = rotation_about_y(shown.degrees * std::numbers::pi_v<float> / 180);
    const LayerLight layer = light_layers(view.clouds, sky, rotation, {.time = shown.time});
    const BoundingSphere bodies = bound_asset(view);
    PartEnvironments parts{{}, {sky}, {}};
    if (points > 0) {
        parts = environments_of_parts({layer, sky, rotation}, view, volume_corners(view.volumes),
                                      {static_cast<float>(bodies.x), static_cast<float>(bodies.y),
                                       static_cast<float>(bodies.z)});
        EXPECT_EQ(parts.at_point.size(), points);
    }
    std::vector<LightVector> vectors;
    for (const formats::Environment& environment : parts.at_point) {
        vectors.push_back(project_environment(environment, view.cubemap_size));
    }
    const PartLights lights{vectors, parts.points.of_primitive, parts.points.of_volumes};
    SoftwareOptions options;
    options.layers = &layer;
    const SpecularLight specular =
        make_specular_light(parts.mirrored(), specular_needs(view), {}, 0);
    options.specular = &specular;
    options.lights = lights;
    const VolumeLight volumes = relight_volumes(view.volumes, vectors[lights.of_volumes]);
    if (!view.volumes.empty()) options.volumes = &volumes;
    const auto picture =
        render_software(view, shade_for_picture(view, lights, camera.eye, formats::TermSet::all, 0),
                        sky, rotation, camera, options);
    EXPECT_TRUE(picture);
    return tone_map(*picture, shown.exposure);
}

TEST_F(PagePicture, ACloudLayerWithItsGroundAndWhatStandsInItLooksAsOnTheCpuUnderTurnedLightLater) {
    const formats::Environment sky = sky_above_clouds();
    const PageLight lights[] = {{"sky", sky}};
    for (const bool with_bodies : {false, true}) {
        SCOPED_TRACE(with_bodies);
        const formats::Asset asset = make_cloudy_scene(with_bodies);
        const formats::Vec3 eye =
            with_bodies ? formats::Vec3{0, 3000, 600} : formats::Vec3{0, 2, 0};
        const CloudView wanted = with_bodies ? CloudView{50, -0.5f, -310} : CloudView{-77, -2, 130};
        expect_same_pixels(
            page_of(asset, lights),
            with_bodies
                ? "eye=0,3000,600&target=100,1000,-900&fov=40&exposure=-0.5&rotate=50&time=-310"
                : "eye=0,2,0&target=100,600,-900&fov=40&exposure=-2&rotate=-77&time=130",
            {.eye = eye,
             .target = {100, with_bodies ? 1000.0f : 600.0f, -900},
             .width = 80,
             .height = 60,
             .near_plane = near_plane_for(asset.view(), eye)},
            [&](const Camera& moved) {
                return render_cloudy_on_cpu(asset.view(), sky, moved, wanted, with_bodies ? 2 : 0);
            },
            with_bodies ? 1 : 0);
    }
}

// A matt sheet of metal in the clouds, a ball of polished metal and one of glossy wax above them.
formats::Asset make_mirroring_scene() {
    formats::Asset asset = make_cloudy_scene(true);
    asset.volumes = {};
    test::add_primitive(asset, test::make_sphere({-350, 1500, -500}, 300, 24, 16), {});
    test::add_primitive(asset, test::make_sphere({500, 1400, -500}, 300, 24, 16),
                        {.bands = 3, .eta = 1.4f, .terms = 4});
    asset.primitives[1].node = 1;
    asset.primitives[2].node = 2;
    asset.roughness = {formats::kNotGlossy, formats::kNotGlossy, 0.3f};
    asset.gloss.resize(3);
    const float roughness[] = {0.6f, 0.25f};
    for (std::size_t i = 0; i < 2; ++i) {
        asset.gloss[i].f0 = {0.3f, 0.4f, 0.5f};
        asset.gloss[i].f90 = 1;
        asset.gloss[i].metallic = 1;
        asset.gloss[i].roughness = roughness[i];
    }
    for (const formats::Vec3 normal : asset.normal) {
        asset.openness.push_back(formats::encode_openness(normal, 0.9f));
    }
    return asset;
}

TEST_F(PagePicture, BodiesMirrorCloudsAsOnTheCpuUnderTurnedLightLater) {
    const formats::Asset asset = make_mirroring_scene();
    const formats::Environment sky = sky_above_clouds();
    const PageLight lights[] = {{"sky", sky}};
    const formats::Vec3 eye{0, 3000, 600};
    expect_same_pixels(
        page_of(asset, lights),
        "eye=0,3000,600&target=100,1200,-600&fov=40&exposure=-0.5&rotate=50&time=60",
        {.eye = eye,
         .target = {100, 1200, -600},
         .width = 60,
         .height = 45,
         .near_plane = near_plane_for(asset.view(), eye)},
        [&](const Camera& moved) {
            return render_cloudy_on_cpu(asset.view(), sky, moved, {50, -0.5f, 60}, 3);
        });
}

TEST_F(PagePicture, ControlsAndTheAddressFollowEachOther) {
    const formats::Asset asset = test::make_every_surface();
    const PageLight lights[] = {{"white", white()}, {"black", {}}};
    const auto shown = test::run_on_page(page_of(asset, lights), R"js(
const at = id => document.getElementById(id), canvas = at("canvas");
const wait = () => new Promise(resolve => setTimeout(resolve, 500));
const set = (id, value, type) => { at(id).value = value; at(id).dispatchEvent(new Event(type)); };
const drag = (type, x, y) => canvas.dispatchEvent(
    new PointerEvent(type, { pointerId: 1, clientX: x, clientY: y, buttons: 1 }));
canvas.setPointerCapture = () => {};  // of pointers that a hand moves
opaline.page.ready.then(async () => {
  location.hash = "azimuth=10&elevation=20&distance=3&light=black&emitter=a%3D2,1,0.5";
  await wait();
  const hasTime = getComputedStyle(at("time").closest("label")).display !== "none";
  const heard = `${at("light").value} ${at("emitter-0").textContent} ${hasTime}`;
  drag("pointerdown", 100, 100);
  drag("pointermove", 90, 110);
  drag("pointerup", 90, 110);
  set("turn", 45, "input");
  set("light", 0, "change");
  set("slider-1", -6, "input");
  await wait();
  document.title = `${heard} ${decodeURIComponent(location.hash)}`;
});
)js");
    EXPECT_EQ(shown.console, "");
    EXPECT_EQ(shown.title.substr(0, shown.title.find("&amp;target")),
              "1 × 2 false #light=white&amp;rotate=45&amp;azimuth=13&amp;elevation=23&amp;"
              "distance=3");
    EXPECT_NE(shown.title.find("emitter=a=2,1,0.5&amp;emitter=b=0,0,0"), std::string::npos)
        << shown.title;
}

TEST_F(PagePicture, ASliderMovesTheCloudsAndTheAddressKeepsTheirTime) {
    const PageLight lights[] = {{"white", white()}};
    const formats::Asset cloudy = make_cloudy_scene(false);
    const std::string script = R"js(
const at = id => document.getElementById(id);
opaline.page.ready.then(async () => {
  at("time").value = 50;
  at("time").dispatchEvent(new Event("input"));
  await new Promise(resolve => setTimeout(resolve, 500));
  document.title = `${getComputedStyle(at("time").closest("label")).display === "none"} ${at("time").max} ${at("time-value").textContent} ` +
      new URLSearchParams(location.hash.slice(1)).get("time");
});
)js";
    const auto shown = test::run_on_page(page_of(cloudy, lights), script);
    EXPECT_EQ(shown.console, "");
    EXPECT_EQ(shown.title, "false 120 50 s 50");  // three frames of 40 s, over and over
}

TEST_F(PagePicture, WithoutWebGlThePageSaysSo) {
    const formats::Asset asset = test::make_every_surface();
    const PageLight lights[] = {{"white", white()}};
    const auto shown = test::open_page_without_webgl(page_of(asset, lights));
    EXPECT_NE(shown.message.find("has no WebGL 2"), std::string::npos) << shown.message;
}

}  // namespace
}  // namespace opaline::runtime
