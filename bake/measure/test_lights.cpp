#include "bake/measure/test_lights.h"

#include <array>
#include <utility>

#include "bake/environment/builtin_environment.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"

namespace opaline::bake {
namespace {

constexpr std::array<const char*, 6> kPublishedLights{"white",      "sun:30,60", "sun:150,35",
                                                      "sun:270,15", "studio",    "sky:3,35"};

std::vector<float> luminances(const runtime::LightVector& light) {
    std::vector<float> values(light.rgba.size() / 4);
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] =
            formats::luminance({light.rgba[4 * k], light.rgba[4 * k + 1], light.rgba[4 * k + 2]});
    }
    return values;
}

}  // namespace

formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads) {
    std::vector<TestLight> lights;
    for (const char* name : kPublishedLights) {
        formats::Result<formats::Environment> environment = make_environment(name);
        if (!environment) {
            return std::move(environment).error();
        }
        lights.push_back({name,
                          luminances(runtime::project_environment(*environment, cubemap_size,
                                                                  runtime::Rotation{}, threads)),
                          luminances(runtime::project_environment(*environment, 2 * cubemap_size,
                                                                  runtime::Rotation{}, threads))});
    }
    return lights;
}

}  // namespace opaline::bake
