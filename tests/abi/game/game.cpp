// What a game does with an asset: loads it into memory of its own, turns a sky from frame to frame
// on one thread while another relights under the light of the room, and lets the sky rest.
//     game FILE.opal
#include <opaline.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace {

std::size_t bytes_held = 0;

void* allocate(void*, std::size_t size, std::size_t alignment) {
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size) != 0) {
        return nullptr;
    }
    bytes_held += size;
    return memory;
}

void release(void*, void* memory, std::size_t size, std::size_t) {
    bytes_held -= size;
    std::free(memory);
}

void require(opaline_status status, const char* what) {
    if (status == OPALINE_OK) return;
    std::fprintf(stderr, "%s: %s: %s\n", what, opaline_status_string(status), opaline_last_error());
    std::exit(1);
}

float mean(const std::vector<float>& values) {
    float sum = 0;
    for (float value : values)
        sum += value;
    return values.empty() ? 0 : sum / static_cast<float>(values.size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    const std::vector<char> content((std::istreambuf_iterator<char>(in)),
                                    std::istreambuf_iterator<char>());
    void* file = nullptr;
    if (posix_memalign(&file, 64, content.size() + 1) != 0) return 2;
    std::copy(content.begin(), content.end(), static_cast<char*>(file));

    opaline_load_options options = {};
    options.struct_size = sizeof options;
    options.flags = OPALINE_LOAD_TRUSTED;
    options.allocate = allocate;
    options.release = release;
    opaline_asset* asset = nullptr;
    require(opaline_asset_load_with(file, content.size(), &options, &asset), "load");

    opaline_light *sky = nullptr, *room = nullptr;
    require(opaline_light_create(asset, &sky), "sky");
    require(opaline_light_create(asset, &room), "room");
    std::vector<float> map(3 * 64 * 32, 1.0f);
    for (std::size_t i = 0; i < map.size() / 2; ++i)
        map[i] = 3.0f;  // bright above
    require(opaline_light_set_lat_long(sky, map.data(), 64, 32), "map");
    float harmonics[27] = {3.5f, 3.5f, 3.5f, 0.5f, 0.5f, 0.5f};
    require(opaline_light_set_harmonics(room, harmonics), "harmonics");

    const std::uint32_t receivers = opaline_asset_receiver_count(asset);
    std::vector<float> under_sky(3 * receivers), under_room(3 * receivers);
    std::thread indoors([&] {
        for (int frame = 0; frame < 20; ++frame) {
            require(opaline_shade(asset, room, OPALINE_SHADE_DEFAULT, under_room.data(),
                                  under_room.size()),
                    "room");
        }
    });
    for (int frame = 0; frame <= 20; ++frame) {
        const float angle = 0.1f * static_cast<float>(frame), c = std::cos(angle),
                    s = std::sin(angle);
        const float turn[9] = {c, 0, -s, 0, 1, 0, s, 0, c};
        require(frame < 20 ? opaline_light_turn(sky, turn) : opaline_light_set_rotation(sky, turn),
                "turn");
        require(
            opaline_shade(asset, sky, OPALINE_SHADE_DEFAULT, under_sky.data(), under_sky.size()),
            "sky");
    }
    indoors.join();
    std::printf("%u receivers, mean radiance %g under the sky, %g in the room\n", receivers,
                static_cast<double>(mean(under_sky)), static_cast<double>(mean(under_room)));
    const bool lit = mean(under_sky) > 0 && mean(under_room) > 0;
    opaline_light_release(sky);
    opaline_light_release(room);
    opaline_asset_release(asset);
    std::free(file);
    return lit && bytes_held == 0 ? 0 : 1;
}
