#include "tests/runtime/embed_gl/host/loaded_file.h"

#include <cstddef>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::test {

LoadedFile::LoadedFile(const std::filesystem::path& path) {
    require(opaline_asset_load_path(path.c_str(), &asset_) == OPALINE_OK, opaline_last_error());
    require(opaline_light_create(asset_, &light_) == OPALINE_OK, opaline_last_error());
}

LoadedFile::~LoadedFile() {
    opaline_light_release(light_);
    opaline_asset_release(asset_);
}

std::vector<float> LoadedFile::expected(const float* eye) const {
    std::vector<float> rgb(3 * std::size_t{receivers()});
    require(opaline_shade_from(asset_, light_,
                               OPALINE_SHADE_WITHOUT_BASE_COLOR | OPALINE_SHADE_WITHOUT_FRESNEL,
                               eye, 0, receivers(), rgb.data(), rgb.size()) == OPALINE_OK,
            opaline_last_error());
    return rgb;
}

void light_by_gradient(opaline_light* light) {
    std::vector<float> map;
    for (int i = 0; i < 32 * 16; ++i) {
        const float x = static_cast<float>(i % 32) / 32, y = static_cast<float>(i / 32) / 16;
        map.insert(map.end(), {0.2f + x, 1 - y, 0.5f + x * y});
    }
    const float direction[3] = {1, 2, 0.5f}, radiance[3] = {900, 800, 700};
    require(opaline_light_set_lat_long(light, map.data(), 32, 16) == OPALINE_OK &&
                opaline_light_add_sun(light, direction, 0.02f, radiance) == OPALINE_OK,
            opaline_last_error());
}

}  // namespace opaline::test
